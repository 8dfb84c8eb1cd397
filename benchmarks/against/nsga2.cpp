// Trade-offs of two and three objectives: our nsga2 against pagmo's with its defaults, 20 seeds each, a population of
// 100, 250 generations, in one run. Then constrained problems, which pagmo's does not take.
//
// Prints the hypervolume of the last population (median, least and greatest over the seeds) of both and of our archive,
// up to the front's worst values and a tenth of its extents beyond. Exit code 1 when our median is below pagmo's, when
// the two programs' hypervolumes of one front differ by more than 1e-12, or when an archived design is infeasible.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/hypervolume.hpp>

#include "benchmarks/against/pagmo_problem.hpp"
#include "benchmarks/timing.hpp"
#include "engine/math/hypervolume.hpp"
#include "tests/unit/optimisers/stage.hpp"
#include "tests/unit/optimisers/trade_off_problems.hpp"

namespace {

using namespace pkm;
using test::TradeOff;

constexpr int kSeeds = 20;
constexpr unsigned kPopulation = 100, kGenerations = 250;

/// Objectives of a set of designs, row by row, and the time it took to find them.
struct Found {
  std::vector<double> population, archive;
  double seconds = 0;
};

Found by_pagmo(const Problem& problem, unsigned seed) {
  Found found;
  found.seconds = benchmarks::seconds_of([&] {
    pagmo::population population{pagmo::problem{benchmarks::PagmoProblem{&problem}}, kPopulation, seed};
    population = pagmo::algorithm{pagmo::nsga2{kGenerations, 0.95, 10., 0.01, 50., seed}}.evolve(population);
    for (const auto& row : population.get_f()) found.population.insert(found.population.end(), row.begin(), row.end());
  });
  return found;
}

test::Outcome run_ours(const Problem& problem, unsigned seed) {
  const auto optimiser =
      test::make(test::entry("nsga2"), problem,
                 {{"population", std::int64_t{kPopulation}}, {"generations", std::int64_t{kGenerations}}});
  return test::run(*optimiser, problem, seed);
}

/// Of the feasible ones.
std::vector<double> objectives_of(const EvaluationTable& table, const std::vector<std::int64_t>& rows) {
  std::vector<double> values;
  for (const std::int64_t row : rows) {
    if (table.status[static_cast<std::size_t>(row)] != Status::feasible) continue;
    const auto objectives = table.objective_row(static_cast<std::size_t>(row));
    values.insert(values.end(), objectives.begin(), objectives.end());
  }
  return values;
}

Found by_us(const Problem& problem, unsigned seed) {
  Found found;
  found.seconds = benchmarks::seconds_of([&] {
    const test::Outcome outcome = run_ours(problem, seed);
    found.population = objectives_of(outcome.table, outcome.recorder.populations.back());
    found.archive = objectives_of(outcome.table, outcome.result.front.value().rows);
  });
  return found;
}

/// Our hypervolume, compared with pagmo's.
class Measure {
 public:
  explicit Measure(const TradeOff& known) : reference_(test::reference_point(known)) {}

  double operator()(const std::vector<double>& points) {
    const std::size_t objectives = reference_.size();
    const double ours = hypervolume(points, objectives, reference_);
    std::vector<pagmo::vector_double> inside;  // pagmo refuses points that are not
    for (auto row = points.begin(); row != points.end(); row += static_cast<std::ptrdiff_t>(objectives))
      if (std::equal(reference_.begin(), reference_.end(), row, std::greater<>()))
        inside.emplace_back(row, row + static_cast<std::ptrdiff_t>(objectives));
    const double pagmos = inside.empty() ? 0 : pagmo::hypervolume(inside, false).compute(reference_);
    if (ours != pagmos) difference = std::fmax(difference, std::fabs(ours - pagmos) / pagmos);
    return ours;
  }
  double difference = 0;  ///< greatest so far, relative

 private:
  std::vector<double> reference_;
};

struct Spread {
  double median, least, greatest;
};

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {(values[values.size() / 2 - 1] + values[values.size() / 2]) / 2, values.front(), values.back()};
}

void print(const Spread& values) {
  std::printf("  %10.5g (%8.5g .. %8.5g)", values.median, values.least, values.greatest);
}

/// Whether our median is at least pagmo's and both programs agree on every hypervolume.
bool compare(const TradeOff& known) {
  Measure measure(known);
  std::vector<double> ours, archive, pagmos, our_time, pagmo_time;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Found we = by_us(known.problem, seed), they = by_pagmo(known.problem, seed);
    ours.push_back(measure(we.population));
    archive.push_back(measure(we.archive));
    pagmos.push_back(measure(they.population));
    our_time.push_back(we.seconds);
    pagmo_time.push_back(they.seconds);
  }
  std::printf("%-5s  %8.5g", known.name.c_str(), measure(known.front));
  for (const auto& values : {ours, pagmos, archive}) print(spread(values));
  std::printf("  %5.1f  %5.1f  %.0e\n", 1e3 * spread(our_time).median, 1e3 * spread(pagmo_time).median,
              measure.difference);
  return spread(ours).median >= spread(pagmos).median && measure.difference <= 1e-12;
}

/// Whether every archived design of every seed holds its margins.
bool constrained(const TradeOff& known) {
  Measure measure(known);
  std::vector<double> population, archive, designs;
  std::size_t broken = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const test::Outcome outcome = run_ours(known.problem, seed);
    const std::vector<std::int64_t>& rows = outcome.result.front.value().rows;
    for (const std::int64_t row : rows)
      broken += std::ranges::min(outcome.table.margin_row(static_cast<std::size_t>(row))) < 0;
    population.push_back(measure(objectives_of(outcome.table, outcome.recorder.populations.back())));
    archive.push_back(measure(objectives_of(outcome.table, rows)));
    designs.push_back(static_cast<double>(rows.size()));
  }
  std::printf("%-5s  %8.5g", known.name.c_str(), measure(known.front));
  print(spread(population));
  print(spread(archive));
  std::printf("  %5.0f  %zu\n", spread(designs).median, broken);
  return broken == 0 && measure.difference <= 1e-12;
}

}  // namespace

int main() {
  bool good = true;
  std::printf("%d seeds, population %u, %u generations; hypervolumes: median (least .. greatest)\n\n", kSeeds,
              kPopulation, kGenerations);
  std::printf("%-5s  %8s  %-32s  %-32s  %-32s  %5s  %5s  %s\n", "", "known", "our population", "pagmo's population",
              "our archive", "ms", "ms", "difference");
  for (const TradeOff& known : test::unconstrained_trade_offs()) good = compare(known) && good;
  std::printf("\n%-5s  %8s  %-32s  %-32s  %5s  %s\n", "", "known", "our population", "our archive", "kept",
              "infeasible");
  for (const TradeOff& known : test::constrained_trade_offs()) good = constrained(known) && good;
  return good ? 0 : 1;
}
