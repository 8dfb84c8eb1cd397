// The options --stl, --dxf and --vtk, which write a mechanism's links at one pose to files, and those of
// model_files.hpp.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/app/model_files.hpp"

namespace pkm {

/// Names of the files to be written; "" for a file that is not requested.
struct LinkFiles {
  std::string stl, dxf, vtk;
  ModelFiles model;
  bool force = false;
};
/// Declares --stl, --dxf, --vtk, --urdf, --sdf, --mjcf, -o and --force.
/// @param more  pairs of a further file extension that -o accepts, and the variable that receives the file name
void add_link_files(CLI::App& command, LinkFiles& files,
                    const std::vector<std::pair<std::string, std::string*>>& more = {});

/// Writes the requested files, but none if the mechanism cannot be assembled at the pose. If the mechanism has no
/// multibody model, the URDF file contains its links with fixed joints. Throws ConfigError.
void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out);

}  // namespace pkm
