// Draws what mechanism files leave out: the motors of the drives, and a base that connects the fixed joints.
#pragma once

#include <string>
#include <vector>

#include "engine/geometry/placed_link.hpp"
#include "engine/mechanism/design_facts.hpp"

namespace pkm {

inline constexpr const char* kMotorPart = "motors";  ///< value of PlacedLink::part for motors

/// Motors as capsules: on the axis of a crank, at the lower end of a rail, or around the middle of a leg that extends.
/// Their size is not that of a real motor; it follows from the radius of the links.
class DrawnMotors {
 public:
  /// @param mechanism  must outlive this object; without DesignFacts there are no motors
  /// @param mode       one of MechanismInfo::modes
  DrawnMotors(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode);
  /// Appends the motors at a pose to `links`, the links at this pose, which must not be empty. Thread-safe.
  void append(const Pose<double>& pose, std::vector<PlacedLink>& links) const;

 private:
  std::function<std::vector<PlacedDrive>(const Pose<double>&)> drives_;  ///< drives of a pose; empty if unknown
  std::vector<AxisInfo> joints_;
  std::vector<std::optional<std::array<double, 2>>> ranges_;
};

/// Appends a base to the links at every pose: a polygon through those link ends that have the same position at all
/// poses. Does nothing if the mechanism already has links of the frame, or if there are fewer than two poses or such
/// ends.
/// @param poses  the links at each pose, in the same order for every pose
void append_base(const std::vector<std::vector<PlacedLink>*>& poses);

}  // namespace pkm
