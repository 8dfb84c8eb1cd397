// Computes the JSON data of each panel of the HTML page.
//
// Each function returns null if its panel has no content; the page then omits the panel. Numbers that are displayed as
// values have full precision; long columns are packed (engine/report/packed_array.hpp). The file of the same name in
// engine/report/page/ draws the panel.
#pragma once

#include "engine/report/json_text.hpp"
#include "engine/report/shown_designs.hpp"
#include "engine/results/task_comparison.hpp"

namespace pkm {

/// Names and units of the study's problem, used by all panels: mechanism, parameters, variables, objectives,
/// constraints, outputs.
Json problem_data(const PageStudy& page);
/// State of the study, table of designs, active constraints, computing time of each stage, and data for running the
/// study again.
Json summary_data(const PageStudy& page);
/// For each stage over its generations: best value, median and quartiles of the objectives, feasible share, diversity,
/// indicators of the front. For solver stages: the multistart runs.
Json convergence_data(const StudyContents& contents);
/// The designs of each generation, or of each multistart run, subsampled.
Json populations_data(const StudyContents& contents);
/// All designs of the stages that are parameter sweeps.
Json sweeps_data(const StudyContents& contents);
/// The Pareto fronts with knees and compromise solutions, and the data of the panels "Workspace", "Mechanism" and
/// "Motions" for some designs of the last front.
Json front_data(const PageStudy& page);

/// The parameters of a single design, for a page without a study.
Json design_data(const ShownDesigns& shown);
/// The feasible cells of each design with their fields, the boundary surface, the largest solids, and the joints with
/// their ranges.
Json workspace_data(const ShownDesigns& shown);
/// The feasible cells and the boundary surface of the best design, without fields, from the voxel map in the study
/// file.
Json workspace_data(const StudyContents& contents);
/// The links of each design at all slider positions of the page and along the motions, and the dimensions of the
/// design.
Json mechanism_data(const ShownDesigns& shown);
/// Statistics of the coupling indices over the first rotational coordinate, if there is one. Null unless the study
/// requests coupling. Maps and histograms are drawn from the fields of the workspace.
Json coupling_data(const ShownDesigns& shown);
/// Positions, speeds, forces and power of the joints along the study's motions.
Json motions_data(const ShownDesigns& shown);

/// The table of a comparison of robots in a task, the workspaces, and the loads along the motions.
Json task_data(const TaskComparison& comparison);
/// The feasible cells and the boundary surface of a workspace, without fields.
/// @param found  workspace, which contains the fields `feasible` and `margin`
Json plain_workspace(const std::string& name, const WorkspaceFields& found);

}  // namespace pkm
