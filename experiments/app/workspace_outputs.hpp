// The files that show a workspace to other programs, as `export` and `workspace` write them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/report/workspace_fields.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Makes a folder, and those it lies in, if it is not there. Throws StorageError.
void make_folder(const std::string& folder);

/// "workspace of 4ppa-2par, the best design of study wide"
std::string title_of(const Target& target);

struct WorkspaceOutputs {
  std::string vtk;  ///< file; "": none
  std::string stl;  ///< file, F.stl, or folder; "": none
  bool force = false;

  bool any() const { return !vtk.empty() || !stl.empty(); }
};

/// Declares --vtk, --stl and --force.
void add_workspace_outputs(CLI::App& command, WorkspaceOutputs& outputs);

/// Declares -o: a file, whose ending says which of these it is.
void add_output_by_ending(CLI::App& command, const std::vector<std::pair<std::string, std::string*>>& files);

/// What they will be for a design.
std::vector<std::string> files_of(const WorkspaceOutputs& outputs, const Target& target);

/// Cells whose fields are computed, at most: each takes some 100 bytes.
inline constexpr double kMostCells = 1e7;

/// Throws ConfigError where the plan has more cells.
void expect_few_cells(const SurveyPlan& plan);

/// The workspace's fields. Throws ConfigError when the mechanism cannot serve the plan.
WorkspaceFields fields_of(const Target& target, const SurveyPlan& plan, const std::string& mode);

/// Throws ConfigError where a surface is asked for and what is swept can have none.
/// @param swept  names of coordinates
void expect_surface(const WorkspaceOutputs& outputs, const std::vector<std::string>& swept);

/// Writes files_of(); throws StorageError, and std::runtime_error when there is no surface.
void write_workspace(const WorkspaceOutputs& outputs, const Target& target, const WorkspaceFields& workspace);

}  // namespace pkm
