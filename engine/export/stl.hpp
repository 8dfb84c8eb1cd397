// Writer for triangle meshes in the binary STL format.
#pragma once

#include <string>
#include <vector>

#include "engine/export/isosurface.hpp"
#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// The content of a binary STL file. Its coordinates are those of the workspace's axes in SI units, so rotations are in
/// rad next to lengths in m.
std::string stl_file(const Isosurface& surface, const std::string& title);

/// The content of a binary STL file with the surfaces of links and obstacles [m]: a capsule (a tube with hemispherical
/// ends) for each link, a sphere for a link whose ends coincide.
std::string links_stl(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title);

}  // namespace pkm
