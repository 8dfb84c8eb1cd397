#include "engine/export/body_meshes.hpp"

#include <cmath>
#include <numbers>

namespace pkm {
namespace {

// Number of vertices of a circle, and number of circles of a hemisphere, its pole included.
constexpr std::uint32_t kAround = 24, kRings = 6;

Point3<double> scaled(const Point3<double>& v, double by) { return {v[0] * by, v[1] * by, v[2] * by}; }

/// Right-handed orthonormal frame whose third vector is along the segment, or along z if the segment is a point.
std::array<Point3<double>, 3> frame_along(const Segment<double>& axis) {
  const Point3<double> along = difference(axis.to, axis.from);
  const double length = std::sqrt(dot(along, along));
  const Point3<double> w = length > 0 ? scaled(along, 1 / length) : Point3<double>{0, 0, 1};
  const Point3<double> other = std::fabs(w[0]) < 0.7 ? Point3<double>{1, 0, 0} : Point3<double>{0, 1, 0};
  const Point3<double> across = cross(w, other), u = scaled(across, 1 / std::sqrt(dot(across, across)));
  return {u, cross(w, u), w};
}

/// Adds circles of vertices from one pole of the capsule to the other, and triangles between neighbouring circles,
/// except for the degenerate triangles at the poles.
void add_shape(const Capsule<double>& capsule, Isosurface& surface) {
  const auto [u, v, w] = frame_along(capsule.axis);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::uint32_t ring = 0; ring < 2 * kRings; ++ring) {
    // true: the circle is on the hemisphere at axis.to; false: on the hemisphere at axis.from.
    const bool end = ring >= kRings;
    const double latitude =
        std::numbers::pi / 2 * (static_cast<double>(end ? ring - kRings : ring) / (kRings - 1) - (end ? 0 : 1));
    const double out = ring == 0 || ring == 2 * kRings - 1 ? 0 : capsule.radius * std::cos(latitude);
    const double along = capsule.radius * std::sin(latitude);
    const Point3<double>& centre = end ? capsule.axis.to : capsule.axis.from;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const double angle = 2 * std::numbers::pi * k / kAround;
      Point3<double>& corner = surface.vertices.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        corner[i] = centre[i] + along * w[i] + out * (std::cos(angle) * u[i] + std::sin(angle) * v[i]);
    }
  }
  const auto add = [&surface, &corner = surface.vertices](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (corner[a] != corner[b] && corner[b] != corner[c] && corner[c] != corner[a])
      surface.triangles.push_back({a, b, c});
  };
  for (std::uint32_t ring = 0; ring + 1 < 2 * kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t a = first + ring * kAround + k, b = first + ring * kAround + (k + 1) % kAround;
      add(a, b, b + kAround);
      add(a, b + kAround, a + kAround);
    }
}

/// Adds two triangles for each face of a box, oriented outwards.
void add_shape(const SolidBox& box, Isosurface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::size_t bits = 0; bits < 8; ++bits) {
    Point3<double>& corner = surface.vertices.emplace_back(box.centre);
    for (std::size_t i = 0; i < 3; ++i) corner[i] += bits >> i & 1 ? box.half[i] : -box.half[i];
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    // u and v are the bits of the other two axes in the vertex numbers, chosen such that (u, v, i) is a right-handed
    // frame.
    const std::uint32_t u = 1U << (i + 1) % 3, v = 1U << (i + 2) % 3;
    for (const std::uint32_t side : {0U, 1U}) {
      const std::uint32_t a = first + side * (1U << i), b = a + (side ? u : v), c = a + (side ? v : u);
      surface.triangles.push_back({a, b, a + u + v});
      surface.triangles.push_back({a, a + u + v, c});
    }
  }
}

}  // namespace

BodyMeshes triangulate(const std::vector<PlacedLink>& links, const Obstacles& obstacles) {
  BodyMeshes found;
  const auto add = [&found](const std::string& name, const std::string& part, const auto& shape) {
    add_shape(shape, found.all);
    found.bodies.push_back({name, part, found.all.triangles.size()});
  };
  for (const PlacedLink& link : links) add(link.name, link.part, link.body);
  for (const Obstacle& obstacle : obstacles)
    std::visit([&](const auto& shape) { add(obstacle.name, kObstaclePart, shape); }, obstacle.shape);
  return found;
}

}  // namespace pkm
