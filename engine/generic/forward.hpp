// Forward kinematics of a description: poses for joint values, by Newton's method on the closures of its limbs.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// A search of assemblies_of() ends after so many starts in a row that lead to no new pose, or after kMostStarts.
inline constexpr std::size_t kIdleStarts = 64, kMostStarts = 1024;

/// Distinct rigid-body poses, from starts over the description's box for each working mode that has formulas of its
/// own, and from the mirror image of each pose found. Those that are found need not be all.
std::vector<AssemblyMode> assemblies_of(const Evaluation& evaluation, std::span<const double> parameters,
                                        const AxisVector<double>& joints);

/// What the method ends in from one pose, in each such mode.
std::vector<AssemblyMode> assemblies_near(const Evaluation& evaluation, std::span<const double> parameters,
                                          const AxisVector<double>& joints, const Pose<double>& from);

}  // namespace pkm::generic
