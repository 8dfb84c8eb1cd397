// What a description says of one pose: joints, margins, Jacobians and their derivatives.
#pragma once

#include "engine/mechanisms/described/evaluation.hpp"
#include "engine/model/influence.hpp"
#include "engine/model/pose.hpp"

namespace pkm::described {

PoseReport inspect_pose(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                        std::size_t mode, const LimitSpec& limits);

/// @param inputs  with the pose
bool assembles_at(const Evaluation& evaluation, const std::vector<double>& inputs);

/// The same of a pose that is known to be feasible, without margins and angles: it allocates nothing.
/// @param inputs  of the graph, with the pose; the joints are filled in
PoseReport report_of_sample(const Evaluation& evaluation, std::span<const double> parameters, const Pose<double>& pose,
                            std::span<double> inputs);

/// Absent where the pose does not assemble or they are infinite.
std::optional<Influence<double>> influence_at(const Evaluation& evaluation, std::span<const double> parameters,
                                              const Pose<double>& pose, std::size_t mode);

}  // namespace pkm::described
