#include "experiments/app/cad.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

#include "engine/report/workspace_export.hpp"
#include "experiments/app/print.hpp"

namespace pkm {
namespace {

constexpr std::uint32_t kAround = 24, kRings = 6;  // corners of a circle; rings of a round end, its pole included

Point3<double> scaled(const Point3<double>& v, double by) { return {v[0] * by, v[1] * by, v[2] * by}; }

/// Three unit vectors, right-handed, the last along a segment, or along z where that is a point.
std::array<Point3<double>, 3> frame_along(const Segment<double>& axis) {
  const Point3<double> way = difference(axis.to, axis.from);
  const double length = std::sqrt(dot(way, way));
  const Point3<double> w = length > 0 ? scaled(way, 1 / length) : Point3<double>{0, 0, 1};
  const Point3<double> other = std::fabs(w[0]) < 0.7 ? Point3<double>{1, 0, 0} : Point3<double>{0, 1, 0};
  const Point3<double> across = cross(w, other), u = scaled(across, 1 / std::sqrt(dot(across, across)));
  return {u, cross(w, u), w};
}

/// Rings of corners from one pole to the other, and triangles between neighbours; those at the poles have no area, and
/// STL leaves them out.
void add_capsule(const Capsule<double>& capsule, Isosurface& surface) {
  const auto [u, v, w] = frame_along(capsule.axis);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::uint32_t ring = 0; ring < 2 * kRings; ++ring) {
    const bool end = ring >= kRings;  // which end of the segment
    const double latitude =
        std::numbers::pi / 2 * (static_cast<double>(end ? ring - kRings : ring) / (kRings - 1) - (end ? 0 : 1));
    const double out = ring == 0 || ring == 2 * kRings - 1 ? 0 : capsule.radius * std::cos(latitude);
    const double along = capsule.radius * std::sin(latitude);
    const Point3<double>& centre = end ? capsule.axis.to : capsule.axis.from;
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const double turn = 2 * std::numbers::pi * k / kAround;
      Point3<double>& corner = surface.vertices.emplace_back();
      for (std::size_t i = 0; i < 3; ++i)
        corner[i] = centre[i] + along * w[i] + out * (std::cos(turn) * u[i] + std::sin(turn) * v[i]);
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < 2 * kRings; ++ring)
    for (std::uint32_t k = 0; k < kAround; ++k) {
      const std::uint32_t a = first + ring * kAround + k, b = first + ring * kAround + (k + 1) % kAround;
      surface.triangles.push_back({a, b, b + kAround});
      surface.triangles.push_back({a, b + kAround, a + kAround});
    }
}

/// Each face of two triangles that turn their backs to the box.
void add_box(const SolidBox& box, Isosurface& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (std::size_t bits = 0; bits < 8; ++bits) {
    Point3<double>& corner = surface.vertices.emplace_back(box.centre);
    for (std::size_t i = 0; i < 3; ++i) corner[i] += bits >> i & 1 ? box.half[i] : -box.half[i];
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t u = 1U << (i + 1) % 3, v = 1U << (i + 2) % 3;  // u, v and the axis i are right-handed
    for (const std::uint32_t side : {0U, 1U}) {
      const std::uint32_t a = first + side * (1U << i), b = a + (side ? u : v), c = a + (side ? v : u);
      surface.triangles.push_back({a, b, a + u + v});
      surface.triangles.push_back({a, a + u + v, c});
    }
  }
}

std::string pair(int code, const std::string& value) { return std::to_string(code) + '\n' + value + '\n'; }

/// A point by its group codes: x at `code`, y ten further, z ten further.
std::string point(int code, const Point3<double>& at) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += pair(code + 10 * i, formatted("%.12g", at[static_cast<std::size_t>(i)]));
  return text;
}

/// Letters, digits and underscores, as release 12 has them.
std::string layer_name(std::string part) {
  for (char& c : part)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return part;
}

}  // namespace

std::string links_stl(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title) {
  Isosurface surface;
  for (const PlacedLink& link : links) add_capsule(link.body, surface);
  for (const Obstacle& obstacle : obstacles)
    if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape))
      add_box(*box, surface);
    else
      add_capsule(std::get<Capsule<double>>(obstacle.shape), surface);
  return stl_file(surface, title);
}

std::string links_dxf(const std::vector<PlacedLink>& links, const Obstacles& obstacles) {
  constexpr const char* kMetres = "6";
  std::string text = pair(0, "SECTION") + pair(2, "HEADER") + pair(9, "$ACADVER") + pair(1, "AC1009") +
                     pair(9, "$INSUNITS") + pair(70, kMetres) + pair(0, "ENDSEC") + pair(0, "SECTION") +
                     pair(2, "ENTITIES");
  std::vector<PlacedLink> all = drawn_obstacles(obstacles);
  all.insert(all.begin(), links.begin(), links.end());
  for (const PlacedLink& link : all) {
    const Segment<double>& axis = link.body.axis;
    const bool is_point = axis.from == axis.to;
    text += pair(0, is_point ? "POINT" : "LINE") + pair(8, layer_name(link.part)) + point(10, axis.from);
    if (!is_point) text += point(11, axis.to);
  }
  return text + pair(0, "ENDSEC") + pair(0, "EOF");
}

}  // namespace pkm
