// CSV tables of workspaces, trajectories, simulations and coupling indices. Numbers are in SI units.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/export/csv_table.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/workspace_result.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// Table of a workspace with one row per cell: the coordinates of the cell's centre and all fields.
CsvTable workspace_table(const WorkspaceFields& workspace);

/// Table of coupling indices with one row per feasible cell: the coordinates of the cell's centre, the coupling index
/// of each joint, and the largest of these indices.
/// @param workspace  its samples must contain poses and the field kCouplingIndex
CsvTable coupling_table(const MechanismInfo& info, const WorkspaceResult<double>& workspace);

/// Table of a trajectory with one row per sample; undefined values are empty cells.
CsvTable trajectory_table(const Mechanism& mechanism, const Trajectory& trajectory);

/// Table of a simulation with one row per time step.
/// @param friction  true if the drives have friction, for which columns are added
CsvTable simulation_table(const MechanismInfo& info, const Simulation& run, bool friction);

}  // namespace pkm
