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
  std::string name;  ///< name of the joint, for example "a1"
  std::string on;    ///< body on which the force and the couple act; their opposites act on the other body
  /// Components along x, y, z [N]. A component is std::nullopt if rigid-body equations do not determine it, because the
  /// mechanism is overconstrained.
  std::array<std::optional<double>, 3> force;
  /// Components about x, y, z [N m]; 0 about free axes of the joint. The torque of a rotary drive is part of the couple
  /// of its joint.
  std::array<std::optional<double>, 3> couple;
};

/// Solution of the Newton-Euler equations of all bodies (newton_euler.hpp).
struct Reactions {
  std::vector<JointReaction> joints;  ///< reactions of all joints; empty if the forces are not determined
  AxisVector<double> drive_forces;    ///< force of each actuator, from the same equations [N, N m]
  int equations = 0, unknowns = 0, rank = 0;
  std::string reason;  ///< reason why the forces are not determined, one sentence; "" if they are determined
};

}  // namespace pkm
