// Triangle meshes of links (capsules) and obstacles.
#pragma once

#include <string>
#include <vector>

#include "engine/export/isosurface.hpp"
#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// Meshes of several bodies, in one list of triangles.
struct BodyMeshes {
  struct Body {
    std::string name, part;  ///< see PlacedLink
    std::size_t end;         ///< index after the last triangle of the body
  };

  Isosurface all;
  std::vector<Body> bodies;  ///< in the order of the triangles
};

/// Triangulates capsules as tubes with hemispherical ends (spheres if the axis is a point), and the faces of boxes.
BodyMeshes triangulate(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
