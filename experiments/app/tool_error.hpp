// What errors of the joints do to the tool.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Tells what errors of the joints within +- theirs do to the platform, to first order: the worst that each coordinate
/// can have, the longest translation of the platform's origin and its largest rotation, which are at corners of the box
/// of errors.
/// @param T      of the pose (PoseReport)
/// @param lists  of --joint-error: one error of all joints, or some by name
void tell_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                     const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists, Printout& out);

}  // namespace pkm
