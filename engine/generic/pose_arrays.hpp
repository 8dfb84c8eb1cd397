// Inverse kinematics, Jacobians and quantities at arrays of poses, in SIMD batches.
#pragma once

#include <span>
#include <vector>

#include "engine/generic/pose_batch.hpp"

namespace pkm::generic {

/// Evaluates selected nodes of the model's graph, such as the joint coordinates, at each of many poses.
class PoseArrays {
 public:
  /// The joint coordinates, in the order of MechanismInfo::joints [m, rad].
  static PoseArrays joints(const Evaluation& evaluation, std::size_t mode);
  /// The Jacobian J, qdot = J Xdot, row by row: joints x coordinates.
  static PoseArrays jacobians(const Evaluation& evaluation, std::size_t mode);
  /// The quantity MechanismInfo::quantities[index], for the default values of extra inputs and a platform at rest.
  static PoseArrays quantity(const Evaluation& evaluation, std::size_t mode, std::size_t index);

  /// Number of values per pose.
  std::size_t width() const { return width_; }
  /// Computes the values at all poses, by the threads of the caller's team; the values do not depend on their number.
  /// @param poses   count x coordinates [m, rad]
  /// @param values  count x width(); NaN for a pose that does not assemble, and where a value is undefined
  void evaluate(std::span<const double> parameters, const LimitSpec& limits, std::span<const double> poses,
                std::span<double> values) const;

 private:
  PoseArrays(const Evaluation& evaluation, std::size_t mode, std::vector<Node> nodes);

  const Evaluation& e_;
  std::size_t mode_, width_;
  PoseBatch batch_;  ///< batch whose outputs are the values, then the constraints under which a pose assembles
};

}  // namespace pkm::generic
