// Reaction forces and couples in the joints of a mechanism.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/small_matrix.hpp"

namespace pkm {

/// Force and couple that a joint transmits to the body `on`, in world axes.
struct JointReaction {
  std::string name;  ///< "a1"
  std::string on;    ///< body on which the force and the couple act; their opposites act on the other body
  /// Components along x, y, z [N]; std::nullopt if rigid bodies do not determine a component (overconstrained
  /// mechanism).
  std::array<std::optional<double>, 3> force;
  /// Components [N m]; 0 about free axes of the joint. The torque of a rotary drive is part of the couple of its joint.
  std::array<std::optional<double>, 3> couple;
};

/// Solution of the Newton-Euler equations of all bodies (newton_euler.hpp).
struct Reactions {
  std::vector<JointReaction> joints;  ///< empty if the forces are not determined
  AxisVector<double> drive_forces;    ///< forces of the actuators, from the same equations [N, N m]
  int equations = 0, unknowns = 0, rank = 0;
  std::string reason;  ///< one sentence why the forces are not determined; "" if they are
};

}  // namespace pkm
