// Rigid-body pose of the platform, and the coordinates that correspond to it.
//
// Three angles parametrise each rotation twice: (a, b, c) and (a + pi, pi - b, c + pi) are the same rotation about
// x, y, z, and (a, b, c) and (a + pi, -b, c + pi) the same about z, y, z.
#pragma once

#include <Eigen/Core>

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

struct RigidPose {
  Eigen::Vector3d origin;    ///< origin of the platform frame, in the base frame [m]
  Eigen::Matrix3d rotation;  ///< rotation matrix from the platform frame to the base frame
};

/// @param inputs  values of the graph's inputs, including the pose
RigidPose rigid_pose(const Evaluation& e, const std::vector<double>& inputs);

/// Whether the rotation matrices, origins and translations of two poses are equal to within `tolerance` [1, m].
bool is_same_pose(const Model& model, const Pose<double>& a, const RigidPose& rigid_a, const Pose<double>& b,
                  const RigidPose& rigid_b, double tolerance);

/// Sets the angles of a pose to those of a rotation, in their principal ranges: (-pi, pi], but the second of three
/// angles in [-pi/2, pi/2], or in [0, pi] if the first and the third rotation have the same axis. An approximation if
/// the coordinates cannot represent the rotation.
void set_angles(const Model& model, const Eigen::Matrix3d& rotation, Pose<double>& pose);

/// A second pose with the same joint values, for a mechanism whose rods begin in one plane of the base and end in one
/// plane of the platform. The platform is reflected in its own plane, which does not move the ends of the rods, and
/// then in the plane of the base: two reflections are a rigid-body motion. Both planes are least-squares planes of the
/// points; for a planar mechanism they are lines. If the points do not lie in planes, or the coordinates cannot
/// represent the pose, the result is an approximation.
/// @param inputs  values of the graph's inputs, including the pose and the signs of its working mode
/// @return std::nullopt if there are fewer than two rods
std::optional<Pose<double>> mirror_image(const Evaluation& e, std::vector<double> inputs);

}  // namespace pkm::generic
