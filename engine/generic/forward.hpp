// Forward kinematics of a mechanism file: multistart Newton's method for the loop-closure equations of the limbs.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// assemblies_of() stops after kMaxIdleStarts consecutive starts of Newton's method without a new pose, or after
/// kMaxStarts starts in total.
inline constexpr std::size_t kMaxIdleStarts = 64, kMaxStarts = 1024;

/// Finds distinct rigid-body poses with the given joint positions. Newton's method starts from poses in the search box
/// of the file and from the mirror image of each pose found, once for each distinct set of loop-closure equations if
/// these depend on the working mode. The list may be incomplete.
std::vector<AssemblyMode> assemblies_of(const Evaluation& evaluation, std::span<const double> parameters,
                                        const AxisVector<double>& joints);

/// The poses to which Newton's method converges from one start pose: at most one for each distinct set of loop-closure
/// equations (they may depend on the working mode).
std::vector<AssemblyMode> assemblies_near(const Evaluation& evaluation, std::span<const double> parameters,
                                          const AxisVector<double>& joints, const Pose<double>& from);

}  // namespace pkm::generic
