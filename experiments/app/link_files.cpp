#include "experiments/app/link_files.hpp"

#include "engine/export/dxf.hpp"
#include "engine/export/stl.hpp"
#include "engine/export/urdf.hpp"
#include "engine/export/vtp.hpp"
#include "engine/generic/multibody_model.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

/// The links at a pose displaced by a small step, in the positive direction of all coordinates or, if the mechanism
/// cannot be assembled there, in the negative direction; empty if it cannot be assembled at either pose.
std::vector<PlacedLink> displaced_links(const Links& mechanism, const Target& target, const std::string& mode,
                                        const Pose<double>& pose) {
  // Step of each coordinate [m or rad]. It is divided by 1, 2, 3, .. for the coordinates in their order, so that the
  // effects of two coordinates do not cancel.
  constexpr double kStep = 1e-4;
  for (const double step : {kStep, -kStep}) {
    Pose<double> moved = pose;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += step / static_cast<double>(i + 1);
    auto links = mechanism.place(target.parameters, moved, mode);
    if (!links.empty()) return links;
  }
  return {};
}

}  // namespace

void add_link_files(CLI::App& command, LinkFiles& files,
                    const std::vector<std::pair<std::string, std::string*>>& more) {
  add_option(command, "--stl FILE", files.stl, "Write the surfaces of the links as binary STL in m");
  add_option(command, "--dxf FILE", files.dxf, "Write the axes of the links as DXF in m");
  add_option(command, "--vtk FILE", files.vtk, "Write the surfaces of the links as VTK PolyData in m (.vtp)");
  add_model_options(command, files.model);
  std::vector<std::pair<std::string, std::string*>> all = {
      {".dxf", &files.dxf}, {".stl", &files.stl}, {".vtp", &files.vtk}};
  const auto models = extensions_of(files.model);
  all.insert(all.end(), models.begin(), models.end());
  all.insert(all.end(), more.begin(), more.end());
  add_output_by_extension(command, all);
  command.add_flag("--force", files.force, "Overwrite existing files");
}

void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out) {
  const Existing existing = if_forced(files.force);
  std::vector<std::string> names = model_file_names(files.model);
  for (const std::string& file : {files.stl, files.dxf, files.vtk})
    if (!file.empty()) names.push_back(file);
  if (names.empty()) return;
  check_outputs(names, target.files, existing);
  const MechanismInfo& info = target.info();
  if (!target.mechanism->inspect(target.parameters, pose, mode, no_limits(info)).assembles)
    return;  // nothing is written; the caller reports why the pose cannot be assembled
  const auto write = [&](const std::string& file, const std::string& bytes) {
    write_file(file, bytes, existing);
    out.json["files"].push_back(file);
    out.text += "wrote " + file + '\n';
  };
  out.text += '\n';
  const std::string title = "links of " + info.name + ", " + target.words;
  const auto links = [&]() -> const Links& {
    return require_capability(target.mechanism->links(), "a file of links", "links", info);
  };
  const auto placed = [&] { return links().place(target.parameters, pose, mode); };
  if (!files.stl.empty()) write(files.stl, links_stl(placed(), target.limits.obstacles, title));
  if (!files.dxf.empty()) write(files.dxf, links_dxf(placed(), target.limits.obstacles));
  if (!files.vtk.empty()) write(files.vtk, links_vtp(placed(), target.limits.obstacles, title));
  ModelFiles models = files.model;
  if (const std::string why = generic::why_no_multibody_model(*target.mechanism);
      !models.urdf.empty() && !why.empty()) {
    write(models.urdf, links_urdf(placed(), displaced_links(links(), target, mode, pose), info.name,
                                  title + ", at " + axes_text(info.coordinates, pose)));
    out.text += "Its joints are fixed, because the mechanism has no model for simulation: " + why + '\n';
    models.urdf.clear();
  }
  if (!models.any()) return;
  for (const auto& [file, text] : model_texts(models, target, mode, pose, info.name + ", " + target.words))
    write(file, text);
}

}  // namespace pkm
