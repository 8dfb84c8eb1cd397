// A study: the design problem and the chain of optimisers that a TOML file describes.
//
// Reading is strict: an unknown key, a value out of range, a threshold that is set twice or an optimiser that does not
// support the problem is a ConfigError before anything runs. The same reader serves a file on disk and the text
// that a stored study carries, so a resumed study is built exactly like a new one. experiments/ holds examples.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/config/study_changes.hpp"
#include "engine/core/source_text.hpp"
#include "engine/mechanism/mechanism_list.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "engine/problem/design_problem.hpp"

namespace pkm {

struct TomlValue;

/// The catalogues that define the names of mechanisms, objectives, constraints and optimisers that a study may use.
struct Catalogues {
  MechanismList mechanisms;
  std::vector<ObjectiveEntry> objectives;
  std::vector<ConstraintEntry> constraints;
  std::vector<OptimiserEntry> optimisers;
};

struct Stage {
  std::shared_ptr<const OptimiserEntry> entry;
  Options options;  ///< values of the stage's options, with all default values, also those that depend on the variables
  std::shared_ptr<const Optimiser> optimiser;
  int line = 0;                   ///< line of the table [[stage]] in the study's TOML file
  std::vector<OptionSpec> specs;  ///< options of the optimiser, with the units and defaults of this study
};

/// An [[objective]], [[constraint]] or [[output]] with its defaults, for listings.
struct StudyEntry {
  std::string type;
  std::string name;
  std::string role;  ///< how the entry is used, as text: "maximise, in m^2 rad", ">= 0.5 m^2 rad", "cuts the workspace"
  std::vector<OptionSpec> specs;
  Options options;
};

/// A published result to compare with: [[reference]].
struct Reference {
  std::string name;
  /// Published value of each variable; std::nullopt where the source gives none.
  std::vector<std::optional<double>> design;
  std::vector<std::pair<std::string, double>> values;  ///< published values of objectives and outputs, by name
  std::optional<double> seconds;                       ///< published computing time [s]
};

struct Study {
  std::string text;                       ///< the TOML document, with the changes by the command line
  std::string file_name;                  ///< name that the TOML file had when it was read
  std::vector<std::string> changes;       ///< changes by the command line, as arguments: "--set", "L0=2"
  std::optional<SourceText> description;  ///< the mechanism file, if [mechanism] names one
  std::vector<std::string> catalogues;    ///< files of the catalogues that [variables] name
  std::string name;                       ///< name of the study; by default the name of its file without extension
  std::uint64_t seed = 1;
  std::optional<std::string> output;
  /// The design problem. Its parts() contain the mechanism, the parameters, the variables and the plan of the workspace
  /// analysis.
  std::shared_ptr<const DesignProblem> problem;
  std::optional<std::vector<double>> baseline;  ///< values of all parameters of the mechanism
  std::vector<StartDesign> starts;              ///< designs of another study for the first stage, best first
  std::vector<Stage> stages;                    ///< if empty, the study can be evaluated, but not run
  std::optional<double> round;                  ///< [final]: step [SI] to which the best design is rounded
  std::string round_unit = "1";                 ///< the unit that all variables share; "1" if their units differ
  /// Time limit [s] for computing the exact values of the best design and the baseline (key `exact` of [workspace]); 0:
  /// they are not computed.
  double exact_seconds = 10;
  std::optional<double> checkpoint_every;  ///< interval between checkpoints [s]; std::nullopt: adaptive
  std::vector<std::string> warnings;       ///< sentences for the user about problems that do not prevent a run
  /// Differences between the values recorded in a study file and those in its text.
  std::vector<std::string> differences;

  std::vector<Reference> references;
  std::vector<DesignMotion> motions;            ///< motions of the study, from the tables [[motion]]
  std::vector<std::string> unfollowed_motions;  ///< names of the motions with follow = false

  std::optional<ToleranceModel> tolerances;  ///< manufacturing tolerances, from the table [tolerance]
  /// The problem of a built machine, whose limbs have separate errors; it has no robust quantities and yields. Null if
  /// the study has no [tolerance].
  std::shared_ptr<const DesignProblem> machine;

  std::vector<StudyEntry> objectives, constraints, outputs;
  std::vector<std::string> limit_origins;  ///< for each limit of the mechanism, where its threshold is set; "": nowhere

  /// Name of the study file: the key `output`; by default the name of the study's TOML file with the extension ".h5",
  /// in the current folder.
  std::string output_file() const;
};

/// Whether a study gets the constraints that its motions imply. Study files written by earlier versions do not have
/// them.
enum class ImpliedConstraints { added, left_out };

/// Builds a study from a TOML document. `file_name` is named in messages. Opens no file: if [mechanism] names one,
/// `description` is its text. Throws ConfigError.
Study read_study_toml(const std::string& text, const std::string& file_name, const Catalogues& catalogues,
                      const std::optional<SourceText>& description = {}, const StudyChanges& changes = {},
                      ImpliedConstraints implied = ImpliedConstraints::added);

/// Builds a study from a document that was composed from others. `file_name` is named in messages. Throws ConfigError.
Study read_study_document(const TomlValue& document, const std::string& file_name, const Catalogues& catalogues,
                          const std::optional<SourceText>& description, const StudyChanges& changes);

/// Reads the file at `path`, and the mechanism file that it may name, and builds the study. Throws ConfigError, also
/// when a file cannot be read.
Study load_study_toml(const std::string& path, const Catalogues& catalogues, const StudyChanges& changes = {});

/// Reads the options of one optimiser, i.e. the lines of a [[stage]] without its header, for a problem that does not
/// come from a study. Throws ConfigError. `file_name` is named in messages.
Stage read_stage_toml(const std::string& lines, const std::string& file_name,
                      const std::vector<OptimiserEntry>& optimisers, const Problem& problem);

/// Throws ConfigError if a study has no stages, so that it cannot be run.
void require_stages(const Study& study, const Catalogues& catalogues);

/// Whether a document is a mechanism file, which has a `name` in [mechanism] or a table [platform].
bool describes_mechanism(const TomlValue& document);

/// The content of a file: a mechanism or a study.
using MechanismOrStudy = std::variant<std::shared_ptr<const Mechanism>, Study>;
/// Reads a mechanism file or a study at `path`. Throws ConfigError.
/// @param changes  changes that are applied if the file is a study
MechanismOrStudy load_mechanism_or_study(const std::string& path, const Catalogues& catalogues,
                                         const StudyChanges& changes = {});

/// The resolved problem with every default spelled out: the text of `pkmopt check`.
std::string describe(const Study& study);

}  // namespace pkm
