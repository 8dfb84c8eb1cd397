// The tables and keys of mechanism files: descriptions for the reader, the JSON Schema and the reference of keys.
#pragma once

#include <string>
#include <vector>

#include "engine/core/options.hpp"

namespace pkm {

/// All tables that a mechanism file may contain, as the keys of its top level.
const TableSpec& mechanism_keys();

/// The table [parameters] of a study.
const TableSpec& study_parameters_keys();
/// Keys of a [[quantity]] of a mechanism file or a study.
const TableSpec& quantity_keys();
/// Keys of the table [accuracy] of a mechanism file or a study.
const TableSpec& accuracy_keys();
/// Keys of the table of a parameter of a single limb, "arm2.l_b = { .. }".
const TableSpec& limb_parameter_keys();

/// Keys of a [[limb]].
const TableSpec& limb_keys();
/// Keys of a [[limb]] that give the mass of one of its parts, for example "rod_mass" if `part` is "rod".
std::vector<OptionSpec> mass_keys(const std::string& part);

}  // namespace pkm
