#include "engine/generic/rigid_pose.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace pkm::generic {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

std::vector<double> run(const expression::Program& program, std::span<const double> inputs) {
  std::vector<double> registers(program.registers()), values;
  program.run_all<double>(inputs, std::span(registers));
  for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
  return values;
}

/// A plane through `point`, normal to the unit vector `normal`.
struct Plane {
  Vector3d point, normal;

  /// The linear part of the reflection in it.
  Matrix3d reflection() const { return Matrix3d::Identity() - 2 * normal * normal.transpose(); }
  Vector3d reflected(const Vector3d& x) const { return x - 2 * normal.dot(x - point) * normal; }
};

/// The least-squares plane of points. @param in_plane  axes that lie in it
Plane plane_of(const std::vector<Vector3d>& points, const std::array<bool, 3>& in_plane) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& point : points) mean += point / static_cast<double>(points.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (!in_plane[static_cast<std::size_t>(k)]) continue;
    const double larger_than_all = 1 + 2 * scatter.trace();
    scatter.row(k).setZero();
    scatter.col(k).setZero();
    scatter(k, k) = larger_than_all;
  }
  return {mean, Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0)};
}

/// The axes that a motion of the platform leaves in a mechanism's plane: it has no coordinate along them, and turns
/// about nothing else.
std::array<bool, 3> normals_of_motion(const Model& model) {
  std::array<bool, 3> normals{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto leaves = [k](const std::optional<std::size_t>& axis) { return !axis || *axis == k; };
    normals[k] = std::ranges::find(model.moves_along, std::optional(k)) == model.moves_along.end() &&
                 std::ranges::all_of(model.turns_about, leaves);
  }
  return normals;
}

}  // namespace

RigidPose rigid_pose(const Evaluation& e, std::span<const double> inputs) {
  const std::vector<double> frame = run(e.frame, inputs);
  return {Eigen::Map<const Vector3d>(frame.data()),
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.data() + 3)};
}

bool is_same_pose(const Model& model, const Pose<double>& a, const RigidPose& rigid_a, const Pose<double>& b,
                  const RigidPose& rigid_b, double tolerance) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (model.moves_along[i] && !(std::fabs(a[i] - b[i]) < tolerance)) return false;
  return (rigid_a.origin - rigid_b.origin).cwiseAbs().maxCoeff() < tolerance &&
         (rigid_a.rotation - rigid_b.rotation).cwiseAbs().maxCoeff() < tolerance;
}

void set_angles(const Model& model, const Matrix3d& R, Pose<double>& pose) {
  std::vector<std::size_t> turns;
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (model.turns_about[i]) turns.push_back(i);
  if (turns.empty()) return;
  const auto axis = [&](std::size_t k) { return static_cast<Eigen::Index>(*model.turns_about[turns[k]]); };
  const auto is_cyclic = [](Eigen::Index i, Eigen::Index j) { return (i + 1) % 3 == j; };
  const auto set = [&](std::size_t k, double sine, double cosine) {
    if (k < turns.size()) pose[turns[k]] = std::atan2(sine, cosine);
  };
  const Eigen::Index i = axis(0), j = turns.size() > 1 && axis(1) != i ? axis(1) : (i + 1) % 3, k = 3 - i - j;
  const double sign = is_cyclic(i, j) ? 1 : -1;
  if (turns.size() == 3 && axis(2) == i) {  // R = R_i(a) R_j(b) R_i(c)
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
  const std::vector<double> ends = run(e.rods, inputs);
  std::vector<Vector3d> base, platform;
  for (std::size_t rod = 0; rod < model.rods.size(); ++rod) {
    base.emplace_back(Eigen::Map<const Vector3d>(ends.data() + 6 * rod));
    platform.emplace_back(Eigen::Map<const Vector3d>(ends.data() + 6 * rod + 3));
  }
  const std::array<bool, 3> in_plane = normals_of_motion(model);
  const Plane first = plane_of(platform, in_plane), second = plane_of(base, in_plane);
  const RigidPose at = rigid_pose(e, inputs);
  const Vector3d origin = second.reflected(first.reflected(at.origin));

  const std::size_t coordinates = model.inputs.coordinate(0);
  Pose<double> pose(model.inputs.coordinates);
  std::copy_n(inputs.begin() + static_cast<std::ptrdiff_t>(coordinates), pose.size(), pose.begin());
  set_angles(model, second.reflection() * first.reflection() * at.rotation, pose);
  std::ranges::copy(pose, inputs.begin() + static_cast<std::ptrdiff_t>(coordinates));
  const Vector3d missing = origin - rigid_pose(e, inputs).origin;
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (const auto axis = model.moves_along[i]) pose[i] += missing[static_cast<Eigen::Index>(*axis)];
  return pose;
}

}  // namespace pkm::generic
