// Export of a workspace to files for other programs, for the commands `export` and `workspace`.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Creates a folder and its parents if it does not exist. Throws StorageError.
void create_folder(const std::string& folder);

/// Text for the titles of files, for example "workspace of 4ppa-2par, the best design of study wide".
std::string workspace_title(const Target& target);

struct WorkspaceOutputs {
  std::string vtk;  ///< name of the VTK file; "": none
  std::string stl;  ///< name of the STL file, F.stl, or of a folder; "": none
  bool force = false;

  bool any() const { return !vtk.empty() || !stl.empty(); }
};

/// Declares --vtk, --stl and --force.
void add_workspace_outputs(CLI::App& command, WorkspaceOutputs& outputs);

/// Declares -o FILE, which sets the option that belongs to the extension of the file's name.
/// @param files  pairs of an extension, such as ".csv", and the variable that holds the value of its option
void add_output_by_extension(CLI::App& command, const std::vector<std::pair<std::string, std::string*>>& files);

/// Names of the VTK and STL files that are to be written for a workspace.
std::vector<std::string> output_files(const WorkspaceOutputs& outputs, const Target& target);

/// Maximum number of cells for which fields are computed: a cell takes about 100 bytes of memory.
inline constexpr double kMaxFieldCells = 1e7;

/// Throws ConfigError if the plan has more than kMaxFieldCells cells.
void check_cell_count(const WorkspacePlan& plan);

/// Computes the fields of the workspace. Throws ConfigError if the mechanism does not support the plan.
WorkspaceFields compute_fields(const Target& target, const WorkspacePlan& plan, const std::string& mode);

/// Throws ConfigError if the surface is requested but does not exist for these coordinates.
/// @param swept  names of the swept coordinates
void expect_surface(const WorkspaceOutputs& outputs, const std::vector<std::string>& swept);

/// Writes the requested VTK and STL files. Throws StorageError, and std::runtime_error if the surface is empty.
void write_workspace(const WorkspaceOutputs& outputs, const Target& target, const WorkspaceFields& workspace);

}  // namespace pkm
