// A study: the design problem and the chain of optimisers that a TOML file describes.
//
// Reading is strict. A key nobody knows, a value out of range, a threshold named twice or an optimiser that is asked
// for more than it can do is a ConfigError before anything runs. The same reader serves a file on disk and the text
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

/// What a study may name.
struct Catalogues {
  MechanismList mechanisms;
  std::vector<ObjectiveEntry> objectives;
  std::vector<ConstraintEntry> constraints;
  std::vector<OptimiserEntry> optimisers;
};

struct Stage {
  std::shared_ptr<const OptimiserEntry> entry;
  Options options;  ///< defaults filled in, also those that depend on the variables
  std::shared_ptr<const Optimiser> optimiser;
  int line = 0;                   ///< of its [[stage]]
  std::vector<OptionSpec> specs;  ///< the entry's, completed for this study: units, and defaults as in `options`
};

/// An [[objective]], [[constraint]] or [[report]] as it was understood, for listings.
struct StudyEntry {
  std::string type;
  std::string name;
  std::string role;  ///< "maximise, in m^2 rad", ">= 0.5 m^2 rad", "cuts the workspace"
  std::vector<OptionSpec> specs;
  Options options;
};

/// A published result to compare with: [[reference]].
struct Reference {
  std::string name;
  std::vector<std::optional<double>> design;           ///< per variable; empty where the source gives no design
  std::vector<std::pair<std::string, double>> values;  ///< objectives and reports by name
  std::optional<double> seconds;                       ///< computing time
};

struct Study {
  std::string text;                       ///< the TOML document, with what the command line changes
  std::string file_name;                  ///< as it was called when it was read
  std::vector<std::string> changes;       ///< "--set", "L0=2": what the command line changed, as it is in the text
  std::optional<SourceText> description;  ///< the mechanism's, where [mechanism] names a file
  std::string name;                       ///< default: the file's stem
  std::uint64_t seed = 1;
  std::optional<std::string> output;
  /// Mechanism, parameters, variables and survey plan are in problem->parts().
  std::shared_ptr<const DesignProblem> problem;
  std::optional<std::vector<double>> baseline;  ///< every parameter of the mechanism
  std::vector<Stage> stages;
  std::optional<double> round;   ///< [final]: step [SI] to which the best design is rounded
  std::string round_unit = "1";  ///< the unit that all variables share, else "1"
  double exact_seconds = 10;     ///< [workspace] exact: what exact values may take in the end; 0: there are none
  std::optional<double> checkpoint_every;  ///< [s]; none: adapts itself
  std::vector<std::string> warnings;       ///< sentences for the user; nothing that stops a run
  std::vector<std::string> differences;    ///< of a study file: where its records differ from what its text gives

  std::vector<Reference> references;
  std::vector<NamedMotion> motions;             ///< [[motion]]: what objectives refer to by name
  std::vector<std::string> unfollowed_motions;  ///< those with follow = false

  std::vector<StudyEntry> objectives, constraints, reports;
  std::vector<std::string> limit_origins;  ///< per limit of the mechanism: where it was set; "" when it was not

  /// `output`, else the study file's stem + ".h5" in the current folder.
  std::string output_file() const;
};

/// Whether a study gets the constraints that follow from its motions. Those that earlier programs stored have none.
enum class ImpliedConstraints { added, left_out };

/// Builds a study from a TOML document. `file_name` is named in messages. Opens no file: where [mechanism] names one,
/// `description` is what was in it. Throws ConfigError.
Study read_study_toml(const std::string& text, const std::string& file_name, const Catalogues& catalogues,
                      const std::optional<SourceText>& description = {}, const StudyChanges& changes = {},
                      ImpliedConstraints implied = ImpliedConstraints::added);

/// Reads the file at `path`, and the mechanism's that it may name, and builds its study. Throws ConfigError, also when
/// a file cannot be read.
Study load_study_toml(const std::string& path, const Catalogues& catalogues, const StudyChanges& changes = {});

/// What a file holds that may be a study or the description of a mechanism.
using MechanismOrStudy = std::variant<std::shared_ptr<const Mechanism>, Study>;
/// Reads the file at `path`, once. Throws ConfigError.
/// @param changes  of a study; a mechanism has none
MechanismOrStudy load_mechanism_or_study(const std::string& path, const Catalogues& catalogues,
                                         const StudyChanges& changes = {});

/// The resolved problem with every default spelled out: the text of `pkmopt check`.
std::string describe(const Study& study);

}  // namespace pkm
