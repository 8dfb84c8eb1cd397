// Facts about a design that pages show: ranges of joints, masses of bodies, positions of drives.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/capsule.hpp"
#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {

/// A drive at a pose, in the base frame.
struct PlacedDrive {
  std::size_t joint;           ///< index in MechanismInfo::joints
  double position;             ///< position of the joint [m or rad]
  bool rotates;                ///< true: the drive rotates about `axis` through `point`; false: it moves along `axis`
  bool on_base;                ///< true: the drive moves a body relative to the base
  Point3<double> point, axis;  ///< a point of the joint (of the slide if it is prismatic); unit vector of its axis
};

class DesignFacts {
 public:
  virtual ~DesignFacts() = default;
  /// Range of each actuated joint [m or rad], by joint; std::nullopt: this joint has no range.
  virtual std::vector<std::optional<std::array<double, 2>>> joint_ranges(std::span<const double> parameters) const = 0;
  /// Name and mass [kg] of each body that has a mass, without drive trains; empty if there are none.
  virtual std::vector<std::pair<std::string, double>> body_masses(std::span<const double> parameters) const = 0;
  /// Returns a thread-safe function that finds the drives of a design at a pose that assembles, by joint; it finds none
  /// if the bodies and joints of the mechanism are unknown. The mechanism must outlive the function.
  /// @param mode  one of MechanismInfo::modes
  virtual std::function<std::vector<PlacedDrive>(const Pose<double>&)> drives(std::span<const double> parameters,
                                                                              const std::string& mode) const = 0;
};

/// Finds the interface DesignFacts of a mechanism, which may have been wrapped by with_drive_trains(); null if the
/// mechanism does not come from a file.
inline const DesignFacts* find_design_facts(const Mechanism& mechanism) {
  return dynamic_cast<const DesignFacts*>(&without_drive_trains(mechanism));
}

}  // namespace pkm
