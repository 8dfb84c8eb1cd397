#include "experiments/app/cad.hpp"

#include <cctype>

#include "engine/report/workspace_export.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/surfaces.hpp"

namespace pkm {
namespace {

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
  return stl_file(surfaces_of(links, obstacles).all, title);
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
