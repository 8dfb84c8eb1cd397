// The surfaces of links and obstacles as triangles.
#pragma once

#include <string>
#include <vector>

#include "engine/model/placed_link.hpp"
#include "engine/report/isosurface.hpp"

namespace pkm {

/// A tube with round ends, a ball where a link is a point; of a box its faces.
struct Surfaces {
  struct Body {
    std::string name, part;  ///< as PlacedLink has them
    std::size_t end;         ///< number of triangles up to its last
  };

  Isosurface all;
  std::vector<Body> bodies;  ///< in the order of the triangles
};

Surfaces surfaces_of(const std::vector<PlacedLink>& links, const Obstacles& obstacles);

}  // namespace pkm
