// Triangle meshes of links (capsules) and obstacles.
#pragma once

#include <string>
#include <vector>

#include "engine/export/isosurface.hpp"
#include "engine/geometry/placed_link.hpp"

namespace pkm {

/// The meshes of several bodies as one list of triangles.
struct BodyMeshes {
  struct Body {
    std::string name, part;  ///< names of the link and of its part, as in PlacedLink
    std::size_t end;         ///< index after the last triangle of the body in the common list
  };

  Isosurface all;
  std::vector<Body> bodies;  ///< the bodies, in the order of their triangles
};

/// Triangulates capsules as tubes with hemispherical ends (spheres if the axis is a point), and the faces of boxes.
BodyMeshes triangulate(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
