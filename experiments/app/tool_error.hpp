// What errors of the joints do to the tool.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Tells what errors of the joints within +- theirs do to the platform, to first order: the worst that each coordinate
/// can have, and the longest translation, which is at a corner of the box of errors.
/// @param lists  of --joint-error: one error of all joints, or some by name
void tell_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                     const std::vector<std::string>& lists, Printout& out);

}  // namespace pkm
