// Compares the cost of multi-objective optimisation without evaluations with that of pagmo, on the same points, by
// alternating measurements in one run.
//
// Prints times of non-dominated sorting and selection per survivor, of whole generations with evaluations of negligible
// cost, and of hypervolumes with their relative difference. Exit code 1 if a generation of 1000 designs with 2
// objectives is not 20 times as fast as pagmo's, or if two hypervolumes differ by more than 1e-12. With --golden it
// prints pagmo's hypervolumes in the format of tests/data/hypervolumes.json.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/hypervolume.hpp>
#include <pagmo/utils/multi_objective.hpp>

#include "benchmarks/against/pagmo_problem.hpp"
#include "benchmarks/timing.hpp"
#include "engine/math/hypervolume.hpp"
#include "engine/optimisers/crowding.hpp"
#include "engine/optimisers/dominance.hpp"
#include "tests/unit/math/random_fronts.hpp"
#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace {

using namespace pkm;
using benchmarks::seconds_of;

std::vector<pagmo::vector_double> rows_of(const std::vector<double>& points, std::size_t objectives) {
  std::vector<pagmo::vector_double> rows;
  for (auto row = points.begin(); row != points.end(); row += static_cast<std::ptrdiff_t>(objectives))
    rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(objectives));
  return rows;
}

/// Minimum times [s] of two implementations that were timed alternately.
struct PairedMinima {
  double ours = std::numeric_limits<double>::infinity(), theirs = ours;
};

PairedMinima time_alternately(int rounds, const std::function<void()>& ours, const std::function<void()>& theirs) {
  PairedMinima times;
  for (int round = 0; round < rounds; ++round) {
    times.ours = std::fmin(times.ours, seconds_of(ours));
    times.theirs = std::fmin(times.theirs, seconds_of(theirs));
  }
  return times;
}

/// A problem of negligible evaluation cost: 4 variables; objective k is the squared distance to corner k of the unit
/// cube.
test::FunctionProblem free_problem(std::size_t objectives) {
  return {test::box(4, 0, 1), std::vector<Direction>(objectives, Direction::minimise), 0,
          [](std::span<const double> x, std::span<double> f, std::span<double>) {
            for (std::size_t k = 0; k < f.size(); ++k) {
              f[k] = 0;
              for (std::size_t i = 0; i < x.size(); ++i) f[k] += (x[i] - (i == k)) * (x[i] - (i == k));
            }
          }};
}

/// Survivor selection as in nsga2: front by front, and within a front by crowding distance.
std::vector<std::size_t> select_survivors(const Scores& scores, std::size_t count) {
  std::vector<std::uint32_t> front_of;
  non_dominated_sort(scores, front_of);
  std::vector<std::size_t> selected, members;
  for (std::uint32_t number = 0; selected.size() < count; ++number) {
    Scores front{scores.objectives};
    members.clear();
    for (std::size_t i = 0; i < scores.size(); ++i) {
      if (front_of[i] != number) continue;
      members.push_back(i);
      front.add({scores[i], scores.objectives});
    }
    for (const std::uint32_t i : order_by_crowding(front, count - selected.size()))
      if (selected.size() < count) selected.push_back(members[i]);
  }
  return selected;
}

int rounds_for(std::size_t population) { return population <= 100 ? 200 : population <= 1000 ? 9 : 1; }

/// Selects a population from parents and as many children.
void compare_selection(const char* shape, std::size_t objectives, std::size_t population) {
  const std::vector<double> points = test::random_front(shape, 2 * population, objectives);
  const std::vector<pagmo::vector_double> rows = rows_of(points, objectives);
  const Scores scores{objectives, points};
  std::vector<std::size_t> selected;
  const PairedMinima times = time_alternately(
      rounds_for(population), [&] { selected = select_survivors(scores, population); },
      [&] { pagmo::select_best_N_mo(rows, population); });
  const double each = 1e6 / static_cast<double>(population);
  std::printf("%10zu  %-6s  %zu  %10.3f  %10.3f  %8.0f\n", population, shape, objectives, times.ours * each,
              times.theirs * each, times.theirs / times.ours);
}

/// Whole generations: reproduction, sorting, selection, archive and indicators. Returns pagmo's time divided by ours.
double compare_generations(std::size_t objectives, std::size_t population) {
  const test::FunctionProblem problem = free_problem(objectives);
  const unsigned count = population <= 100 ? 200 : population <= 1000 ? 20 : 2;
  const auto optimiser =
      test::make(test::entry("nsga2"), problem,
                 {{"population", static_cast<std::int64_t>(population)}, {"generations", std::int64_t{count}}});
  const PairedMinima times = time_alternately(
      population <= 1000 ? 3 : 1, [&] { test::run(*optimiser, problem); },
      [&] {
        pagmo::population start{pagmo::problem{benchmarks::PagmoProblem{&problem}}, population, 1};
        pagmo::algorithm{pagmo::nsga2{count, 0.95, 10., 0.01, 50., 1}}.evolve(start);
      });
  std::printf("%10zu  %zu  %10.3f  %10.3f  %8.0f\n", population, objectives, 1e3 * times.ours / count,
              1e3 * times.theirs / count, times.theirs / times.ours);
  return times.theirs / times.ours;
}

/// Returns the relative difference of the two hypervolumes.
double compare_hypervolumes(const char* shape, std::size_t objectives, std::size_t count) {
  const std::vector<double> points = test::random_front(shape, count, objectives);
  const std::vector<double> reference = test::front_reference(objectives);
  const std::vector<pagmo::vector_double> rows = rows_of(points, objectives);
  double ours = 0, theirs = 0;
  const PairedMinima times = time_alternately(
      9, [&] { ours = hypervolume(points, objectives, reference); },
      [&] { theirs = pagmo::hypervolume(rows, false).compute(reference); });
  const double difference = std::fabs(ours - theirs) / theirs;
  std::printf("%10zu  %-6s  %zu  %10.1f  %10.1f  %10.1e\n", count, shape, objectives, 1e6 * times.ours,
              1e6 * times.theirs, difference);
  return difference;
}

constexpr const char* kShapes[] = {"sphere", "plane", "cloud"};

void print_golden() {
  const char* before = "[\n";
  for (const std::size_t objectives : {2, 3})
    for (const char* shape : kShapes)
      for (const std::size_t count : {10, 100, 1000}) {
        const auto rows = rows_of(test::random_front(shape, count, objectives), objectives);
        std::printf("%s  {\"objectives\": %zu, \"shape\": \"%s\", \"points\": %zu, \"hypervolume\": %.17g}", before,
                    objectives, shape, count,
                    pagmo::hypervolume(rows, false).compute(test::front_reference(objectives)));
        before = ",\n";
      }
  std::printf("\n]\n");
}

}  // namespace

int main(int count, char** arguments) {
  if (count == 2 && std::string(arguments[1]) == "--golden") {
    print_golden();
    return 0;
  }
  std::printf("non-dominated sorting and selection, us per survivor\n%10s  %-6s  %s  %10s  %10s  %8s\n", "population",
              "points", "m", "ours", "pagmo's", "ratio");
  for (const std::size_t population : {100, 1000, 10000})
    for (const std::size_t objectives : {2, 3})
      for (const char* shape : {"sphere", "cloud"}) compare_selection(shape, objectives, population);

  bool passed = true;
  std::printf("\nwhole generations without the evaluations, ms\n%10s  %s  %10s  %10s  %8s\n", "population", "m", "ours",
              "pagmo's", "ratio");
  for (const std::size_t population : {100, 1000, 10000})
    for (const std::size_t objectives : {2, 3}) {
      const double ratio = compare_generations(objectives, population);
      if (population == 1000 && objectives == 2) passed = passed && ratio >= 20;
    }

  std::printf("\nhypervolumes, us\n%10s  %-6s  %s  %10s  %10s  %10s\n", "points", "", "m", "ours", "pagmo's",
              "difference");
  for (const std::size_t points : {100, 1000, 10000})
    for (const std::size_t objectives : {2, 3})
      for (const char* shape : kShapes) passed = compare_hypervolumes(shape, objectives, points) <= 1e-12 && passed;
  return passed ? 0 : 1;
}
