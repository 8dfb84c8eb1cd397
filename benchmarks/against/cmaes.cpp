// Compares a study (genetic algorithm with 20 designs and two generations, then SLSQP) with pagmo's CMA-ES (population
// 8, l1 penalty) on exact volumes, with 20 seeds each. An evaluation is a value, or a value with its gradient. Two
// problems: the wide bounds of 4PPa-2PaR, and a linear Delta from a mechanism file.
//
// Prints, for each optimiser, how many seeds reached the optimum within a relative error, and the median number of
// evaluations. Exit code 1 if a study needs a median of 150 evaluations or more for an error of 1e-8.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <optional>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/runner/run_study.hpp"
#include "objectives/all.hpp"

namespace {

using namespace pkm;

constexpr int kSeeds = 20;

Study study_of(const std::string& path) {
  return load_study_toml(path, {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// Objective and constraint violation of an evaluation.
struct EvaluationResult {
  double value, violation;
};

EvaluationResult evaluate(const DesignProblem& problem, std::span<const double> design) {
  EvaluationTable table(problem.shape(Detail::complete));
  table.extend(1);
  std::ranges::copy(design, table.design(0).begin());
  Scratch scratch;
  problem.evaluate(design, scratch, table.slot(0));
  return {table.objective_row(0)[0], violation(table.margin_row(0))};
}

/// Counts the evaluations until a feasible design is within the relative `error` of the optimum.
class EvaluationCounter {
 public:
  EvaluationCounter(double optimum, double error) : optimum_(optimum), error_(error) {}
  void add(const EvaluationResult& result) {
    ++evaluations_;
    if (!reached_ && result.violation == 0 && result.value >= optimum_ * (1 - error_)) reached_ = evaluations_;
  }
  std::optional<std::int64_t> reached() const { return reached_; }

 private:
  double optimum_, error_;
  std::int64_t evaluations_ = 0;
  std::optional<std::int64_t> reached_;
};

/// The function that CMA-ES minimises on the unit cube: -ratio + 10 * violation. The weight exceeds all multipliers.
struct Penalised {
  const DesignProblem* problem = nullptr;
  EvaluationCounter* counter = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& unit) const {
    std::vector<double> design(unit.size());
    for (std::size_t i = 0; i < unit.size(); ++i) design[i] = problem->space().from_unit(i, unit[i]);
    const EvaluationResult result = evaluate(*problem, design);
    counter->add(result);
    return {-result.value + 10 * result.violation};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const std::size_t variables = problem->space().variables().size();
    return {pagmo::vector_double(variables, 0.0), pagmo::vector_double(variables, 1.0)};
  }
};

std::vector<std::optional<std::int64_t>> run_study_seeds(const Study& from, double optimum, double error) {
  std::vector<std::optional<std::int64_t>> counts;
  const std::string file =
      (std::filesystem::temp_directory_path() / ("cmaes-" + std::to_string(getpid()) + ".h5")).string();
  Study study = from;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    study.seed = static_cast<std::uint64_t>(seed);
    Progress silent;
    const StudyContents contents = run_study(study, file, true, {}, silent).contents;
    EvaluationCounter counter(optimum, error);
    for (const StageRecord& stage : contents.stages)
      for (std::size_t row = 0; row < stage.table.size(); ++row)
        counter.add({stage.table.objective_row(row)[0], stage.table.status[row] == Status::feasible ? 0.0 : 1.0});
    counts.push_back(counter.reached());
  }
  std::filesystem::remove(file);
  return counts;
}

std::vector<std::optional<std::int64_t>> run_cmaes_seeds(const DesignProblem& problem, double optimum, double error) {
  std::vector<std::optional<std::int64_t>> counts;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    EvaluationCounter counter(optimum, error);
    pagmo::population population{pagmo::problem{Penalised{&problem, &counter}}, 8, seed};
    pagmo::algorithm{pagmo::cmaes{500, -1, -1, -1, -1, 0.3, 1e-12, 1e-14, false, true, seed}}.evolve(population);
    counts.push_back(counter.reached());
  }
  return counts;
}

/// Prints one line and returns the median, for which seeds that did not reach the optimum count as infinity.
double report(const char* who, double error, std::vector<std::optional<std::int64_t>> counts) {
  std::vector<double> all;
  int reached = 0;
  for (const auto& count : counts) {
    reached += count.has_value();
    all.push_back(count ? static_cast<double>(*count) : std::numeric_limits<double>::infinity());
  }
  std::sort(all.begin(), all.end());
  const double median = (all[all.size() / 2 - 1] + all[all.size() / 2]) / 2;
  std::printf("%-28s within %.0e: %2d of %d seeds, median %6.0f evaluations, minimum %4.0f\n", who, error, reached,
              kSeeds, median, all.front());
  return median;
}

}  // namespace

int main() {
  struct Case {
    const char *name, *path;
    double optimum;  ///< found by both optimisers
  };
  const Case cases[] = {
      {"4PPa-2PaR, wide bounds", PKM_EXPERIMENTS "/4ppa-2par/wide-bounds-20-by-2.toml", 0.311626100727},
      {"linear Delta, mechanism file", PKM_EXPERIMENTS "/mechanisms/studies/linear-delta-columns.toml",
       0.4110196439245144},
  };
  const std::vector<Stage> stages = study_of(cases[0].path).stages;
  bool reached = true;
  for (const Case& each : cases) {
    Study study = study_of(each.path);
    study.stages = stages;
    const DesignProblem& problem = *study.problem;
    std::printf("%s\n", each.name);
    for (const double error : {1e-4, 1e-8}) {
      const double study_median =
          report("20 x 2 designs, then SLSQP", error, run_study_seeds(study, each.optimum, error));
      report("pagmo CMA-ES, population 8", error, run_cmaes_seeds(problem, each.optimum, error));
      reached = reached && study_median < 150;
    }
  }
  return reached ? 0 : 1;
}
