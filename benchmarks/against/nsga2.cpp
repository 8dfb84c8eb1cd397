// Compares nsga2 with pagmo's nsga2 (default settings) on problems with two and three objectives: 20 seeds each,
// population 100, 250 generations. Then runs constrained problems, which pagmo's nsga2 does not support.
//
// Prints the hypervolumes of the last population (median, minimum and maximum over the seeds) of both programs, and of
// our archive. The reference point is a tenth of the range beyond the worst values of the known front. Exit code 1 if
// our median is below pagmo's, if the two programs' hypervolumes of a front differ by more than 1e-12, or if an
// archived design is infeasible.
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
#include "tests/unit/optimisers/multi_objective_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace {

using namespace pkm;
using test::FrontProblem;

constexpr int kSeeds = 20;
constexpr unsigned kPopulation = 100, kGenerations = 250;

/// Objectives of the last population and of the archive, row by row, and the run time.
struct RunResult {
  std::vector<double> population, archive;
  double seconds = 0;
};

RunResult run_pagmo(const Problem& problem, unsigned seed) {
  RunResult result;
  result.seconds = benchmarks::seconds_of([&] {
    pagmo::population population{pagmo::problem{benchmarks::PagmoProblem{&problem}}, kPopulation, seed};
    population = pagmo::algorithm{pagmo::nsga2{kGenerations, 0.95, 10., 0.01, 50., seed}}.evolve(population);
    for (const auto& row : population.get_f())
      result.population.insert(result.population.end(), row.begin(), row.end());
  });
  return result;
}

test::Outcome run_nsga2(const Problem& problem, unsigned seed) {
  const auto optimiser =
      test::make(test::entry("nsga2"), problem,
                 {{"population", std::int64_t{kPopulation}}, {"generations", std::int64_t{kGenerations}}});
  return test::run(*optimiser, problem, seed);
}

/// Objectives of the feasible rows.
std::vector<double> objectives_of(const EvaluationTable& table, const std::vector<std::int64_t>& rows) {
  std::vector<double> values;
  for (const std::int64_t row : rows) {
    if (table.status[static_cast<std::size_t>(row)] != Status::feasible) continue;
    const auto objectives = table.objective_row(static_cast<std::size_t>(row));
    values.insert(values.end(), objectives.begin(), objectives.end());
  }
  return values;
}

RunResult run_ours(const Problem& problem, unsigned seed) {
  RunResult result;
  result.seconds = benchmarks::seconds_of([&] {
    const test::Outcome outcome = run_nsga2(problem, seed);
    result.population = objectives_of(outcome.table, outcome.recorder.populations.back());
    result.archive = objectives_of(outcome.table, outcome.result.front.value().rows);
  });
  return result;
}

/// Computes hypervolumes, and tracks their largest relative difference from pagmo's.
class HypervolumeMeter {
 public:
  explicit HypervolumeMeter(const FrontProblem& known) : reference_(test::reference_point(known)) {}

  double operator()(const std::vector<double>& points) {
    const std::size_t objectives = reference_.size();
    const double ours = hypervolume(points, objectives, reference_);
    std::vector<pagmo::vector_double> inside;  // pagmo rejects points that do not dominate the reference point
    for (auto row = points.begin(); row != points.end(); row += static_cast<std::ptrdiff_t>(objectives))
      if (std::equal(reference_.begin(), reference_.end(), row, std::greater<>()))
        inside.emplace_back(row, row + static_cast<std::ptrdiff_t>(objectives));
    const double theirs = inside.empty() ? 0 : pagmo::hypervolume(inside, false).compute(reference_);
    if (ours != theirs) difference = std::fmax(difference, std::fabs(ours - theirs) / theirs);
    return ours;
  }
  double difference = 0;  ///< maximum so far

 private:
  std::vector<double> reference_;
};

struct Summary {
  double median, minimum, maximum;
};

Summary summarise(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {(values[values.size() / 2 - 1] + values[values.size() / 2]) / 2, values.front(), values.back()};
}

void print(const Summary& values) {
  std::printf("  %10.5g (%8.5g .. %8.5g)", values.median, values.minimum, values.maximum);
}

/// Returns true if our median is at least pagmo's and both programs agree on all hypervolumes.
bool compare(const FrontProblem& known) {
  HypervolumeMeter measure(known);
  std::vector<double> ours, archive, theirs, our_time, pagmo_time;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const RunResult own = run_ours(known.problem, seed), other = run_pagmo(known.problem, seed);
    ours.push_back(measure(own.population));
    archive.push_back(measure(own.archive));
    theirs.push_back(measure(other.population));
    our_time.push_back(own.seconds);
    pagmo_time.push_back(other.seconds);
  }
  std::printf("%-5s  %8.5g", known.name.c_str(), measure(known.front));
  for (const auto& values : {ours, theirs, archive}) print(summarise(values));
  std::printf("  %5.1f  %5.1f  %.0e\n", 1e3 * summarise(our_time).median, 1e3 * summarise(pagmo_time).median,
              measure.difference);
  return summarise(ours).median >= summarise(theirs).median && measure.difference <= 1e-12;
}

/// Returns true if all archived designs of all seeds satisfy their constraints.
bool constrained(const FrontProblem& known) {
  HypervolumeMeter measure(known);
  std::vector<double> population, archive, designs;
  std::size_t infeasible = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const test::Outcome outcome = run_nsga2(known.problem, seed);
    const std::vector<std::int64_t>& rows = outcome.result.front.value().rows;
    for (const std::int64_t row : rows)
      infeasible += std::ranges::min(outcome.table.margin_row(static_cast<std::size_t>(row))) < 0;
    population.push_back(measure(objectives_of(outcome.table, outcome.recorder.populations.back())));
    archive.push_back(measure(objectives_of(outcome.table, rows)));
    designs.push_back(static_cast<double>(rows.size()));
  }
  std::printf("%-5s  %8.5g", known.name.c_str(), measure(known.front));
  print(summarise(population));
  print(summarise(archive));
  std::printf("  %5.0f  %zu\n", summarise(designs).median, infeasible);
  return infeasible == 0 && measure.difference <= 1e-12;
}

}  // namespace

int main() {
  bool passed = true;
  std::printf("%d seeds, population %u, %u generations; hypervolumes: median (minimum .. maximum)\n\n", kSeeds,
              kPopulation, kGenerations);
  std::printf("%-5s  %8s  %-32s  %-32s  %-32s  %5s  %5s  %s\n", "", "known", "our population", "pagmo's population",
              "our archive", "ms", "ms", "difference");
  for (const FrontProblem& known : test::unconstrained_problems()) passed = compare(known) && passed;
  std::printf("\n%-5s  %8s  %-32s  %-32s  %5s  %s\n", "", "known", "our population", "our archive", "size",
              "infeasible");
  for (const FrontProblem& known : test::constrained_problems()) passed = constrained(known) && passed;
  return passed ? 0 : 1;
}
