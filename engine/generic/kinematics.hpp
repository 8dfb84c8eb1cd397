// What a description says of one pose: joints, margins, Jacobians and their derivatives.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/geometry/influence.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::generic {

PoseReport inspect_pose(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                        std::size_t mode, const LimitSpec& limits);

/// @param inputs  with the pose
bool assembles_at(const Evaluation& evaluation, const std::vector<double>& inputs);

/// The same of a pose that is known to be feasible, without margins and angles: it allocates nothing.
/// @param inputs  of the graph, with the pose; the joints are filled in
PoseReport report_of_sample(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                            std::span<double> inputs);

/// The model's quantities at a pose and motion.
std::vector<double> quantities_at(const Evaluation& evaluation, std::span<const double> parameters, std::size_t mode,
                                  const LimitSpec& limits, const MotionSample& at);

/// Absent where the pose does not assemble or they are infinite.
std::optional<Influence<double>> influence_at(const Evaluation& evaluation, std::span<const double> parameters,
                                              const Pose<double>& pose, std::size_t mode);

}  // namespace pkm::generic
