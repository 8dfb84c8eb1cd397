// All that a study file holds, as plain data: what the runner fills, what a resumed run starts from, what reports and
// exports read. How it lies in the file is written down in engine/storage/README.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/options.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/source_text.hpp"
#include "engine/mechanism/abilities/bounds.hpp"
#include "engine/mechanism/survey.hpp"
#include "engine/problem/front.hpp"
#include "engine/problem/start_outcome.hpp"

namespace pkm {

/// Version of the file's layout. A file of a newer one is refused by name.
inline constexpr int kStudySchema = 5;

/// One parameter of the study's mechanism, in the mechanism's order.
struct ParameterRecord {
  std::string name;
  std::string unit;
  double value = 0;            ///< fixed value, SI; the nominal one where the parameter varies
  std::int64_t variable = -1;  ///< index among the variables; -1: fixed
};

/// What is optimised, spelled out, so that a reader needs no TOML.
struct ProblemRecord {
  std::string mechanism;  ///< "4ppa-2par"
  std::vector<ParameterRecord> parameters;
  std::vector<Variable> variables;
  std::vector<ObjectiveInfo> objectives;
  std::vector<MarginInfo> margins;
  std::vector<ReportInfo> reports;

  EvaluationShape shape(Detail detail = Detail::enough) const {
    return {variables.size(), objectives.size(), margins.size(), reports.size(), detail};
  }
};

/// A limit that `pkmopt resume` changed after the study was begun. Replay needs it, because the TOML text stays as is.
struct Extension {
  std::int64_t stage = 0;  ///< 0 is the first stage
  std::string limit;       ///< "generations", "evaluations" or "time"
  double value = 0;        ///< new limit; time in s
};

/// One entry per complete generation; all arrays have size() elements, except population.
struct GenerationRecords {
  std::vector<std::int64_t> first_row;         ///< the generation's first row in the evaluation table
  std::vector<std::int64_t> best_row;          ///< best so far; -1 while there is none
  std::vector<double> feasible_share;          ///< of the population, in [0, 1]
  std::vector<double> diversity;               ///< as the runner defines it
  std::vector<double> seconds;                 ///< wall time of the study at the generation's end
  std::vector<std::int64_t> population_first;  ///< where the generation's rows begin in `population`
  std::vector<std::int64_t> population;        ///< rows that form the population, generation after generation

  std::size_t size() const { return first_row.size(); }
  /// Rows of the table that form the population of generation g.
  std::span<const std::int64_t> population_of(std::size_t g) const;
  /// The row behind the last one that generation g evaluated, of a table of `rows`.
  std::size_t end_of(std::size_t g, std::size_t rows) const {
    return g + 1 < size() ? static_cast<std::size_t>(first_row[g + 1]) : rows;
  }
  /// Of each of the table's `rows` rows the generation that evaluated it.
  std::vector<std::int64_t> generation_of_rows(std::size_t rows) const;
};

/// A bound or constraint that holds a design back.
struct ActiveRecord {
  std::string name;
  std::string kind;       ///< "lower bound", "upper bound" or "constraint"
  double multiplier = 0;  ///< gain of the objective per unit by which it is moved out of the way
  std::string unit;       ///< of what is moved
};

/// What a change of one parameter does to the objective.
struct SensitivityRecord {
  std::string parameter;
  std::string unit;
  double as_built = 0;     ///< d objective / d parameter, the rest of the design as it is
  double reoptimised = 0;  ///< the same when the variables follow (fixed parameters; NaN for variables)
};

/// First-order optimality of a stage's best design.
struct OptimalityRecord {
  double optimality = 0;  ///< see optimality.hpp
  std::vector<ActiveRecord> active;
  std::vector<SensitivityRecord> sensitivities;  ///< all parameters, in the mechanism's order
};

/// A stage's trade-off, see Front; and what its indicators were after each generation (solvers: none).
struct FrontRecord {
  std::vector<std::int64_t> rows;                     ///< of the stage's table, the best by the first objective first
  std::vector<double> reference;                      ///< corner of the hypervolume; empty: none
  std::vector<double> hypervolume, spread, igd_plus;  ///< an entry per generation
};

/// "feasible", "infeasible", "rejected", "failed".
std::string words(Status status);

/// One optimiser's part of the study.
struct StageRecord {
  std::string optimiser;             ///< "ga"
  std::vector<std::string> options;  ///< "name = value", defaults included
  EvaluationTable table;             ///< every evaluation, in the order in which it was asked for
  GenerationRecords generations;
  bool finished = false;
  std::string stop;  ///< why it ended, in words; "" while it runs
  std::int64_t best_row = -1;
  std::vector<StartOutcome> starts;            ///< solvers: the starts that have ended and are in the table
  std::vector<StartAhead> ahead;               ///< solvers that are interrupted: what is known of other starts
  std::optional<OptimalityRecord> optimality;  ///< one objective, stages with derivatives, once finished
  std::optional<FrontRecord> front;            ///< several objectives

  bool has_front() const { return front && !front->rows.empty(); }
};

/// One design, evaluated with everything that the problem asks for.
struct DesignRecord {
  std::vector<double> parameters;  ///< all of ProblemRecord::parameters, SI
  std::vector<double> objectives;
  std::vector<double> margins;
  std::vector<double> reports;
  Status status = Status::failed;
  std::string reason;  ///< why it failed, or what else is wrong with it (rounded out of its bounds); "" otherwise
  double volume = 0;   ///< in FinalRecord::volume_unit
  std::int64_t cells = 0;
  std::int64_t feasible_cells = 0;
  double cell_volume = 0;
  bool touches_box = false;
  std::optional<VolumeBounds> certain = {};  ///< of the volume, where the study asks for them; then the two ends alone
};

/// The best design's voxels with the names of their axes.
struct MapRecord {
  VoxelMap voxels;
  std::vector<std::string> axes;   ///< three names, outermost first: "x", "z", "theta"
  std::vector<std::string> units;  ///< three: "m", "m", "rad"
};

/// What is worked out once a study has ended.
struct FinalRecord {
  std::optional<DesignRecord> best;
  std::optional<DesignRecord> rounded;  ///< best, rounded as `[final] round` asks and evaluated again
  std::optional<DesignRecord> baseline;
  /// Voxel studies: the same designs on exact columns, where the mechanism has them.
  std::optional<DesignRecord> best_exact, baseline_exact;
  std::optional<MapRecord> map;  ///< of `best`
  std::string volume_unit;
  std::vector<std::string> active;  ///< active bounds and constraints of `best`, one sentence each
};

/// Which evaluation is the best so far.
struct BestRow {
  std::int64_t stage = -1;  ///< 0 is the first stage; -1: nothing evaluated yet
  std::int64_t row = -1;
};

enum class StudyState { running, interrupted, finished };
/// "running", "interrupted", "finished".
std::string words(StudyState state);

struct StudyContents {
  // where it comes from
  std::string name;
  std::string toml;                       ///< the study's text
  std::string toml_file;                  ///< and the file it was read from
  std::optional<SourceText> description;  ///< the mechanism's, where the study's text names a file
  std::string text_digest;                ///< of both texts when the study was begun; "": before schema 5
  std::uint64_t seed = 1;
  std::string program_version;
  std::string program_revision;
  std::int64_t algorithms = 1;  ///< version of the optimisers' behaviour: a study goes on only under the same
  std::string machine;          ///< processor, cores, system
  std::string created;          ///< ISO 8601, UTC
  std::string updated;
  ProblemRecord problem;
  std::vector<Extension> extensions;
  // what happened
  StudyState state = StudyState::running;
  double seconds = 0;  ///< wall time spent, all runs together
  std::vector<StageRecord> stages;
  BestRow best;
  std::optional<FinalRecord> final;
  std::vector<std::string> notes;  ///< sentences on what happened to the study; not part of what must repeat

  /// What holds the best evaluation so far, and its variables; only where there is one.
  const StageRecord& best_stage() const { return stages[static_cast<std::size_t>(best.stage)]; }
  std::span<const double> best_design() const { return best_stage().table.design(static_cast<std::size_t>(best.row)); }
  /// Evaluations of all stages.
  std::int64_t evaluations() const;
  /// False where a start of a solver was ended by the clock: another run may end it elsewhere.
  bool reproducible() const;
};

}  // namespace pkm
