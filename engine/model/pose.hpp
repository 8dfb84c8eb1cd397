// A pose of a platform, and what a mechanism can say of one pose.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/math/small_matrix.hpp"

namespace pkm {

/// Values of the mechanism's coordinates, in their order (MechanismInfo::coordinates): lengths [m] and angles [rad].
template <class S>
using Pose = AxisVector<S>;

/// The pose of a platform with three translations and one rotation, by name: what mechanisms with these freedoms
/// compute with.
template <class S>
struct SchoenfliesPose {
  S x{}, y{}, z{}, angle{};

  operator Pose<S>() const { return {x, y, z, angle}; }
};
template <class S>
SchoenfliesPose<S> schoenflies(const MatrixUpTo<S, kMostJoints>& pose) {
  return {pose[0], pose[1], pose[2], pose[3]};
}

/// PoseReport::T of such a pose. @param axis  of the rotation, 0 to 2
inline AxisMatrix<double> schoenflies_twist(std::size_t axis) {
  auto T = AxisMatrix<double>::zero(6, 4);
  for (std::size_t k = 0; k < 3; ++k) T(k, k) = 1;
  T(3 + axis, 3) = 1;
  return T;
}

/// A coordinate of the pose or an actuated joint.
struct AxisInfo {
  std::string name;  ///< "x", "q1"
  std::string unit;  ///< "m" or "rad"

  bool turns() const { return unit == "rad"; }
};

/// Named numbers in the order in which they are shown.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// Everything about one pose of one design. What does not exist is absent (printed as null).
struct PoseReport {
  bool assembles = false;                    ///< the inverse kinematics has a solution in the working mode asked for
  bool feasible = false;                     ///< assembles and every margin >= 0
  std::string reason;                        ///< why it does not assemble, or the first broken margin; "" when feasible
  std::optional<AxisVector<double>> joints;  ///< order of MechanismInfo::joints; NaN for one that is not there
  std::optional<AxisMatrix<double>> Jq, G, J;  ///< Jq qdot = G V, J = Jq^-1 G (absent when Jq is singular)
  /// 6 x coordinates: t = T V is the twist of the platform, velocity of its origin and angular velocity, both along the
  /// base's axes; V are rates of the coordinates.
  std::optional<AxisMatrix<double>> T;
  std::optional<double> det_Jq, det_G;
  std::optional<double> conditioning;  ///< inverse condition number in [0, 1]
  NamedValues indices;                 ///< mechanism's own singularity indices
  NamedValues angles;                  ///< mechanism's own angles [rad] and lengths [m]
  NamedValues margins;                 ///< named pose-level margins, >= 0 holds
};

/// One solution of the forward kinematics.
struct AssemblyMode {
  Pose<double> pose;
  std::string mode;                            ///< how the mechanism calls this assembly
  bool usual = true;                           ///< listed by default; the others only on request
  std::string working_mode = {};               ///< the inverse kinematics finds the joints in; "": in every one
  std::vector<std::string> double_roots = {};  ///< coordinates in which two assembly modes meet here
};

/// Why forward kinematics finds what it finds.
struct ForwardStatus {
  std::string word = "OK";  ///< or "NO_POSE" or another, in capitals
  std::string reason;       ///< one sentence; "" when OK
};

}  // namespace pkm
