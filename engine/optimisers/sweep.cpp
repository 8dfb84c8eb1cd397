// Parameter sweep: evaluates the designs of a grid to show how the objectives depend on the variables. It does not
// search for an optimum.
//
// one-at-a-time: generation 0 is the centre point (the first start design, otherwise the centre of the design space);
// generation i + 1 varies variable i over its range and keeps the others at the centre point. full-factorial: all
// combinations, the last variable varies fastest, in generations of at most 1000 designs.
#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/pareto_archive.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxGenerationSize = 1000;
constexpr double kMaxDesigns = 1e8;

using Levels = std::vector<std::vector<double>>;  // for each variable, its values on the grid, in ascending order

// The values of each variable on the grid: equally spaced over its range, rounded to its step if the variable has one,
// without duplicates.
Levels grid_levels(const DesignSpace& space, std::size_t points) {
  Levels levels(space.dimension());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    for (std::size_t k = 0; k < points; ++k)
      levels[i].push_back(space.from_unit(i, static_cast<double>(k) / static_cast<double>(points - 1)));
    levels[i].erase(std::unique(levels[i].begin(), levels[i].end()), levels[i].end());
  }
  return levels;
}

double combinations(const Levels& levels) {
  double product = 1;
  for (const auto& values : levels) product *= static_cast<double>(values.size());
  return product;
}

// Evaluates and reports the rows appended to the evaluation table, one generation at a time, and tracks the best
// design.
class SweepRecorder {
 public:
  SweepRecorder(const StageInput& input, EvaluationTable& table) : input_(input), table_(table) {
    if (input.problem.objectives().size() > 1) archive_.emplace(ParetoArchivePlan{}, input.problem, table);
  }

  /// Evaluates and reports the rows appended since the last call.
  /// @return false if the monitor requests a stop
  bool finish_generation() {
    input_.evaluate(table_, first_);
    for (std::size_t row = first_; row < table_.size(); ++row) {
      const RankKey candidate = ranked(input_.problem.objectives(), table_, row);
      if (best_.row < 0 || candidate < best_) best_ = candidate;
    }
    rows_.resize(table_.size() - first_);
    std::iota(rows_.begin(), rows_.end(), static_cast<std::int64_t>(first_));
    const std::size_t first = std::exchange(first_, table_.size());
    if (archive_) archive_->add(rows_);
    return input_.monitor.generation({.number = generation_++,
                                      .first_row = first,
                                      .table = &table_,
                                      .population = &rows_,
                                      .best_row = best_row(),
                                      .front = archive_ ? &archive_->front() : nullptr});
  }

  StageResult result(StopReason reason) const {
    StageResult result{reason, best_row()};
    if (archive_) result.front = archive_->front();
    return result;
  }

 private:
  std::int64_t best_row() const {
    return archive_ && archive_->compromise_row() >= 0 ? archive_->compromise_row() : best_.row;
  }

  const StageInput& input_;
  EvaluationTable& table_;
  std::size_t first_ = 0;
  std::int64_t generation_ = 0;
  std::vector<std::int64_t> rows_;
  RankKey best_;
  std::optional<ParetoArchive> archive_;
};

class Sweep final : public Optimiser {
 public:
  Sweep(Levels levels, bool factorial) : levels_(std::move(levels)), factorial_(factorial) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    SweepRecorder recorder(input, table);
    const bool finished = factorial_ ? all_combinations(recorder, table) : one_at_a_time(input, recorder, table);
    return recorder.result(finished ? StopReason::exhausted : StopReason::interrupted);
  }

  std::int64_t evaluation_limit(const Problem&) const override {
    if (factorial_) return static_cast<std::int64_t>(combinations(levels_));
    std::int64_t sum = 1;
    for (const auto& values : levels_) sum += static_cast<std::int64_t>(values.size());
    return sum;
  }

 private:
  // Evaluates the designs of a one-at-a-time sweep. Returns false if the monitor stopped the sweep before its last
  // generation, as does all_combinations() for a full-factorial sweep.
  bool one_at_a_time(const StageInput& input, SweepRecorder& recorder, EvaluationTable& table) const {
    const DesignSpace& space = input.problem.space();
    std::vector<double> centre(space.dimension());
    for (std::size_t i = 0; i < centre.size(); ++i)
      centre[i] = input.starts.empty() ? space.from_unit(i, 0.5) : space.nearest(i, input.starts.front().design[i]);
    append(table, centre);
    bool continues = recorder.finish_generation();
    for (std::size_t i = 0; i < centre.size(); ++i) {
      if (!continues) return false;
      std::vector<double> design = centre;
      for (const double value : levels_[i]) {
        design[i] = value;
        append(table, design);
      }
      continues = recorder.finish_generation();
    }
    return true;
  }

  bool all_combinations(SweepRecorder& recorder, EvaluationTable& table) const {
    std::vector<double> design(levels_.size());
    const auto count = static_cast<std::size_t>(combinations(levels_));
    for (std::size_t k = 0; k < count;) {
      std::size_t quotient = k++;
      for (std::size_t i = design.size(); i-- > 0; quotient /= levels_[i].size())
        design[i] = levels_[i][quotient % levels_[i].size()];
      append(table, design);
      if (k < count && k % kMaxGenerationSize != 0) continue;
      if (!recorder.finish_generation()) return k == count;
    }
    return true;
  }

  static void append(EvaluationTable& table, const std::vector<double>& design) {
    const std::size_t row = table.extend(1);
    std::copy(design.begin(), design.end(), table.design(row).begin());
  }

  Levels levels_;
  bool factorial_;
};

std::unique_ptr<Optimiser> make_sweep(const Options& options, const DesignSpace& space) {
  Levels levels = grid_levels(space, static_cast<std::size_t>(options.integer("points")));
  const bool factorial = options.word("design") == "full-factorial";
  if (factorial && combinations(levels) > kMaxDesigns)
    throw std::invalid_argument("points = " + std::to_string(options.integer("points")) + " with " +
                                std::to_string(space.dimension()) + " variables gives " +
                                shortest(combinations(levels)) + " designs; a full-factorial sweep has at most 1e+08");
  return std::make_unique<Sweep>(std::move(levels), factorial);
}

}  // namespace

OptimiserEntry sweep() {
  return {.name = "sweep",
          .meaning = "parameter sweep on a grid, one variable at a time or full factorial",
          .capabilities =
              [](const Options&) { return Capabilities{.min_objectives = 0, .max_objectives = kUnlimitedObjectives}; },
          .options = {word_option("design", {"one-at-a-time", "full-factorial"},
                                  "vary one variable at a time, or combine all values"),
                      integer_option("points", std::int64_t{41}, 2, 1e6, "values per variable, both bounds included")},
          .make = make_sweep};
}

}  // namespace pkm
