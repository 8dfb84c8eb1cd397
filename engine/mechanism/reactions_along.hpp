// What the joints of a mechanism carry along a motion: what bearings are chosen by.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/trajectory.hpp"

namespace pkm {

/// Fills in the reactions of every sample.
/// @param mechanism  has reactions()
/// @param wrench     that the trajectory was followed under
void add_reactions(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                   const Wrench<double>& wrench, Trajectory& trajectory);

/// The size of a joint's force, or of its couple, over the samples. It is made of the components that are determined
/// at every sample; 0 where it is rounding beside the other of the two.
struct CarriedLoad {
  std::array<bool, 3> determined = {true, true, true};  ///< along x, y, z
  double peak = 0, rms = 0;                             ///< greatest, and root of the mean square [N, N m]
  std::size_t at = 0;                                   ///< the first sample of the greatest, to rounding
};

struct CarryingJoint {
  std::string name, on;  ///< as JointReaction has them
  CarriedLoad force, couple;
};

/// Of samples that all have reactions; every joint that these name.
std::vector<CarryingJoint> carried_along(const Trajectory& trajectory);

}  // namespace pkm
