#include "experiments/app/workspace_outputs.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "engine/export/stl.hpp"
#include "engine/export/vtk_image.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {
namespace {

std::string stl_path(const WorkspaceOutputs& outputs, const Target& target) {
  if (outputs.stl.ends_with(".stl")) return outputs.stl;
  return (std::filesystem::path(outputs.stl) / (target.info().name + "-" + target.file_name + ".stl")).string();
}

}  // namespace

std::string workspace_title(const Target& target) {
  return "workspace of " + target.info().name + ", " + target.words +
         (target.study ? " of study " + target.study->name : "");
}

void create_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw StorageError(folder + ": cannot create the folder (" + error.message() + ")");
}

void add_workspace_outputs(CLI::App& command, WorkspaceOutputs& outputs) {
  add_option(command, "--vtk F.vtkhdf", outputs.vtk,
             "Write all fields of the workspace's cells to this file, for ParaView");
  add_option(command, "--stl DIR|FILE", outputs.stl,
             "Write the workspace's surface into this folder, or to a file F.stl, as binary STL");
  command.add_flag("--force", outputs.force, "Overwrite files that exist");
}

void add_output_by_extension(CLI::App& command, const std::vector<std::pair<std::string, std::string*>>& files) {
  std::vector<std::string> extensions;
  for (const auto& [extension, file] : files) extensions.push_back(extension);
  const auto assign = [files, extensions](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      const auto kind = std::ranges::find_if(files, [&name](const auto& of) { return name.ends_with(of.first); });
      if (kind == files.end())
        throw ConfigError({"", 0, "-o"}, "'" + name + "'", "a file name that ends in one of " + join(extensions));
      if (!kind->second->empty())
        throw ConfigError({"", 0, "-o"}, "'" + name + "' in addition to '" + *kind->second + "'",
                          "one file per extension");
      *kind->second = name;
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "-o,--output", assign, "Write this file; its extension selects the format: " + join(extensions))
      ->type_name("FILE")
      ->allow_extra_args(false);
}

std::vector<std::string> output_files(const WorkspaceOutputs& outputs, const Target& target) {
  std::vector<std::string> files;
  if (!outputs.vtk.empty()) files.push_back(outputs.vtk);
  if (!outputs.stl.empty()) files.push_back(stl_path(outputs, target));
  return files;
}

void check_cell_count(const WorkspacePlan& plan) {
  double cells = 1;
  if (const VoxelOptions* const voxels = plan.voxels())
    for (const std::int64_t along : voxels->cells) cells *= static_cast<double>(along);
  if (cells > kMaxFieldCells)
    throw ConfigError({"", 0, "[workspace] cells"}, shortest(cells) + " cells",
                      "at most " + shortest(kMaxFieldCells) + " to write; 'pkmopt workspace --cells' overrides them");
}

WorkspaceFields compute_fields(const Target& target, const WorkspacePlan& plan, const std::string& mode) {
  try {
    return workspace_fields(*target.mechanism, target.parameters, plan, mode);
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
}

void expect_surface(const WorkspaceOutputs& outputs, const std::vector<std::string>& swept) {
  if (const Unsupported reason = surface_unsupported(swept); reason && !outputs.stl.empty())
    throw ConfigError({"", 0, "--stl"}, *reason);
}

void write_workspace(const WorkspaceOutputs& outputs, const Target& target, const WorkspaceFields& workspace) {
  const std::string title = workspace_title(target);
  const Existing existing = if_forced(outputs.force);
  if (!outputs.vtk.empty()) write_vtk_image(outputs.vtk, workspace, target.info(), target.parameters, title, existing);
  if (outputs.stl.empty()) return;
  const PoseMargin margin(*target.mechanism, target.parameters, target.limits);
  const Isosurface surface = isosurface(workspace, &margin);
  if (surface.triangles.empty()) throw std::runtime_error("the workspace has no surface: no cell is feasible");
  const std::string path = stl_path(outputs, target);
  if (path != outputs.stl) create_folder(outputs.stl);
  write_file(path, stl_file(surface, title), existing);
}

}  // namespace pkm
