// JSON Schemas (draft-07) of the TOML files that pkmopt reads, for completion, descriptions and checks in editors, such
// as Even Better TOML (Taplo). They are generated from the descriptions by which the files are read.
#pragma once

#include <string>

#include "engine/config/study.hpp"

namespace pkm {

/// Schema of studies, with the names and options of all entries of the catalogues. Names that a mechanism file defines
/// (coordinates, parameters, limits, constraints of the design) are not checked.
std::string study_schema(const Catalogues& catalogues);
std::string task_schema(const Catalogues& catalogues);
std::string mechanism_schema();
std::string motion_schema();
std::string motor_schema();

}  // namespace pkm
