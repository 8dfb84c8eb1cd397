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

/// One parameter of the mechanism of a study. Parameters are in the order that the mechanism defines.
struct ParameterRecord {
  std::string name;
  std::string unit;
  double value = 0;            ///< value if the parameter is fixed, in SI; for a design variable, its nominal value
  std::int64_t variable = -1;  ///< index of the design variable in ProblemRecord::variables; -1: the parameter is fixed
};

/// The name of a value of a variable that is a choice from a catalogue. The values are 1, 2, .. in the order of the
/// names.
struct ChoiceName {
  std::int64_t variable = 0;  ///< index of the variable in ProblemRecord::variables
  std::string name;
};

/// The optimisation problem in explicit form, so that other programs need not parse the TOML text.
struct ProblemRecord {
  std::string mechanism;  ///< name of the mechanism, for example "4ppa-2par"
  std::vector<ParameterRecord> parameters;
  std::vector<Variable> variables;
  /// Names of the values of those variables that are choices from catalogues; std::nullopt: there are none.
  std::optional<std::vector<ChoiceName>> choices;
  std::vector<ObjectiveInfo> objectives;
  std::vector<MarginInfo> margins;
  std::vector<OutputInfo> reports;

  EvaluationShape shape(Detail detail = Detail::enough) const {
    return {variables.size(), objectives.size(), margins.size(), reports.size(), detail};
  }
};

/// A function of another program that the study calls. Its code is not stored.
struct FunctionRecord {
  std::string call;  ///< name of the function in the study, for example "cost.py:price"
  std::string hash;  ///< hash of the file that defines the function, at the start of the study; "": unknown
};

/// A stage limit that `pkmopt resume` has raised. It is stored separately because the TOML text is never changed, and a
/// resumed run has to apply it again.
struct Extension {
  std::int64_t stage = 0;  ///< index of the stage, from 0
  std::string limit;       ///< "generations", "evaluations" or "time"
  double value = 0;        ///< new limit, counted from the beginning of the stage; times in s
};

/// Records of the complete generations of a stage. Each array has one element per generation, except `population`.
struct GenerationRecords {
  std::vector<std::int64_t> first_row;  ///< first row of the generation in the evaluation table
  std::vector<std::int64_t> best_row;   ///< row of the best evaluation up to this generation; -1: none
  std::vector<double> feasible_share;   ///< feasible share of the population, in [0, 1]
  /// Diversity of the population: mean over the variables of the standard deviation relative to the variable's range.
  std::vector<double> diversity;
  std::vector<double> seconds;  ///< wall time of the study at the end of the generation
  /// Index in `population` of the first member of the generation's population.
  std::vector<std::int64_t> population_first;
  /// Rows of the members of all populations in the evaluation table of the stage, one generation after the other.
  std::vector<std::int64_t> population;

  std::size_t size() const { return first_row.size(); }
  /// Rows, in the evaluation table of the stage, of the members of generation g's population.
  std::span<const std::int64_t> population_of(std::size_t g) const;
  /// End of the range of rows that generation g has evaluated, in an evaluation table of `rows` rows.
  std::size_t end_of(std::size_t g, std::size_t rows) const {
    return g + 1 < size() ? static_cast<std::size_t>(first_row[g + 1]) : rows;
  }
  /// @return for each row of an evaluation table of `rows` rows, the generation that evaluated it
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
  /// Derivative of the objective with respect to the parameter, with all other parameters unchanged.
  double as_built = 0;
  /// Derivative with respect to the parameter if the variables are optimised again; NaN for a parameter that is a
  /// variable.
  double reoptimised = 0;
};

/// First-order optimality (KKT conditions) of a stage's best design.
struct OptimalityRecord {
  double optimality = 0;  ///< KKT residual relative to the objective, defined in
                          ///< engine/optimisers/solvers/optimality.hpp
  std::vector<ActiveRecord> active;
  std::vector<SensitivityRecord> sensitivities;  ///< one element per parameter, in the order of the mechanism
};

/// The Pareto front of a stage, i.e. its feasible non-dominated designs, and its quality indicators after each
/// generation.
struct FrontRecord {
  /// Rows in the evaluation table of the stage, from the best to the worst value of the first objective.
  std::vector<std::int64_t> rows;
  std::vector<double> reference;                      ///< reference point of the hypervolume; empty: none
  std::vector<double> hypervolume, spread, igd_plus;  ///< one value per generation; empty for solver stages
};

/// Word for a status: "feasible", "infeasible", "rejected" or "failed".
std::string words(Status status);

/// One stage of the study: an optimiser, its options and all its evaluations.
struct StageRecord {
  std::string optimiser;             ///< name of the optimiser, for example "ga"
  std::vector<std::string> options;  ///< one text "name = value" per option, including default values
  EvaluationTable table;             ///< every evaluation, in the order of the optimiser's requests
  GenerationRecords generations;
  bool finished = false;
  std::string stop;            ///< reason why the stage has ended, as text; "" while it runs
  std::int64_t best_row = -1;  ///< row of the stage's best evaluation; -1: none
  /// Solver stages: outcomes of the finished multistart runs whose evaluations are in `table`.
  std::vector<StartOutcome> starts;
  std::vector<UnmergedRun> ahead;  ///< interrupted solver stages: runs whose evaluations are not yet in `table`
  std::optional<OptimalityRecord> optimality;  ///< set for finished stages with derivatives and a single objective
  std::optional<FrontRecord> front;            ///< Pareto front; set for several objectives only

  bool has_front() const { return front && !front->rows.empty(); }
};

/// One design with all its parameters, objectives, margins and outputs.
struct DesignRecord {
  std::vector<double> parameters;  ///< values of all of ProblemRecord::parameters, in SI
  std::vector<double> objectives;
  std::vector<double> margins;
  std::vector<double> reports;
  Status status = Status::failed;
  /// Reason why the evaluation failed, or a remark (rounded values outside of their bounds); "": neither.
  std::string reason;
  double volume = 0;  ///< workspace volume, in the unit FinalRecord::volume_unit
  std::int64_t cells = 0;
  std::int64_t feasible_cells = 0;
  double cell_volume = 0;
  bool touches_box = false;
  /// Certified bounds of the volume; only `lower` and `upper` are set. std::nullopt: not requested.
  std::optional<VolumeBounds> certified = {};
};

/// The voxel map of the best design's workspace, with names and units of its axes.
struct MapRecord {
  VoxelMap voxels;
  std::vector<std::string> axes;   ///< names of three axes, the one that varies slowest first: "x", "z", "theta"
  std::vector<std::string> units;  ///< units of the three axes, for example "m", "m", "rad"
};

/// The results that are computed after the last stage.
struct FinalRecord {
  std::optional<DesignRecord> best;
  std::optional<DesignRecord> rounded;  ///< `best`, rounded to multiples of `[final] round` and evaluated again
  std::optional<DesignRecord> baseline;
  /// For voxel studies, if the mechanism supports it: the best design and the baseline, evaluated by the exact method
  /// (columns).
  std::optional<DesignRecord> best_exact, baseline_exact;
  std::optional<MapRecord> map;  ///< voxel map of the workspace of `best`
  std::string volume_unit;
  std::vector<std::string> active;  ///< active bounds and constraints of `best`, one sentence each
};

/// Where the best evaluation so far is recorded.
struct BestRow {
  std::int64_t stage = -1;  ///< index of the stage, from 0; -1: nothing has been evaluated yet
  std::int64_t row = -1;
};

enum class StudyState { running, interrupted, finished };
/// Word for a state: "running", "interrupted" or "finished".
std::string words(StudyState state);

struct StudyContents {
  // Provenance of the study:
  std::string name;
  std::string toml;       ///< text of the study
  std::string toml_file;  ///< name of the file from which the text was read
  /// Text of the mechanism file, if the study names one; otherwise std::nullopt.
  std::optional<SourceText> description;
  /// Hash of the texts of study and mechanism file at the start of the study; "" in files with a schema version below
  /// 5.
  std::string text_digest;
  /// The Python functions that the study calls; std::nullopt: none.
  std::optional<std::vector<FunctionRecord>> functions;
  std::uint64_t seed = 1;
  std::string program_version;
  std::string program_revision;
  /// Version of the numerical behaviour of optimisers and workspace analyses (kAlgorithms); only a program of the same
  /// version can resume the study.
  std::int64_t algorithms = 1;
  std::string machine;  ///< processor, number of cores, instruction set, operating system
  std::string created;  ///< time at which the study was started, ISO 8601 in UTC
  std::string updated;  ///< time of the last write, ISO 8601 in UTC
  ProblemRecord problem;
  std::vector<Extension> extensions;
  // Results of the study:
  StudyState state = StudyState::running;
  double seconds = 0;  ///< wall time of all runs of this study together
  std::vector<StageRecord> stages;
  BestRow best;
  std::optional<FinalRecord> final;
  std::vector<std::string> notes;  ///< remarks on the course of the study, one sentence each; may differ between runs

  /// The stage that contains the best evaluation. Precondition: best.row >= 0.
  const StageRecord& best_stage() const { return stages[static_cast<std::size_t>(best.stage)]; }
  std::span<const double> best_design() const { return best_stage().table.design(static_cast<std::size_t>(best.row)); }
  /// Number of evaluations in all stages.
  std::int64_t evaluations() const;
  /// @return false if a time limit ended a multistart run of a solver, because another run may end it at another
  /// evaluation
  bool reproducible() const;
};

}  // namespace pkm
