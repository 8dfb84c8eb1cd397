// Kinematic analysis of one pose of a mechanism file: inverse kinematics, margins, Jacobians and their derivatives.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/geometry/influence.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::generic {

/// Kinematic analysis of a pose: joint positions, margins, Jacobians and quantities.
PoseReport inspect_pose(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                        std::size_t mode, const LimitSpec& limits);

/// True if all joint coordinates have a solution.
/// @param inputs  values of the graph's inputs, including the pose
bool assembles_at(const Evaluation& evaluation, const std::vector<double>& inputs);

/// Kinematic analysis of a pose that is known to be feasible, without margins, angles and quantities, and without heap
/// allocation.
/// @param inputs  values of the graph's inputs, including the pose; the joint positions are written to it
PoseReport inspect_sample(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                          std::span<double> inputs);

/// Values of Model::quantities at a pose, for a given motion.
std::vector<double> quantities_at(const Evaluation& evaluation, std::span<const double> parameters, std::size_t mode,
                                  const LimitSpec& limits, const MotionSample& at);

/// The influence coefficients at a pose; std::nullopt if the pose does not assemble, or if the coefficients are
/// infinite.
std::optional<Influence<double>> influence_at(const Evaluation& evaluation, std::span<const double> parameters,
                                              const Pose<double>& pose, std::size_t mode);

}  // namespace pkm::generic
