// A mechanism described by a file: parameters, freedoms, limbs in closed form or formulas, limits, links.
#pragma once

#include <memory>
#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A mechanism from its description. `file_name` is named in messages. Throws ConfigError.
std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name);

/// What was understood of a description, and what the mechanism can and cannot, with reasons: the text of
/// `pkmopt check FILE`.
std::string describe_mechanism(const Mechanism& mechanism);

}  // namespace pkm
