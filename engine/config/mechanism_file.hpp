// A mechanism described by a file: parameters, freedoms, limbs in closed form or formulas, limits, links.
#pragma once

#include <memory>
#include <string>

#include "engine/core/error.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A parameter that one limb has for itself, beside that of all: "arm2.l_b".
struct LimbParameter {
  std::string limb, parameter;
  SourceLocation place = {};  ///< where it is asked for

  std::string name() const { return limb + "." + parameter; }
};
/// Of names such as "arm2.l_b"; none for others.
std::optional<LimbParameter> limb_parameter(const std::string& name, const SourceLocation& place);

/// A mechanism from its description. `file_name` is named in messages. Throws ConfigError.
/// @param own  further parameters, of one limb each, behind the file's own; they have unit, range and default of that
///             of all
std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name,
                                                     const std::vector<LimbParameter>& own = {});

/// What was understood of a description, and what the mechanism can and cannot, with reasons: the text of
/// `pkmopt check FILE`.
std::string describe_mechanism(const Mechanism& mechanism);

}  // namespace pkm
