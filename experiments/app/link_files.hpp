// The options --stl, --dxf, --urdf and --vtk: files of a mechanism's links at one pose.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Names of the requested files; "": not requested.
struct LinkFiles {
  std::string stl, dxf, urdf, vtk;
  bool force = false;
};
/// Declares --stl, --dxf, --urdf, --vtk, -o and --force.
/// @param more  further files for -o, by extension
void add_link_files(CLI::App& command, LinkFiles& files,
                    const std::vector<std::pair<std::string, std::string*>>& more = {});

/// Writes the requested files; none if the pose does not assemble. Throws ConfigError.
void write_links(const Target& target, const std::string& mode, const Pose<double>& pose, const LinkFiles& files,
                 Printout& out);

}  // namespace pkm
