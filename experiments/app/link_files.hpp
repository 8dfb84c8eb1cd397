// The options --stl, --dxf and --vtk, which write a mechanism's links at one pose to files, and those of
// model_files.hpp.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/app/model_files.hpp"

namespace pkm {

/// Names of the requested files; "": not requested.
struct LinkFiles {
  std::string stl, dxf, vtk;
  ModelFiles model;
  bool force = false;
};
/// Declares --stl, --dxf, --vtk, --urdf, --sdf, --mjcf, -o and --force.
/// @param more  further files for -o, by extension
void add_link_files(CLI::App& command, LinkFiles& files,
                    const std::vector<std::pair<std::string, std::string*>>& more = {});

/// Writes the requested files; none if the mechanism cannot be assembled at the pose. For a mechanism without a
/// multibody model, the URDF file contains its links with fixed joints. Throws ConfigError.
void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out);

}  // namespace pkm
