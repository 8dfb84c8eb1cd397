// Rigorous bounds for a mechanism file, by interval arithmetic on its expression graph: workspace volume, and
// feasibility and regularity of all poses of a solid or of a motion. See mechanism/abilities/bounds.hpp.
#pragma once

#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Throws std::invalid_argument with a message if no certified bounds can be computed for a workspace plan.
void require_bounds(const Model& model, const WorkspacePlan& plan);
/// Bounds of the workspace volume of a design.
VolumeBounds bound_volume(const Mechanism& mechanism, const Evaluation& evaluation, std::span<const double> parameters,
                          const WorkspacePlan& plan, std::size_t mode, const BoundsOptions& options);
/// Decides whether all poses of a solid are feasible and regular.
PoseCertificate certify_solid(const Evaluation& evaluation, std::span<const double> parameters,
                              const WorkspacePlan& plan, std::size_t mode, const PoseSolid& poses,
                              const BoundsOptions& options);
/// Decides whether all poses of a motion are feasible and regular.
PoseCertificate certify_motion(const Evaluation& evaluation, std::span<const double> parameters,
                               const LimitSpec& limits, std::size_t mode, const Motion& motion,
                               const BoundsOptions& options);

/// Tries to prove that every path from one pose to another leaves the limits, the box or the working mode, or crosses a
/// singularity (RigorousBounds::separate()).
Separation separate_poses(const Evaluation& evaluation, std::span<const double> parameters, const WorkspacePlan& plan,
                          std::size_t mode, const Pose<double>& from, const Pose<double>& to,
                          const BoundsOptions& options);

}  // namespace pkm::generic
