#include "engine/export/dxf.hpp"

#include <cctype>

#include "engine/core/formatted.hpp"

namespace pkm {
namespace {

/// A group of a DXF file: its code and its value, each on a line of its own.
std::string group(int code, const std::string& value) { return std::to_string(code) + '\n' + value + '\n'; }

/// The three groups of a point: x has the group code `code`, y has code + 10, and z has code + 20.
std::string point(int code, const Point3<double>& at) {
  std::string text;
  for (int i = 0; i < 3; ++i) text += group(code + 10 * i, formatted("%.12g", at[static_cast<std::size_t>(i)]));
  return text;
}

/// Converts the name of a part to a valid layer name: release 12 of DXF allows only letters, digits and underscores.
std::string layer_name(std::string part) {
  for (char& c : part)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return part;
}

}  // namespace

std::string links_dxf(const std::vector<PlacedLink>& links, const Obstacles& obstacles) {
  constexpr const char* kMetres = "6";
  std::string text = group(0, "SECTION") + group(2, "HEADER") + group(9, "$ACADVER") + group(1, "AC1009") +
                     group(9, "$INSUNITS") + group(70, kMetres) + group(0, "ENDSEC") + group(0, "SECTION") +
                     group(2, "ENTITIES");
  std::vector<PlacedLink> all = drawn_obstacles(obstacles);
  all.insert(all.begin(), links.begin(), links.end());
  for (const PlacedLink& link : all) {
    const Segment<double>& axis = link.body.axis;
    const bool is_point = axis.from == axis.to;
    text += group(0, is_point ? "POINT" : "LINE") + group(8, layer_name(link.part)) + point(10, axis.from);
    if (!is_point) text += point(11, axis.to);
  }
  return text + group(0, "ENDSEC") + group(0, "EOF");
}

}  // namespace pkm
