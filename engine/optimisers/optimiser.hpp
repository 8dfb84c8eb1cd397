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

inline constexpr std::size_t kUnlimitedObjectives = std::numeric_limits<std::size_t>::max();  ///< no upper limit

/// The kinds of problem that an optimiser can handle. A study that needs more is rejected when it is read.
struct Capabilities {
  std::size_t min_objectives = 1;  ///< 0: a parameter sweep
  std::size_t max_objectives = 1;
  const char* too_many_objectives_hint = "";  ///< added to the error message where a study has more objectives
  bool constraints = true;
  bool discrete = true;         ///< supports variables with a step
  bool needs_gradient = false;  ///< needs derivatives, which voxel counts do not have
  bool starts = false;          ///< local search from one or several start designs
  bool needs_front = false;     ///< starts from the Pareto front of an earlier stage
};

/// Progress report after each batch of evaluations ("generation").
struct Generation {
  std::int64_t number = 0;                      ///< 0 is the initial population
  std::size_t first_row = 0;                    ///< rows [first_row, table.size()) are new
  const EvaluationTable* table = nullptr;       ///< all evaluations of this stage so far
  const std::vector<std::int64_t>* population;  ///< rows of the current population
  std::int64_t best_row = -1;                   ///< best row (several objectives: compromise solution); -1: none yet
  const std::vector<StartOutcome>* starts = nullptr;  ///< solvers: outcomes of the finished starts
  /// For solvers only: returns the evaluations and outcomes of starts that are not yet merged into the table, for a
  /// checkpoint.
  std::function<std::vector<UnmergedRun>()> ahead = {};
  /// Maximum number of evaluations still to be made; nullopt: the stage's limit less the evaluations made.
  std::optional<std::int64_t> left = {};
  bool alone = false;  ///< reported without synchronising the ranks; they are compared only at the end of the stage
  const Front* front = nullptr;  ///< several objectives: the Pareto front so far
};

/// Receives progress reports and decides when to stop: time limits, signals, checkpoints, screen output. Called by one
/// thread at a time.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// Reports a generation. @return false to stop the stage, which then ends with StopReason::interrupted
  virtual bool generation(const Generation& generation) = 0;
  /// Called between generations. @return false to stop the stage, which then ends with StopReason::interrupted
  virtual bool goes_on() { return true; }
  /// Shows a warning, one sentence, to the user.
  virtual void warn(const std::string& sentence) = 0;
};

struct StageResult {
  StopReason reason = StopReason::generations;
  std::int64_t best_row = -1;             ///< row of the stage's table
  std::vector<StartOutcome> starts = {};  ///< solvers only
  std::vector<UnmergedRun> ahead = {};    ///< interrupted solvers: starts not yet merged into the table
  std::optional<Front> front = {};        ///< several objectives: the Pareto front
};

/// A start design and a description of its origin ("best of stage 1").
struct StartDesign {
  std::vector<double> design;
  std::string origin;
};

/// Scaling data from the Pareto front of the earlier stages.
struct PreviousFront {
  std::vector<double> extents = {};  ///< range of each objective, > 0; the objective's absolute value if the range is 0
  std::vector<double> reference = {};  ///< reference point of its hypervolume; empty: none
};

struct StageInput {
  const Problem& problem;
  Evaluator& evaluator;
  Monitor& monitor;
  std::uint64_t seed = 1;
  std::vector<StartDesign> starts;    ///< start designs; may be empty
  PreviousFront previous_front = {};  ///< several objectives
  /// Resumed stage: the recorded evaluations (those of the finished starts `recorded_starts` come first), and the
  /// evaluations of further starts that were not yet merged into the table. Otherwise null and empty.
  const EvaluationTable* recorded = nullptr;
  std::vector<StartOutcome> recorded_starts = {};
  std::vector<UnmergedRun> recorded_unmerged_runs = {};

  /// Evaluates rows [first, table.size()) of the stage's table; recorded rows are replayed instead.
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
  /// Maximum number of evaluations of the stage, for the time estimate before a run.
  virtual std::int64_t evaluation_limit(const Problem& problem) const = 0;
  /// Maximum number of concurrent evaluations.
  virtual std::int64_t at_once() const { return std::numeric_limits<std::int64_t>::max(); }
  /// The level of detail at which the stage needs designs to be evaluated.
  virtual Detail detail() const { return Detail::enough; }
};

/// An entry of the catalogue of optimisers.
struct OptimiserEntry {
  std::string name;
  std::string meaning;  ///< one line
  /// The capabilities depend on the options if these select an algorithm of a library.
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
