// CSV tables of workspaces, trajectories, simulations and coupling indices. Numbers are in SI units.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/export/csv_table.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/workspace_result.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// One row per cell: the coordinates of its centre and all fields.
CsvTable workspace_table(const WorkspaceFields& workspace);

/// One row per feasible cell: the coordinates of its centre, the coupling index of each joint, and the largest of them.
/// @param workspace  its result has poses and the field kCouplingIndex
CsvTable coupling_table(const MechanismInfo& info, const WorkspaceResult<double>& workspace);

/// One row per sample; undefined values are empty cells.
CsvTable trajectory_table(const Mechanism& mechanism, const Trajectory& trajectory);

/// One row per time step.
/// @param friction  whether the drives have friction
CsvTable simulation_table(const MechanismInfo& info, const Simulation& run, bool friction);

}  // namespace pkm
