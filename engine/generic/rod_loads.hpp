// Axial forces and stresses of rods, and their safety against Euler buckling, from the reactions in their joints. A rod
// is a bar of constant section with pinned ends: it buckles at F = pi^2 E I / L^2 (Timoshenko and Gere, "Theory of
// Elastic Stability", 1961, chapter 2). Rods are those of limbs whose rod section has Young's modulus.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/dynamics/reactions.hpp"
#include "engine/mechanism/trajectory.hpp"

namespace pkm::generic {

/// Loads of a rod at one state.
struct RodLoad {
  std::string name;           ///< name of the rod, such as "rod 1 of arm1"
  double area = 0;            ///< area of its cross-section [m^2]
  double buckling_force = 0;  ///< compressive force at which the rod buckles [N]
  /// Axial force at each end of the rod [N], > 0 for tension; the two differ because of the inertia of the rod.
  /// std::nullopt if the equations of motion do not determine them.
  std::optional<std::array<double, 2>> ends;

  /// axial(): the axial force at the end where its magnitude is larger [N]; compression(): the maximum compressive
  /// force [N], >= 0. Both require `ends`.
  double axial() const { return std::fabs((*ends)[0]) > std::fabs((*ends)[1]) ? (*ends)[0] : (*ends)[1]; }
  double compression() const { return std::max({0.0, -(*ends)[0], -(*ends)[1]}); }
  /// Buckling force divided by the compression; std::nullopt if the rod is not under compression.
  std::optional<double> reserve() const {
    return ends && compression() > 0 ? std::optional(buckling_force / compression()) : std::nullopt;
  }
};

/// The loads of all rods whose joints are both among the reactions; empty if no rod section has Young's modulus.
/// @param pose       a pose that assembles
/// @param reactions  reactions in the joints of the mechanism at this pose
std::vector<RodLoad> rod_loads(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode,
                               const Pose<double>& pose, const Reactions& reactions);

/// Extrema of the loads of a rod along a trajectory.
struct PeakRodLoad {
  std::string name;
  double buckling_force = 0;            ///< compressive force at which the rod buckles [N]
  double tension = 0, compression = 0;  ///< maximum tension and maximum compression [N]; 0 if there is none
  double stress = 0;                    ///< maximum magnitude of the axial stress [Pa]
  std::optional<double> reserve;  ///< minimum of RodLoad::reserve(); std::nullopt if the rod is never under compression
  std::size_t critical = 0;       ///< index of the first sample at which the minimum reserve occurs
  bool is_determined = true;      ///< false: the axial force is undetermined at one sample or more
};

/// Finds the extrema of the loads of each rod. @param trajectory  must have reactions at all samples (add_reactions)
std::vector<PeakRodLoad> peak_rod_loads(const Mechanism& mechanism, std::span<const double> parameters,
                                        const std::string& mode, const Trajectory& trajectory);

}  // namespace pkm::generic
