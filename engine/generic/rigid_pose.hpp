// Rigid-body pose of the platform: position of its origin and rotation matrix, and the coordinates that give them.
//
// Three angles are a two-to-one parametrisation of rotations: (a, b, c) and (a + pi, pi - b, c + pi) are one rotation
// about x, y, z, and so are (a, b, c) and (a + pi, -b, c + pi) about z, y, z.
#pragma once

#include <Eigen/Core>

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

struct RigidPose {
  Eigen::Vector3d origin;    ///< of the platform's frame [m], in the base's
  Eigen::Matrix3d rotation;  ///< from the platform's frame to the base's
};

/// @param inputs  of the graph, with the pose
RigidPose rigid_pose(const Evaluation& e, std::span<const double> inputs);

/// Whether two poses have one rotation matrix, one origin and the same translations, each to `tolerance` [1, m].
bool is_same_pose(const Model& model, const Pose<double>& a, const RigidPose& rigid_a, const Pose<double>& b,
                  const RigidPose& rigid_b, double tolerance);

/// Sets the angles of a pose to those of a rotation, in (-pi, pi], the second of three in [-pi/2, pi/2], or in [0, pi]
/// where the first and the third turn about one axis. Exact where the angles can give that rotation.
void set_angles(const Model& model, const Eigen::Matrix3d& rotation, Pose<double>& pose);

/// The pose of the mirror image of a mechanism whose rods begin in one plane, and end in one plane of the platform: it
/// has the same joints. The platform is reflected in its own plane, which leaves the ends of the rods, and then in the
/// plane of the base: two reflections are a motion. Both planes are least-squares planes of the points; of a mechanism
/// that moves in a plane they are lines in it. Where the points do not lie in planes, or the coordinates cannot give
/// that motion, it is a pose near it. @return none where there are fewer than two rods
/// @param inputs  of the graph, with the pose and the signs of its working mode
std::optional<Pose<double>> mirror_image(const Evaluation& e, std::vector<double> inputs);

}  // namespace pkm::generic
