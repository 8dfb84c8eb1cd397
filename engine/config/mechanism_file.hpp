// Reads mechanism files: parameters, degrees of freedom, limbs in closed form or as formulas, limits, links, masses.
//
// Reading TOML and building a mechanism are separate: the reader fills a generic::Model (engine/generic/model.hpp),
// from which generic::make_mechanism() makes the mechanism. Code that builds a model itself does not need TOML; the
// classes in engine/generic/limbs add limbs in closed form to a model.
#pragma once

#include <memory>
#include <string>

#include "engine/core/error.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

class ConfigValue;

/// Name of a parameter that belongs to a single limb and replaces the one that all limbs share, for example "arm2.l_b".
struct LimbParameter {
  std::string limb, parameter;
  SourceLocation place = {};  ///< position of the name in the input file, for messages
  bool may_be_idle = false;   ///< true: the name is accepted even if no formula depends on the parameter

  std::string name() const { return limb + "." + parameter; }
};
/// Splits a name such as "arm2.l_b" into limb and parameter; std::nullopt for names without a dot.
std::optional<LimbParameter> limb_parameter(const std::string& name, const SourceLocation& place);

/// The document of a study whose quantities, limits of quantities, errors and drives are added to its mechanism; null:
/// nothing is added.
using StudyAdditions = std::shared_ptr<const ConfigValue>;

/// Reads a mechanism from the text of its file. `file_name` is named in messages. Throws ConfigError.
/// @param own  further parameters of single limbs, appended to those of the file; their unit, range and default are
///             those of the parameter that all limbs share
std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name,
                                                     const std::vector<LimbParameter>& own = {},
                                                     const StudyAdditions& study = nullptr);

/// The parameters of single limbs that could replace the parameters `common`: one for each limb whose joints or limits
/// depend on the parameter, also those that exist already. Throws ConfigError.
/// @param own  further parameters of single limbs, appended to those of the file
std::vector<LimbParameter> limb_copies(const std::string& text, const std::string& file_name,
                                       const std::vector<std::string>& common, const std::vector<LimbParameter>& own);

/// Text of `pkmopt check FILE`: how the mechanism file was interpreted, which analyses the mechanism supports, and why
/// it does not support others.
std::string describe_mechanism(const Mechanism& mechanism);

}  // namespace pkm
