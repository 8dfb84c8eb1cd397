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

/// The pose of a platform with three translations and one rotation (Schoenflies motion), with named coordinates; used
/// by mechanisms with these degrees of freedom.
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
  std::string name;  ///< "x", "q1"
  std::string unit;  ///< "m" or "rad"

  bool turns() const { return unit == "rad"; }
};

/// Named values in the order in which they are printed.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// Kinematic analysis of one pose of one design. Values that do not exist are std::nullopt (printed as null).
struct PoseReport {
  bool assembles = false;                    ///< the inverse kinematics has a solution in the requested working mode
  bool feasible = false;                     ///< assembles and every margin >= 0
  std::string reason;                        ///< why it does not assemble, or the first violated margin; "" if feasible
  std::optional<AxisVector<double>> joints;  ///< order of MechanismInfo::joints; NaN: no solution for this joint
  std::optional<AxisMatrix<double>> Jq, G, J;  ///< Jq qdot = G V, J = Jq^-1 G (no J if Jq is singular)
  /// 6 x coordinates: t = T V is the twist of the platform (velocity of its origin, then angular velocity, both in the
  /// base frame), where V are the rates of the coordinates.
  std::optional<AxisMatrix<double>> T;
  std::optional<double> det_Jq, det_G;
  std::optional<double> conditioning;  ///< inverse condition number in [0, 1]
  NamedValues indices;                 ///< singularity indices specific to the mechanism
  NamedValues angles;                  ///< angles [rad] and lengths [m] specific to the mechanism
  NamedValues margins;                 ///< pose-level constraint values; >= 0: satisfied
  std::vector<double> quantities =
      {};  ///< values of MechanismInfo::quantities with default inputs, at rest; NaN: undefined
};

/// One solution of the forward kinematics.
struct AssemblyMode {
  Pose<double> pose;
  std::string mode;               ///< the mechanism's name of this assembly mode
  bool usual = true;              ///< listed by default; otherwise on request only
  std::string working_mode = {};  ///< inverse kinematics in this mode reproduces the joints; "": in every mode
  std::vector<std::string> double_roots = {};  ///< coordinates that are double roots: two assembly modes coincide
};

/// Outcome of the forward kinematics.
struct ForwardStatus {
  std::string word = "OK";  ///< or "NO_POSE" or another status word
  std::string reason;       ///< one sentence; "" if OK
};

}  // namespace pkm
