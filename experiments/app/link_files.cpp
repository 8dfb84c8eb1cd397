#include "experiments/app/link_files.hpp"

#include "engine/storage/safe_file.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/cad.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {

void add_link_files(CLI::App& command, LinkFiles& files) {
  add_option(command, "--stl FILE", files.stl, "Write the links' surfaces to this file, as binary STL in m");
  add_option(command, "--dxf FILE", files.dxf, "Write the links' axes to this file, as DXF in m");
  add_output_by_ending(command, {{".dxf", &files.dxf}, {".stl", &files.stl}});
  command.add_flag("--force", files.force, "Overwrite files that exist");
}

void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out) {
  const Existing existing = if_forced(files.force);
  check_outputs({files.stl, files.dxf}, target.files, existing);
  if (files.stl.empty() && files.dxf.empty()) return;
  const MechanismInfo& info = target.info();
  const Links& mechanism = needed(target.mechanism->links(), "a file of links", "links", info);
  const std::vector<PlacedLink> links = mechanism.place(target.parameters, pose, mode);
  if (links.empty()) return;  // the pose does not assemble, which is told
  const std::string title = "links of " + info.name + ", " + target.words;
  const auto write = [&](const std::string& file, const std::string& bytes) {
    write_file(file, bytes, existing);
    out.json["files"].push_back(file);
    out.text += "\nwrote " + file + '\n';
  };
  if (!files.stl.empty()) write(files.stl, links_stl(links, title));
  if (!files.dxf.empty()) write(files.dxf, links_dxf(links));
}

}  // namespace pkm
