// Compliance, stiffness and natural frequencies of the platform at a pose.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Reports the compliance matrix of the platform, its smallest stiffnesses and the natural frequencies, and the
/// deflection under a wrench. Throws ConfigError if the mechanism has no elasticity.
/// @param report  result of the inverse kinematics at this pose
/// @param wrench  values of --wrench: forces and moments at the origin of the platform's frame; empty: no deflection
void report_stiffness(const Target& target, const std::string& mode, const Pose<double>& pose, const PoseReport& report,
                      const std::vector<std::string>& wrench, Printout& out);

}  // namespace pkm
