// Exact volumes: a study of 20 designs, two generations and SLSQP against pagmo's CMA-ES (population 8, l1 penalty), 20
// seeds each, in one run. An evaluation is a value or a value with its gradient. Two problems: the wide bounds of
// 4PPa-2PaR, and a linear Delta that is a file.
//
// Prints, per solver, how many seeds came within a relative error of the optimum, and the median of the evaluations
// that this took. Exit code 1 when a study misses 1e-8 in 150 evaluations.
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
#include "engine/mechanisms/all.hpp"
#include "engine/study/run_study.hpp"
#include "objectives/all.hpp"

namespace {

using namespace pkm;

constexpr int kSeeds = 20;

Study study_of(const std::string& path) {
  return load_study_toml(path, {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// Objective and violation of one evaluation.
struct Trial {
  double value, violation;
};

Trial evaluate(const DesignProblem& problem, std::span<const double> design) {
  EvaluationTable table(problem.shape(Detail::complete));
  table.extend(1);
  std::ranges::copy(design, table.design(0).begin());
  Scratch scratch;
  problem.evaluate(design, scratch, table.slot(0));
  return {table.objective_row(0)[0], violation(table.margin_row(0))};
}

/// Evaluations after which a feasible design within `error` of the optimum was known.
class Counter {
 public:
  Counter(double optimum, double error) : optimum_(optimum), error_(error) {}
  void add(const Trial& trial) {
    ++made_;
    if (!reached_ && trial.violation == 0 && trial.value >= optimum_ * (1 - error_)) reached_ = made_;
  }
  std::optional<std::int64_t> reached() const { return reached_; }

 private:
  double optimum_, error_;
  std::int64_t made_ = 0;
  std::optional<std::int64_t> reached_;
};

/// What CMA-ES minimises: -ratio + 10 * violation on the unit cube. The weight exceeds every multiplier.
struct Penalised {
  const DesignProblem* problem = nullptr;
  Counter* counter = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& unit) const {
    std::vector<double> design(unit.size());
    for (std::size_t i = 0; i < unit.size(); ++i) design[i] = problem->space().from_unit(i, unit[i]);
    const Trial trial = evaluate(*problem, design);
    counter->add(trial);
    return {-trial.value + 10 * trial.violation};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const std::size_t variables = problem->space().variables().size();
    return {pagmo::vector_double(variables, 0.0), pagmo::vector_double(variables, 1.0)};
  }
};

std::vector<std::optional<std::int64_t>> by_study(const Study& from, double optimum, double error) {
  std::vector<std::optional<std::int64_t>> counts;
  const std::string file =
      (std::filesystem::temp_directory_path() / ("cmaes-" + std::to_string(getpid()) + ".h5")).string();
  Study study = from;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    study.seed = static_cast<std::uint64_t>(seed);
    Progress silent;
    const StudyContents contents = run_study(study, file, true, {}, silent).contents;
    Counter counter(optimum, error);
    for (const StageRecord& stage : contents.stages)
      for (std::size_t row = 0; row < stage.table.size(); ++row)
        counter.add({stage.table.objective_row(row)[0], stage.table.status[row] == Status::feasible ? 0.0 : 1.0});
    counts.push_back(counter.reached());
  }
  std::filesystem::remove(file);
  return counts;
}

std::vector<std::optional<std::int64_t>> by_cmaes(const DesignProblem& problem, double optimum, double error) {
  std::vector<std::optional<std::int64_t>> counts;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Counter counter(optimum, error);
    pagmo::population population{pagmo::problem{Penalised{&problem, &counter}}, 8, seed};
    pagmo::algorithm{pagmo::cmaes{500, -1, -1, -1, -1, 0.3, 1e-12, 1e-14, false, true, seed}}.evolve(population);
    counts.push_back(counter.reached());
  }
  return counts;
}

/// The median counts seeds that did not get there as infinitely many.
double report(const char* who, double error, std::vector<std::optional<std::int64_t>> counts) {
  std::vector<double> all;
  int reached = 0;
  for (const auto& count : counts) {
    reached += count.has_value();
    all.push_back(count ? static_cast<double>(*count) : std::numeric_limits<double>::infinity());
  }
  std::sort(all.begin(), all.end());
  const double median = (all[all.size() / 2 - 1] + all[all.size() / 2]) / 2;
  std::printf("%-28s within %.0e: %2d of %d seeds, median %6.0f evaluations, least %4.0f\n", who, error, reached,
              kSeeds, median, all.front());
  return median;
}

}  // namespace

int main() {
  struct Case {
    const char *name, *path;
    double optimum;  ///< by both solvers
  };
  const Case cases[] = {
      {"4PPa-2PaR, wide bounds", PKM_EXPERIMENTS "/4ppa-2par/wide-bounds-20-by-2.toml", 0.311626100727},
      {"linear Delta, a file", PKM_EXPERIMENTS "/mechanisms/studies/linear-delta-columns.toml", 0.4110196439245144},
  };
  const std::vector<Stage> stages = study_of(cases[0].path).stages;
  bool reached = true;
  for (const Case& each : cases) {
    Study study = study_of(each.path);
    study.stages = stages;
    const DesignProblem& problem = *study.problem;
    std::printf("%s\n", each.name);
    for (const double error : {1e-4, 1e-8}) {
      const double ours = report("20 x 2 designs, then SLSQP", error, by_study(study, each.optimum, error));
      report("pagmo CMA-ES, population 8", error, by_cmaes(problem, each.optimum, error));
      reached = reached && ours < 150;
    }
  }
  return reached ? 0 : 1;
}
