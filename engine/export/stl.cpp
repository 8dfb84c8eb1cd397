#include "engine/export/stl.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "engine/export/body_meshes.hpp"

namespace pkm {
namespace {

/// Appends the bytes of a word in little-endian order, which does not depend on the machine.
void append(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xff);
}
void append(std::string& bytes, const std::array<double, 3>& point) {
  for (const double value : point) append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

}  // namespace

std::string stl_file(const Isosurface& surface, const std::string& title) {
  std::string facets;
  std::uint32_t count = 0;
  for (const auto& triangle : surface.triangles) {
    const auto &p = surface.vertices[triangle[0]], &q = surface.vertices[triangle[1]],
               &r = surface.vertices[triangle[2]];
    const Point3<double> normal = cross(difference(q, p), difference(r, p));
    const double area = std::sqrt(dot(normal, normal));
    if (!(area > 0)) continue;  // degenerate triangles on edges of the box, where vertices coincide, are omitted
    append(facets, {normal[0] / area, normal[1] / area, normal[2] / area});
    for (const auto& vertex : {p, q, r}) append(facets, vertex);
    facets.append(2, '\0');  // number of attribute bytes of the triangle: 0
    ++count;
  }
  // The header of 80 bytes must not begin with "solid", which would mark an ASCII file.
  std::string bytes = ("pkmopt " + title).substr(0, 80);
  bytes.resize(80, ' ');
  append(bytes, count);
  return bytes + facets;
}

std::string links_stl(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title) {
  return stl_file(triangulate(links, obstacles).all, title);
}

}  // namespace pkm
