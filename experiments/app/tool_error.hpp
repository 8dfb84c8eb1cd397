// Pose error of the tool caused by joint errors: to first order, x = J^-1 q (for redundant drives by least squares),
// and exactly at the worst vertex of the box of joint errors.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Reports the largest first-order pose errors of the platform for joint errors within the bounds +-q_i: of each
/// coordinate, of the position of the platform's origin and of the orientation. If there are more joints than
/// coordinates, the pose is the one that fits all joint values best. Throws ConfigError if the mechanism has no
/// influence coefficients, or fewer joints than coordinates.
/// @param T      maps coordinate rates to the platform's twist (PoseReport::T); std::nullopt: unspecified
/// @param lists  values of --joint-error: one bound for all joints, or bounds by name
/// @param exact  also computes the poses at all corners of the box of joint errors, by Newton's method from the
///               first-order poses, and reports the largest errors among them
void report_tool_error(const Target& target, const std::string& mode, const MotionSample& at,
                       const std::optional<AxisMatrix<double>>& T, const std::vector<std::string>& lists, bool exact,
                       Printout& out);

}  // namespace pkm
