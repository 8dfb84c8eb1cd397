// Analysis by columns of the component of the workspace that holds the home pose (WorkspacePlan::home).
//
// A flood fill on a grid finds the components, and columns compute the volume. If the component ends at a singularity,
// det J >= 0 (or <= 0) is added to the constraints. If the grid then shows one component only, the volume is that of
// all columns. Otherwise every quadrature node is assigned to a component. A component consists of whole subintervals
// of columns, because its boundary is one of the surfaces of the decomposition, so that the weights of its nodes add up
// to its volume.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Prepares the analysis of the component that holds the home pose. A design whose home pose is infeasible, singular or
/// outside of the grid throws DesignError, as does one whose component ends at a singularity, if the mechanism does not
/// support SidedColumns::on_side(). Throws std::invalid_argument if the plan is not supported.
/// @param mechanism  must outlive the evaluator
/// @param map        evaluator of the grid of the same design, without a home pose
std::unique_ptr<const WorkspaceEvaluator> prepare_home_columns(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                               const FieldRequest& request,
                                                               std::unique_ptr<const VoxelEvaluator> map);

/// The plan of the grid on which the components of a plan with columns are found.
WorkspacePlan grid_of_components(const MechanismInfo& info, const WorkspacePlan& plan);

}  // namespace pkm
