// Velocity constraints of a mechanism of rigid bodies. With the twist (v, omega) of each body at the platform's origin
// and the rates of the drives as unknowns, a joint in point p between two bodies gives
//
//   v_p = s a,            v_p = (v + omega x p) of one body less that of the other, s the rate of a drive along a
//   c . (omega - t a) = 0 for every direction c of a couple that the joint transmits, t the rate of a drive about a
//
// The twists of the platform in the null space are its degrees of freedom. Lengths are divided by the size of the
// mechanism, so that ranks do not depend on units.
//
// Reference: Hunt, Kinematic Geometry of Mechanisms, 1978 (mobility by screw systems).
#include "engine/generic/mobility.hpp"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

#include "engine/math/eigen_solvers.hpp"

namespace pkm::generic {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using VectorNodes = std::array<Node, 3>;

constexpr double kRankThreshold = 1e-9;  // singular values that are smaller, relative to the largest one, count as 0

Eigen::JacobiSVD<MatrixXd> decomposed(const MatrixXd& A) {
  Eigen::JacobiSVD<MatrixXd> decomposition(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  decomposition.setThreshold(kRankThreshold);
  return decomposition;
}
Index rank(const MatrixXd& A) { return A.cols() == 0 ? 0 : decomposed(A).rank(); }
MatrixXd beside(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd both(A.rows(), A.cols() + B.cols());
  both << A, B;
  return both;
}
/// True if a vector is in the column space of A (to within kRankThreshold). @param rank_of_A  rank of A
bool spans(const MatrixXd& A, Index rank_of_A, const Eigen::VectorXd& vector) {
  return rank(beside(A, vector)) == rank_of_A;
}
Matrix3d cross_matrix(const Vector3d& p) {
  Matrix3d m;
  m << 0, -p[2], p[1], p[2], 0, -p[0], -p[1], p[0], 0;
  return m;
}

/// The points and directions of the joints at a pose, with their derivatives with respect to the coordinates.
class JointsAtPose {
 public:
  JointsAtPose(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose, std::size_t mode)
      : of_(*e.model.jointed),
        rotation_(e.model.rotation),
        platform_(static_cast<std::size_t>(std::ranges::find(of_.solids, true, &SolidNodes::is_platform) -
                                           of_.solids.begin())),
        drives_(e.model.inputs.joints) {
    const Inputs& inputs = e.model.inputs;
    std::vector<Taylor> design(parameters.begin(), parameters.end());
    std::vector<Taylor> at = e.inputs<Taylor>(design, no_limits(e.model.info), mode);
    std::ranges::copy(pose, at.begin() + static_cast<std::ptrdiff_t>(inputs.coordinate(0)));
    const std::vector<Node> nodes = needed();
    const expression::Program program(e.model.graph, nodes);
    for (std::size_t j = 0; j < pose.size(); ++j) {
      at[inputs.coordinate(j)].d = 1;
      const std::vector<Taylor> values = outputs_of(program, at);
      at[inputs.coordinate(j)].d = 0;
      std::map<Node, Taylor>& by_node = values_.emplace_back();
      for (std::size_t i = 0; i < nodes.size(); ++i) by_node.emplace(nodes[i], values[i]);
    }
    origin_ = value(of_.solids[platform_].point);
    for (const JointNodes& joint : of_.joints)
      size_ = std::max(size_, (value(joint.point) - origin_).lpNorm<Eigen::Infinity>());
    if (size_ == 0) size_ = 1;
  }

  /// The twists (v / size, omega) of the platform that the joints allow, as orthonormal columns.
  MatrixXd allowed() const {
    const auto bodies = static_cast<Index>(6 * of_.solids.size());
    MatrixXd A = MatrixXd::Zero(static_cast<Index>(6 * of_.joints.size()), bodies + static_cast<Index>(drives_));
    for (Index row = 0; const JointNodes& joint : of_.joints) {
      const Vector3d p = (value(joint.point) - origin_) / size_;
      const Matrix3d couples = couples_of(joint);
      const auto add = [&](std::size_t solid, double sign) {
        const auto column = static_cast<Index>(6 * solid);
        A.block<3, 3>(row, column) += sign * Matrix3d::Identity();
        A.block<3, 3>(row, column + 3) -= sign * cross_matrix(p);
        A.block<3, 3>(row + 3, column + 3) += sign * couples;
      };
      add(joint.on, 1);
      if (joint.from) add(*joint.from, -1);
      if (joint.drive) {
        const Vector3d axis = value(joint.drive->axis).normalized();
        const Index column = bodies + static_cast<Index>(joint.drive->joint);
        if (joint.drive->turns)
          A.block<3, 1>(row + 3, column) -= couples * axis;
        else
          A.block<3, 1>(row, column) -= axis;
      }
      row += 6;
    }
    const auto decomposition = decomposed(A);
    const Index nullity = A.cols() - decomposition.rank();
    if (nullity == 0) return MatrixXd(6, 0);
    const MatrixXd twists = decomposition.matrixV().rightCols(nullity).middleRows(static_cast<Index>(6 * platform_), 6);
    const auto of_platform = decomposed(twists);
    // The rank threshold is absolute here, because null vectors have length 1, and the platform may be at rest in all
    // of them, so that there is no reference value.
    Index count = 0;
    while (count < of_platform.singularValues().size() && of_platform.singularValues()[count] > kRankThreshold) ++count;
    return of_platform.matrixU().leftCols(count);
  }

  /// The twist (v / size, omega) of the platform for a unit rate of each coordinate, as columns; std::nullopt if the
  /// ends of the limbs are given by formulas that do not move with the platform frame.
  std::optional<MatrixXd> by_coordinates() const {
    MatrixXd twists(6, static_cast<Index>(values_.size()));
    for (std::size_t j = 0; j < values_.size(); ++j) {
      Matrix3d R, rate;
      for (std::size_t i = 0; i < 3; ++i) {
        R.row(static_cast<Index>(i)) = value(rotation_[i]);
        rate.row(static_cast<Index>(i)) = rate_of(rotation_[i], j);
      }
      const Matrix3d spin = rate * R.transpose();
      const Vector3d v = rate_of(of_.solids[platform_].point, j), omega(spin(2, 1), spin(0, 2), spin(1, 0));
      for (const JointNodes& joint : of_.joints) {
        if (joint.on != platform_ && joint.from != platform_) continue;
        const Vector3d carried = v + omega.cross(value(joint.point) - origin_);
        if ((rate_of(joint.point, j) - carried).norm() > kRankThreshold * std::max(size_, 1.0)) return {};
      }
      twists.col(static_cast<Index>(j)) << v / size_, omega;
    }
    return twists;
  }

 private:
  std::vector<Node> needed() const {
    std::vector<Node> nodes;
    const auto add = [&nodes](const VectorNodes& point) { nodes.insert(nodes.end(), point.begin(), point.end()); };
    add(of_.solids[platform_].point);
    for (const VectorNodes& row : rotation_) add(row);
    for (const JointNodes& joint : of_.joints) {
      add(joint.point);
      for (const VectorNodes& axis : joint.axes) add(axis);
      if (joint.drive) add(joint.drive->axis);
    }
    return nodes;
  }
  Vector3d value(const VectorNodes& point) const {
    const auto at = [&](std::size_t k) { return values_.front().at(point[k]).a; };
    return {at(0), at(1), at(2)};
  }
  Vector3d rate_of(const VectorNodes& point, std::size_t coordinate) const {
    const auto at = [&](std::size_t k) { return values_[coordinate].at(point[k]).d; };
    return {at(0), at(1), at(2)};
  }
  /// 3 x 3 projection matrix onto the span of the directions of the couples that a joint can transmit.
  Matrix3d couples_of(const JointNodes& joint) const {
    MatrixXd axes(3, static_cast<Index>(joint.axes.size()));
    for (std::size_t k = 0; k < joint.axes.size(); ++k)
      axes.col(static_cast<Index>(k)) = value(joint.axes[k]).normalized();
    Matrix3d along = Matrix3d::Zero();
    if (axes.cols() > 0) {
      const auto decomposition = decomposed(axes);
      const MatrixXd basis = decomposition.matrixU().leftCols(decomposition.rank());
      along = basis * basis.transpose();
    }
    return joint.couples == JointNodes::Couples::along ? along : Matrix3d(Matrix3d::Identity() - along);
  }

  const JointedBodies& of_;
  const std::array<VectorNodes, 3>& rotation_;  ///< rotation matrix of the platform, by rows
  std::size_t platform_, drives_;
  /// Values and derivatives of the nodes, for a unit rate of each coordinate; by coordinate.
  std::vector<std::map<Node, Taylor>> values_;
  Vector3d origin_;
  double size_ = 0;
};

}  // namespace

PlatformMobility mobility_at(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                             std::size_t mode) {
  const JointsAtPose joints(evaluation, parameters, pose, mode);
  const MatrixXd allowed = joints.allowed();
  PlatformMobility found{.of_joints = static_cast<std::size_t>(allowed.cols()), .of_coordinates = {}, .assumed = {}};
  const std::optional<MatrixXd> of_coordinates = joints.by_coordinates();
  if (!of_coordinates) return found;
  const Index coordinate_rank = rank(*of_coordinates);
  found.of_coordinates =
      static_cast<std::size_t>(allowed.cols() + coordinate_rank - rank(beside(allowed, *of_coordinates)));
  std::vector<std::string> assumed;
  for (Index k = 0; k < 6; ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(6, k);
    if (spans(allowed, allowed.cols(), unit) && !spans(*of_coordinates, coordinate_rank, unit))
      assumed.push_back((k < 3 ? "translation along " : "rotation about ") + std::string(1, "xyz"[k % 3]));
  }
  if (assumed.size() + *found.of_coordinates == found.of_joints) found.assumed = assumed;
  return found;
}

}  // namespace pkm::generic
