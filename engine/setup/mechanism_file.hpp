// A mechanism that a TOML file describes: its parameters, the platform's freedoms, limbs, limits, masses.
#pragma once

#include <memory>
#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// A mechanism from its description. `file_name` is named in messages. Throws ConfigError.
std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name);

/// What was understood of a description, and what the mechanism can and cannot, with reasons: the text of `pkmopt check
/// FILE`.
std::string describe_mechanism(const Mechanism& mechanism);

}  // namespace pkm
