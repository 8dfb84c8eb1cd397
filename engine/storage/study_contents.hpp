// Data model of a study file: the problem, every evaluation of every stage, and the final results, as plain structs.
// The runner fills them, a resumed run starts from them, reports and exports read them. engine/storage/README.md
// documents the layout in the file.
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
#include "engine/mechanism/workspace_result.hpp"
#include "engine/problem/front.hpp"
#include "engine/problem/start_outcome.hpp"

namespace pkm {

/// Version of the file layout. Files with a higher version are rejected with a message that names both versions.
inline constexpr int kStudySchema = 5;

/// One parameter of the study's mechanism, in the mechanism's order.
struct ParameterRecord {
  std::string name;
  std::string unit;
  double value = 0;            ///< fixed value (SI); for a variable parameter its nominal value
  std::int64_t variable = -1;  ///< index into ProblemRecord::variables; -1: not a variable
};

/// The optimisation problem in explicit form, so that other programs need not parse the TOML text.
struct ProblemRecord {
  std::string mechanism;  ///< "4ppa-2par"
  std::vector<ParameterRecord> parameters;
  std::vector<Variable> variables;
  std::vector<ObjectiveInfo> objectives;
  std::vector<MarginInfo> margins;
  std::vector<OutputInfo> reports;

  EvaluationShape shape(Detail detail = Detail::enough) const {
    return {variables.size(), objectives.size(), margins.size(), reports.size(), detail};
  }
};

/// A function of another program that the study calls. Its code is not stored.
struct FunctionRecord {
  std::string call;  ///< "cost.py:price"
  std::string hash;  ///< hash of the file that defines it, when the study was started; "": unknown
};

/// A stage limit that `pkmopt resume` has raised. It is stored separately because the TOML text is never changed, and a
/// resumed run has to apply it again.
struct Extension {
  std::int64_t stage = 0;  ///< 0 is the first stage
  std::string limit;       ///< "generations", "evaluations" or "time"
  double value = 0;        ///< new limit (total); time in s
};

/// One entry per complete generation. All arrays have size() elements, except `population`.
struct GenerationRecords {
  std::vector<std::int64_t> first_row;         ///< the generation's first row in the evaluation table
  std::vector<std::int64_t> best_row;          ///< row of the best evaluation so far; -1: none
  std::vector<double> feasible_share;          ///< feasible share of the population, in [0, 1]
  std::vector<double> diversity;               ///< diversity of the population, see record_generation()
  std::vector<double> seconds;                 ///< wall time of the study at the end of the generation
  std::vector<std::int64_t> population_first;  ///< index in `population` of the generation's first member
  std::vector<std::int64_t> population;        ///< table rows of the members, one generation after the other

  std::size_t size() const { return first_row.size(); }
  /// Table rows of the members of generation g's population.
  std::span<const std::int64_t> population_of(std::size_t g) const;
  /// One past the last row that generation g evaluated, in a table of `rows` rows.
  std::size_t end_of(std::size_t g, std::size_t rows) const {
    return g + 1 < size() ? static_cast<std::size_t>(first_row[g + 1]) : rows;
  }
  /// @return for each row of a table of `rows` rows, the generation that evaluated it
  std::vector<std::int64_t> generation_of_rows(std::size_t rows) const;
};

/// An active bound or constraint with its Lagrange multiplier.
struct ActiveRecord {
  std::string name;
  std::string kind;       ///< "lower bound", "upper bound" or "constraint"
  double multiplier = 0;  ///< improvement of the objective per unit by which the bound or constraint is relaxed
  std::string unit;       ///< unit of the bound or constraint
};

/// Sensitivity of the objective with respect to one parameter.
struct SensitivityRecord {
  std::string parameter;
  std::string unit;
  double as_built = 0;     ///< d objective / d parameter with all other parameters unchanged
  double reoptimised = 0;  ///< d objective / d parameter with the variables re-optimised; NaN if it is a variable
};

/// First-order optimality (KKT conditions) of a stage's best design.
struct OptimalityRecord {
  double optimality = 0;  ///< relative KKT residual, see engine/optimisers/solvers/optimality.hpp
  std::vector<ActiveRecord> active;
  std::vector<SensitivityRecord> sensitivities;  ///< all parameters, in the mechanism's order
};

/// The Pareto front of a stage (see Front) and its quality indicators after each generation.
struct FrontRecord {
  std::vector<std::int64_t> rows;  ///< rows of the stage's table, from best to worst in the first objective
  std::vector<double> reference;   ///< reference point of the hypervolume; empty: none
  std::vector<double> hypervolume, spread, igd_plus;  ///< one entry per generation; empty for solver stages
};

/// "feasible", "infeasible", "rejected", "failed".
std::string words(Status status);

/// One stage of the study: an optimiser, its options and all its evaluations.
struct StageRecord {
  std::string optimiser;             ///< "ga"
  std::vector<std::string> options;  ///< "name = value", defaults included
  EvaluationTable table;             ///< every evaluation, in the order of the optimiser's requests
  GenerationRecords generations;
  bool finished = false;
  std::string stop;                            ///< reason for the end of the stage, as text; "" while it runs
  std::int64_t best_row = -1;                  ///< -1: none
  std::vector<StartOutcome> starts;            ///< solvers: finished multistart runs whose evaluations are in `table`
  std::vector<UnmergedRun> ahead;              ///< interrupted solvers: runs whose evaluations are not yet in `table`
  std::optional<OptimalityRecord> optimality;  ///< finished stages with derivatives and a single objective
  std::optional<FrontRecord> front;            ///< several objectives only

  bool has_front() const { return front && !front->rows.empty(); }
};

/// One design with all its parameters, objectives, margins and outputs.
struct DesignRecord {
  std::vector<double> parameters;  ///< all of ProblemRecord::parameters, SI
  std::vector<double> objectives;
  std::vector<double> margins;
  std::vector<double> reports;
  Status status = Status::failed;
  std::string reason;  ///< why the evaluation failed, or a remark (rounded values outside their bounds); "": neither
  double volume = 0;   ///< in FinalRecord::volume_unit
  std::int64_t cells = 0;
  std::int64_t feasible_cells = 0;
  double cell_volume = 0;
  bool touches_box = false;
  std::optional<VolumeBounds> certified = {};  ///< certified bounds of the volume, if requested; only lower and upper
};

/// The voxel map of the best design's workspace, with names and units of its axes.
struct MapRecord {
  VoxelMap voxels;
  std::vector<std::string> axes;   ///< three names, outermost first: "x", "z", "theta"
  std::vector<std::string> units;  ///< three: "m", "m", "rad"
};

/// The results that are computed after the last stage.
struct FinalRecord {
  std::optional<DesignRecord> best;
  std::optional<DesignRecord> rounded;  ///< `best`, rounded to multiples of `[final] round` and evaluated again
  std::optional<DesignRecord> baseline;
  /// Voxel studies: the same designs evaluated by the exact method (columns), if the mechanism supports it.
  std::optional<DesignRecord> best_exact, baseline_exact;
  std::optional<MapRecord> map;  ///< voxel map of `best`
  std::string volume_unit;
  std::vector<std::string> active;  ///< active bounds and constraints of `best`, one sentence each
};

/// Location of the best evaluation so far.
struct BestRow {
  std::int64_t stage = -1;  ///< 0 is the first stage; -1: nothing evaluated yet
  std::int64_t row = -1;
};

enum class StudyState { running, interrupted, finished };
/// "running", "interrupted", "finished".
std::string words(StudyState state);

struct StudyContents {
  // provenance
  std::string name;
  std::string toml;                       ///< text of the study
  std::string toml_file;                  ///< file from which the text was read
  std::optional<SourceText> description;  ///< the mechanism file, if the study names one
  std::string text_digest;  ///< hash of both texts, computed when the study was started; "" before schema 5
  std::optional<std::vector<FunctionRecord>> functions;  ///< empty: the study calls none
  std::uint64_t seed = 1;
  std::string program_version;
  std::string program_revision;
  std::int64_t algorithms = 1;  ///< see kAlgorithms: a study can be resumed only with the same version
  std::string machine;          ///< processor, number of cores, instruction set, operating system
  std::string created;          ///< ISO 8601, UTC
  std::string updated;          ///< ISO 8601, UTC
  ProblemRecord problem;
  std::vector<Extension> extensions;
  // results
  StudyState state = StudyState::running;
  double seconds = 0;  ///< wall time of all runs of this study together
  std::vector<StageRecord> stages;
  BestRow best;
  std::optional<FinalRecord> final;
  std::vector<std::string> notes;  ///< remarks on the course of the study, one sentence each; may differ between runs

  /// The stage of the best evaluation, and the values of its variables. Precondition: best.row >= 0.
  const StageRecord& best_stage() const { return stages[static_cast<std::size_t>(best.stage)]; }
  std::span<const double> best_design() const { return best_stage().table.design(static_cast<std::size_t>(best.row)); }
  /// Number of evaluations in all stages.
  std::int64_t evaluations() const;
  /// @return false if a time limit ended a multistart run of a solver: another run may end it at another evaluation
  bool reproducible() const;
};

}  // namespace pkm
