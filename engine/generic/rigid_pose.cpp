#include "engine/generic/rigid_pose.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/eigen_solvers.hpp"

namespace pkm::generic {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

/// A plane through `point`, normal to the unit vector `normal`.
struct Plane {
  Vector3d point, normal;

  /// Matrix of the reflection of directions in the plane.
  Matrix3d reflection() const { return Matrix3d::Identity() - 2 * normal * normal.transpose(); }
  Vector3d reflected(const Vector3d& x) const { return x - 2 * normal.dot(x - point) * normal; }
};

/// The least-squares plane of points. Its normal is the eigenvector that belongs to the smallest eigenvalue of the
/// scatter matrix.
/// @param in_plane  true for each coordinate axis to which the plane has to be parallel
Plane plane_of(const std::vector<Vector3d>& points, const std::array<bool, 3>& in_plane) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (!in_plane[static_cast<std::size_t>(k)]) continue;
    const double above_all_eigenvalues = 1 + 2 * scatter.trace();
    scatter.row(k).setZero();
    scatter.col(k).setZero();
    scatter(k, k) = above_all_eigenvalues;
  }
  return {mean, Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(scatter)).eigenvectors().col(0)};
}

/// For a planar mechanism, the coordinate axis that is normal to its plane: its platform does not translate along this
/// axis and rotates about no other one.
/// @return true for such an axis; false for the other axes and for other mechanisms
std::array<bool, 3> normal_to_motion(const Model& model) {
  std::array<bool, 3> normals{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto is_normal = [k](const std::optional<std::size_t>& axis) { return !axis || *axis == k; };
    normals[k] = std::ranges::find(model.translation_axes, std::optional(k)) == model.translation_axes.end() &&
                 std::ranges::all_of(model.rotation_axes, is_normal);
  }
  return normals;
}

}  // namespace

RigidPose rigid_pose(const Evaluation& e, const std::vector<double>& inputs) {
  const std::vector<double> frame = outputs_of(e.frame, inputs);
  return {Eigen::Map<const Vector3d>(frame.data()),
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.data() + 3)};
}

bool is_same_pose(const Model& model, const Pose<double>& a, const RigidPose& rigid_a, const Pose<double>& b,
                  const RigidPose& rigid_b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (model.translation_axes[i] && !(std::fabs(a[i] - b[i]) < tolerance)) return false;
  return (rigid_a.origin - rigid_b.origin).cwiseAbs().maxCoeff() < tolerance &&
         (rigid_a.rotation - rigid_b.rotation).cwiseAbs().maxCoeff() < tolerance;
}

void set_angles(const Model& model, const Matrix3d& R, Pose<double>& pose) {
  std::vector<std::size_t> rotations;
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (model.rotation_axes[i]) rotations.push_back(i);
  if (rotations.empty()) return;
  const auto axis = [&](std::size_t k) { return static_cast<Eigen::Index>(*model.rotation_axes[rotations[k]]); };
  const auto is_cyclic = [](Eigen::Index i, Eigen::Index j) { return (i + 1) % 3 == j; };
  const auto set = [&](std::size_t k, double sine, double cosine) {
    if (k < rotations.size()) pose[rotations[k]] = std::atan2(sine, cosine);
  };
  const Eigen::Index i = axis(0), j = rotations.size() > 1 && axis(1) != i ? axis(1) : (i + 1) % 3, k = 3 - i - j;
  const double sign = is_cyclic(i, j) ? 1 : -1;
  if (rotations.size() == 3 && axis(2) == i) {  // R = R_i(a) R_j(b) R_i(c)
    set(0, R(j, i), -sign * R(k, i));
    set(1, std::hypot(R(j, i), R(k, i)), R(i, i));
    set(2, R(i, j), sign * R(i, k));
  } else {  // R = R_i(a) R_j(b) R_k(c)
    set(0, -sign * R(j, k), R(k, k));
    set(1, sign * R(i, k), std::hypot(R(j, k), R(k, k)));
    set(2, -sign * R(i, j), R(i, i));
  }
}

std::optional<Pose<double>> mirror_image(const Evaluation& e, std::vector<double> inputs) {
  const Model& model = e.model;
  if (model.rods.size() < 2) return {};
  const std::vector<double> ends = outputs_of(e.rods, inputs);
  std::vector<Vector3d> base, platform;
  for (std::size_t rod = 0; rod < model.rods.size(); ++rod) {
    base.emplace_back(Eigen::Map<const Vector3d>(ends.data() + 6 * rod));
    platform.emplace_back(Eigen::Map<const Vector3d>(ends.data() + 6 * rod + 3));
  }
  const std::array<bool, 3> in_plane = normal_to_motion(model);
  const Plane first = plane_of(platform, in_plane), second = plane_of(base, in_plane);
  const RigidPose at = rigid_pose(e, inputs);
  const Vector3d origin = second.reflected(first.reflected(at.origin));

  const std::size_t coordinates = model.inputs.coordinate(0);
  Pose<double> pose(model.inputs.coordinates);
  std::copy_n(inputs.begin() + static_cast<std::ptrdiff_t>(coordinates), pose.size(), pose.begin());
  set_angles(model, second.reflection() * first.reflection() * at.rotation, pose);
  std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(coordinates));
  const Vector3d translation = origin - rigid_pose(e, inputs).origin;
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (const auto axis = model.translation_axes[i]) pose[i] += translation[static_cast<Eigen::Index>(*axis)];
  return pose;
}

}  // namespace pkm::generic
