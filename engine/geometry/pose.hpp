// Poses of a platform, and the results of inverse and forward kinematics at a pose.
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

/// The pose of a platform with three translations and one rotation (Schoenflies motion), with named coordinates.
/// Mechanisms with these degrees of freedom use it.
template <class S>
struct SchoenfliesPose {
  S x{}, y{}, z{}, angle{};

  operator Pose<S>() const { return {x, y, z, angle}; }
};
template <class S>
SchoenfliesPose<S> schoenflies(const MatrixUpTo<S, kMaxJoints>& pose) {
  return {pose[0], pose[1], pose[2], pose[3]};
}

/// A coordinate of the pose or an actuated joint.
struct AxisInfo {
  std::string name;  ///< such as "x" for a coordinate, "q1" for a joint
  std::string unit;  ///< "m" or "rad"

  bool turns() const { return unit == "rad"; }
};

/// Named values in the order in which they are printed.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// Kinematic analysis of one pose of one design. Values that do not exist are std::nullopt (printed as null).
struct PoseReport {
  bool assembles = false;  ///< the inverse kinematics has a solution in the requested working mode
  bool feasible = false;   ///< the mechanism can be assembled at the pose, and every margin is >= 0
  std::string reason;      ///< why the mechanism cannot be assembled, or the first violated margin; "" if feasible
  /// Joint positions in the order of MechanismInfo::joints; NaN if this joint has no solution.
  std::optional<AxisVector<double>> joints;
  /// Jacobians: Jq qdot = G V for joint rates qdot and coordinate rates V; J = Jq^-1 G, absent if Jq is singular.
  std::optional<AxisMatrix<double>> Jq, G, J;
  /// 6 x coordinates: t = T V is the twist of the platform (velocity of its origin, then angular velocity, both in the
  /// base frame), where V are the rates of the coordinates.
  std::optional<AxisMatrix<double>> T;
  std::optional<double> det_Jq, det_G;
  std::optional<double> conditioning;  ///< inverse condition number of the Jacobian, in [0, 1]
  NamedValues indices;                 ///< singularity indices that this mechanism defines
  NamedValues angles;                  ///< further angles [rad] and lengths [m] that this mechanism defines
  NamedValues margins;  ///< values of the pose-level constraints; a value >= 0 means that the constraint is satisfied
  /// Values of MechanismInfo::quantities for the default inputs and a platform at rest; NaN if undefined.
  std::vector<double> quantities = {};
};

/// One solution of the forward kinematics.
struct AssemblyMode {
  Pose<double> pose;
  std::string mode;   ///< name of this assembly mode, defined by the mechanism
  bool usual = true;  ///< true: always listed; false: listed on request only
  /// Working mode in which the inverse kinematics reproduces the joint positions; "": every working mode.
  std::string working_mode = {};
  /// Names of the coordinates that are double roots, where two assembly modes coincide.
  std::vector<std::string> double_roots = {};
};

/// Outcome of the forward kinematics.
struct ForwardStatus {
  std::string word = "OK";  ///< status: "OK", "NO_POSE" (no pose was found) or another word that the mechanism defines
  std::string reason;       ///< explanation in one sentence; "" if the status is OK
};

}  // namespace pkm
