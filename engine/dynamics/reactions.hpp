// What the joints of a mechanism carry.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/math/small_matrix.hpp"

namespace pkm {

/// One joint: what it transmits, in world axes, acting on the body that is named first.
struct JointReaction {
  std::string name;  ///< "a1"
  std::string on;    ///< the body acted on; the opposite acts on the other
  /// Along x, y, z [N]; none where the mechanism is overconstrained and rigid bodies do not determine it.
  std::array<std::optional<double>, 3> force;
  /// The same [N m]: 0 where the joint turns freely; a drive that turns is part of its joint's couple.
  std::array<std::optional<double>, 3> couple;
};

/// Source of the model: Newton's and Euler's equations of every body.
struct Reactions {
  std::vector<JointReaction> joints;  ///< empty where the forces are not determined
  AxisVector<double> drive_forces;    ///< of the actuators, found with the others [N, N m]
  int equations = 0, unknowns = 0, rank = 0;
  std::string reason;  ///< one sentence saying why the forces are not determined; "" where they are
};

}  // namespace pkm
