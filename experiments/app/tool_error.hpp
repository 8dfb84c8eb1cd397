// First-order pose error of the tool caused by joint errors: x = J^-1 q.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Reports the largest first-order pose errors of the platform for joint errors within the given bounds +-q_i: of each
/// coordinate, of the position of the platform's origin and of the orientation. Throws ConfigError if the mechanism has
/// no influence coefficients or not as many joints as coordinates.
/// @param T      maps coordinate rates to the platform's twist (PoseReport::T); std::nullopt: unspecified
/// @param lists  of --joint-error: one bound for all joints, or bounds by name
void report_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                       const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists,
                       Printout& out);

}  // namespace pkm
