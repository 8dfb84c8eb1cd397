// Errors of the platform for errors of the joints, without linearisation: the maxima over the vertices of the box of
// joint errors.
#pragma once

#include <span>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm::generic {

/// The fields `accuracy_exact` [m] and `accuracy_angle_exact` [rad], with one value per pose. They are the counterparts
/// of the first-order quantities `accuracy` and `accuracy_angle`, and exist only if the mechanism has these.
///
/// The pose of every vertex of the box |e_i| <= bound_i is found by Newton's method with the Jacobian of the given pose
/// (chord method). A value is NaN if the pose is singular or if this does not converge for one of the vertices.
/// @param poses  feasible poses; they are evaluated in parallel on the caller's threads
std::vector<WorkspaceField> exact_accuracy_fields(const Mechanism& mechanism, std::span<const double> parameters,
                                                  const std::vector<Pose<double>>& poses);

}  // namespace pkm::generic
