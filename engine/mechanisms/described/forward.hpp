// Forward kinematics of a description: poses for joint values, by Newton's method on the closures of its limbs.
#pragma once

#include "engine/mechanisms/described/evaluation.hpp"
#include "engine/model/pose.hpp"

namespace pkm::described {

/// From some 64 poses of the description's box for each working mode that has formulas of its own, each assembly once:
/// those that are found need not be all.
std::vector<AssemblyMode> assemblies_of(const Evaluation& evaluation, std::span<const double> parameters,
                                        const AxisVector<double>& joints);

/// What the method ends in from one pose, in each such mode.
std::vector<AssemblyMode> assemblies_near(const Evaluation& evaluation, std::span<const double> parameters,
                                          const AxisVector<double>& joints, const Pose<double>& from);

}  // namespace pkm::described
