// Forces of drives that may be redundant: at least as many drives as coordinates, and cables, which only pull.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/dynamics/force_distribution.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The limits of the drive forces of a design, and how redundant drives share a load.
class LimitedDrives {
 public:
  virtual ~LimitedDrives() = default;
  virtual DriveLimits drive_limits(std::span<const double> parameters) const = 0;
  /// Indices of the joints that cables drive.
  virtual std::vector<std::size_t> cables() const = 0;
};

/// Finds the interface LimitedDrives of a mechanism, which may have been wrapped by with_drive_trains(); null if its
/// drives have no limits and share a load by least norm.
const LimitedDrives* find_limited_drives(const Mechanism& mechanism);

/// The limits of the drive forces of a mechanism.
DriveLimits drive_limits(const Mechanism& mechanism, std::span<const double> parameters);

/// The reason why drive forces are undefined: the mechanism has no masses, or fewer drives than coordinates. Empty if
/// they are defined.
Unsupported why_no_drive_forces(const Mechanism& mechanism);

/// Drive forces for an acceleration under a wrench, and the reason if there are none.
struct DistributedForces {
  /// Force or torque of each drive [N, N m]; std::nullopt if no forces balance the load.
  std::optional<AxisVector<double>> tau;
  std::string reason;  ///< reason why there are no forces; "" if there are
};
DistributedForces distributed_forces(const PoseDynamics<double>& d, const AxisVector<double>& acceleration,
                                     const Wrench<double>& wrench, const DriveLimits& limits);

}  // namespace pkm
