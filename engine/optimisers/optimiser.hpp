// Interface of an optimiser, which runs one stage of a study: its input, progress reports, result and catalogue entry.
//
// An optimiser is a deterministic function of (problem, seed, start designs) that obtains all its information through
// the evaluator. Resuming therefore needs no stored optimiser state: a resumed run restarts the optimiser, the recorded
// evaluations are replayed first, and the run continues bit-identically.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/problem/front.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/start_outcome.hpp"

namespace pkm {

/// Value of Capabilities::max_objectives: no limit.
inline constexpr std::size_t kUnlimitedObjectives = std::numeric_limits<std::size_t>::max();

/// The kinds of problem that an optimiser can handle. A study that needs more is rejected when it is read.
struct Capabilities {
  std::size_t min_objectives = 1;  ///< minimum number of objectives of the study; 0 for a parameter sweep
  std::size_t max_objectives = 1;
  /// Advice appended to the error message if the study has more objectives than `max_objectives`.
  const char* too_many_objectives_hint = "";
  bool constraints = true;
  bool discrete = true;         ///< true if variables with a step (discrete variables) are supported
  bool needs_gradient = false;  ///< true if derivatives are required, which studies that count voxels do not have
  bool starts = false;          ///< true for a local search from one or several start designs
  bool needs_front = false;     ///< true if the stage starts from the Pareto front of an earlier stage
};

/// Progress report after each batch of evaluations ("generation").
struct Generation {
  std::int64_t number = 0;                      ///< number of the generation; 0 is the initial population
  std::size_t first_row = 0;                    ///< this generation has added the rows [first_row, table.size())
  const EvaluationTable* table = nullptr;       ///< all evaluations of this stage so far
  const std::vector<std::int64_t>* population;  ///< row numbers of the current population
  /// Row number of the best design (with several objectives, of the compromise solution); -1: none yet.
  std::int64_t best_row = -1;
  /// Outcomes of those solver runs of a multistart search that have finished; null for optimisers without such runs.
  const std::vector<StartOutcome>* starts = nullptr;
  /// In a solver stage, function that returns, for a checkpoint, the evaluations and outcomes of those multistart runs
  /// that are not yet merged into the evaluation table.
  std::function<std::vector<UnmergedRun>()> ahead = {};
  /// Maximum number of evaluations still to be made; nullopt: the evaluation limit of the stage minus the evaluations
  /// made.
  std::optional<std::int64_t> left = {};
  /// True if this MPI rank alone reports the generation, and the evaluations of all ranks are compared only at the end
  /// of the stage.
  bool alone = false;
  const Front* front = nullptr;  ///< the Pareto front so far, with several objectives; otherwise null
};

/// Receives progress reports and decides when to stop: time limits, signals, checkpoints, screen output. Called by one
/// thread at a time.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// Reports a generation.
  /// @return false to stop the stage, which then ends with StopReason::interrupted
  virtual bool generation(const Generation& generation) = 0;
  /// Called between generations, to check for a stop request.
  /// @return false to stop the stage, which then ends with StopReason::interrupted
  virtual bool goes_on() { return true; }
  /// Shows a warning, which is one sentence, to the user.
  virtual void warn(const std::string& sentence) = 0;
};

struct StageResult {
  StopReason reason = StopReason::generations;
  std::int64_t best_row = -1;             ///< row number of the best design in the evaluation table; -1: none
  std::vector<StartOutcome> starts = {};  ///< outcome of each multistart run; empty for other stages
  /// Evaluations of those multistart runs that an interrupted solver stage has not yet merged into the evaluation
  /// table; otherwise empty.
  std::vector<UnmergedRun> ahead = {};
  std::optional<Front> front = {};  ///< the Pareto front, with several objectives; otherwise std::nullopt
};

/// A start design and a description of its origin ("best of stage 1").
struct StartDesign {
  std::vector<double> design;
  std::string origin;
};

/// Data of the Pareto front of the earlier stages, by which a solver scales several objectives.
struct PreviousFront {
  /// Range of each objective over the front, > 0; if the range is 0, the absolute value of the objective.
  std::vector<double> extents = {};
  std::vector<double> reference = {};  ///< reference point of the hypervolume of the front; empty: none
};

struct StageInput {
  const Problem& problem;
  Evaluator& evaluator;
  Monitor& monitor;
  std::uint64_t seed = 1;
  std::vector<StartDesign> starts;    ///< start designs from the study or from earlier stages; may be empty
  PreviousFront previous_front = {};  ///< front of the earlier stages; empty for a single objective
  /// For a resumed stage, the recorded evaluations, in which those of the finished multistart runs `recorded_starts`
  /// come first, and the evaluations of further multistart runs that were not yet merged into the evaluation table. For
  /// any other stage, `recorded` is null and the lists are empty.
  const EvaluationTable* recorded = nullptr;
  std::vector<StartOutcome> recorded_starts = {};
  std::vector<UnmergedRun> recorded_unmerged_runs = {};

  /// Evaluates rows [first, table.size()) of the stage's evaluation table; recorded rows are replayed instead.
  void evaluate(EvaluationTable& table, std::size_t first) const {
    if (recorded)
      ReplayEvaluator(evaluator, *recorded).evaluate(problem, table, first);
    else
      evaluator.evaluate(problem, table, first);
  }
};

class Optimiser {
 public:
  virtual ~Optimiser() = default;
  /// Runs the stage. `table` is empty and receives all evaluations in order.
  virtual StageResult minimise(const StageInput& input, EvaluationTable& table) const = 0;
  /// Maximum number of evaluations that the stage can make. The time estimate before a run uses it.
  virtual std::int64_t evaluation_limit(const Problem& problem) const = 0;
  /// Maximum number of designs that the stage evaluates concurrently.
  virtual std::int64_t at_once() const { return std::numeric_limits<std::int64_t>::max(); }
  /// Detail in which designs must be evaluated for this stage, for example with derivatives.
  virtual Detail detail() const { return Detail::enough; }
};

/// An entry of the catalogue of optimisers.
struct OptimiserEntry {
  std::string name;
  std::string meaning;  ///< description of the optimiser, one line
  /// Capabilities for given options: an option may select a library's algorithm, which has capabilities of its own.
  Capabilities (*capabilities)(const Options&);
  std::vector<OptionSpec> options;
  std::unique_ptr<Optimiser> (*make)(const Options&, const DesignSpace&);
  /// Sets the unset options whose default value depends on the variables, so that listings show the values that `make`
  /// uses. Null if there are no such options.
  void (*resolve)(Options&, const DesignSpace&) = nullptr;
};

/// All optimisers, in the order in which `pkmopt list` shows them.
const std::vector<OptimiserEntry>& all_optimisers();

}  // namespace pkm
