#include "experiments/app/link_files.hpp"

#include "engine/export/dxf.hpp"
#include "engine/export/stl.hpp"
#include "engine/export/urdf.hpp"
#include "engine/export/vtp.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

/// The links at a pose displaced by a small step in the positive or, if that does not assemble, in the negative
/// direction; empty if neither assembles.
std::vector<PlacedLink> displaced_links(const Links& mechanism, const Target& target, const std::string& mode,
                                        const Pose<double>& pose) {
  // [m or rad], divided by 1, 2, 3, .. for the coordinates, so that the effects of two coordinates do not cancel
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
  add_option(command, "--urdf FILE", files.urdf, "Write the links as URDF, a tree with fixed joints");
  add_option(command, "--vtk FILE", files.vtk, "Write the surfaces of the links as VTK PolyData in m (.vtp)");
  std::vector<std::pair<std::string, std::string*>> all = {
      {".dxf", &files.dxf}, {".stl", &files.stl}, {".urdf", &files.urdf}, {".vtp", &files.vtk}};
  all.insert(all.end(), more.begin(), more.end());
  add_output_by_extension(command, all);
  command.add_flag("--force", files.force, "Overwrite existing files");
}

void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out) {
  const Existing existing = if_forced(files.force);
  check_outputs({files.stl, files.dxf, files.urdf, files.vtk}, target.files, existing);
  if (files.stl.empty() && files.dxf.empty() && files.urdf.empty() && files.vtk.empty()) return;
  const MechanismInfo& info = target.info();
  const Links& mechanism = require_capability(target.mechanism->links(), "a file of links", "links", info);
  const std::vector<PlacedLink> links = mechanism.place(target.parameters, pose, mode);
  if (links.empty()) return;  // the pose does not assemble, which the caller reports
  const std::string title = "links of " + info.name + ", " + target.words;
  const auto write = [&](const std::string& file, const std::string& bytes) {
    write_file(file, bytes, existing);
    out.json["files"].push_back(file);
    out.text += "wrote " + file + '\n';
  };
  out.text += '\n';
  if (!files.stl.empty()) write(files.stl, links_stl(links, target.limits.obstacles, title));
  if (!files.dxf.empty()) write(files.dxf, links_dxf(links, target.limits.obstacles));
  if (!files.urdf.empty())
    write(files.urdf, links_urdf(links, displaced_links(mechanism, target, mode, pose), info.name,
                                 title + ", at " + axes_text(info.coordinates, pose)));
  if (!files.vtk.empty()) write(files.vtk, links_vtp(links, target.limits.obstacles, title));
}

}  // namespace pkm
