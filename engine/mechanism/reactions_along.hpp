// Joint reactions along a trajectory, and their peak and RMS values, by which bearings are selected.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/trajectory.hpp"

namespace pkm {

/// Computes the reactions in all joints at every sample, and stores them in the trajectory.
/// @param mechanism  its reactions() must not be null
/// @param wrench     the load on the platform for which the trajectory was computed [N, N m]
void add_reactions(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                   const Wrench<double>& wrench, Trajectory& trajectory);

/// Magnitude of a joint's force or couple over the samples, computed from the components that are determined at every
/// sample. A force or couple that is only a rounding error compared with the other one is set to zero.
struct LoadSummary {
  /// For each of the components x, y and z: true if it is determined at every sample.
  std::array<bool, 3> determined = {true, true, true};
  double peak = 0, rms = 0;  ///< maximum and root mean square of the magnitude of the force or couple [N, N m]
  std::size_t at = 0;        ///< index of the first sample at which the magnitude is `peak`, within rounding
};

struct ReactionLoads {
  std::string name, on;  ///< names of the joint and of the body on which the reaction acts
  LoadSummary force, couple;
};

/// Computes peak and RMS loads of every joint. All samples of the trajectory must have reactions.
std::vector<ReactionLoads> reaction_loads(const Trajectory& trajectory);

}  // namespace pkm
