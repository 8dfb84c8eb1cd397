// The study that `pkmopt new study` writes.
#pragma once

#include <string>

#include "engine/config/study.hpp"

namespace pkm {

/// Text of a commented study that maximises the workspace of a mechanism: by exact columns with a gradient solver if an
/// evaluation of the default design is quick, otherwise by voxels; with the defaults as baseline, and an example of
/// each kind of constraint that the mechanism supports, as comments. The text has been read back, and the default
/// design has been evaluated. Throws ConfigError if that fails, for example because the mechanism has no search box.
/// @param mechanism  name of a built-in mechanism, or a mechanism file
/// @param output     the file to which the text will be written, or "" for the current folder; the path of a mechanism
/// file is relative to it
std::string starter_study(const Catalogues& catalogues, const std::string& mechanism, const std::string& output);

}  // namespace pkm
