// What every optimiser of a study's chain is given, promises and returns.
//
// An optimiser is a deterministic function of (problem, seed, starts): all it learns comes through the evaluator. That
// is what makes resuming simple: a resumed run starts the optimiser anew and serves the recorded evaluations first, so
// there is no state of its own to store, and every optimiser resumes bit for bit.
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

inline constexpr std::size_t kManyObjectives = std::numeric_limits<std::size_t>::max();  ///< any number

/// What an optimiser can handle, as data: a study that asks for more is refused before it starts.
struct Capabilities {
  std::size_t min_objectives = 1;  ///< 0: a plain sweep
  std::size_t max_objectives = 1;
  const char* objectives_hint = "";  ///< said where a study has more
  bool constraints = true;
  bool discrete = true;         ///< variables with a step
  bool needs_gradient = false;  ///< refuses surveys without derivative (voxels)
  bool starts = false;          ///< works on from given designs, several if asked
  bool needs_front = false;     ///< works on from a front that a stage before it has found
};

/// What an optimiser tells after each batch of evaluations ("generation").
struct Generation {
  std::int64_t number = 0;                            ///< 0 is the start population
  std::size_t first_row = 0;                          ///< rows [first_row, table.size()) are new
  const EvaluationTable* table = nullptr;             ///< all evaluations of this stage so far
  const std::vector<std::int64_t>* population;        ///< rows that form the population now
  std::int64_t best_row = -1;                         ///< best by `better`; -1 while nothing is evaluated
  const std::vector<StartOutcome>* starts = nullptr;  ///< solvers: the starts that have ended
  /// Solvers: what is known of starts beyond the table, for a checkpoint.
  std::function<std::vector<StartAhead>()> ahead = {};
  /// Evaluations that the stage will still make, at most; none: its limit less those that it has made.
  std::optional<std::int64_t> left = {};
  bool alone = false;  ///< reported by a rank as its own work comes along: the ranks compare at the stage's end
  const Front* front = nullptr;  ///< several objectives
};

/// Time limits, signals, checkpoints and the screen live behind this. Called by one thread at a time.
class Monitor {
 public:
  virtual ~Monitor() = default;
  /// After each generation. False: stop now (the stage then ends with StopReason::interrupted).
  virtual bool generation(const Generation& generation) = 0;
  /// Between generations: false as generation().
  virtual bool goes_on() { return true; }
  /// Something that the user must be told, one sentence.
  virtual void warn(const std::string& sentence) = 0;
};

struct StageResult {
  StopReason reason = StopReason::generations;
  std::int64_t best_row = -1;             ///< row of the stage's table
  std::vector<StartOutcome> starts = {};  ///< solvers only
  std::vector<StartAhead> ahead = {};     ///< solvers that were interrupted
  std::optional<Front> front = {};        ///< several objectives
};

/// A design to begin from, and where it comes from.
struct StartDesign {
  std::vector<double> design;
  std::string origin;
};

/// Of the front that the stages before have found: what solvers scale by, and compare with.
struct KnownFront {
  std::vector<double> extents = {};    ///< range of each objective, else its size, > 0
  std::vector<double> reference = {};  ///< corner of its hypervolume; empty: none
};

struct StageInput {
  const Problem& problem;
  Evaluator& evaluator;
  Monitor& monitor;
  std::uint64_t seed = 1;
  std::vector<StartDesign> starts;  ///< designs to begin from; may be empty
  KnownFront known_front = {};      ///< several objectives
  /// A resumed stage: the evaluations on record, of which those of recorded_starts, which had ended, come first, and
  /// what was known of the starts beyond them.
  const EvaluationTable* recorded = nullptr;
  std::vector<StartOutcome> recorded_starts = {};
  std::vector<StartAhead> recorded_ahead = {};

  /// Rows [first, table.size()) of the stage's table: from the record, where it has them, else by the evaluator.
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
  /// Runs the stage; `table` is empty and receives every evaluation in order.
  virtual StageResult minimise(const StageInput& input, EvaluationTable& table) const = 0;
  /// Evaluations the stage will make at most (for the estimate before a run).
  virtual std::int64_t evaluation_limit(const Problem& problem) const = 0;
  /// How many evaluations it has under way at once, at most.
  virtual std::int64_t at_once() const { return std::numeric_limits<std::int64_t>::max(); }
  /// What the stage's evaluations must hold.
  virtual Detail detail() const { return Detail::enough; }
};

/// An entry of the catalogue of optimisers.
struct OptimiserEntry {
  std::string name;
  std::string meaning;  ///< one line
  /// May depend on options (the algorithm of a library).
  Capabilities (*capabilities)(const Options&);
  std::vector<OptionSpec> options;
  std::unique_ptr<Optimiser> (*make)(const Options&, const DesignSpace&);
  /// Fills in the options without value whose default depends on the variables, so that listings show what `make` would
  /// take. Null: there are none.
  void (*resolve)(Options&, const DesignSpace&) = nullptr;
};

/// Every optimiser there is, in the order in which `pkmopt list` shows them.
const std::vector<OptimiserEntry>& all_optimisers();

}  // namespace pkm
