#include "engine/export/vtp.hpp"

#include <algorithm>

#include "engine/core/formatted.hpp"
#include "engine/export/body_meshes.hpp"

namespace pkm {
namespace {

/// An XML element that contains text_of(item) for each item of a list.
template <class List, class Text>
std::string element(const std::string& tag, const std::string& attributes, const List& list, const Text& text_of) {
  std::string text = '<' + tag + ' ' + attributes + " format=\"ascii\">\n";
  for (const auto& item : list) text += text_of(item);
  return text + "</" + tag + ">\n";
}

/// A VTK array of strings: the codes of their characters, with a 0 after each string.
std::string texts(const std::string& name, const std::vector<std::string>& list) {
  const std::string attributes =
      "type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" + std::to_string(list.size()) + '"';
  return element("Array", attributes, list, [](const std::string& text) {
    std::string codes;
    for (const char c : text) codes += std::to_string(static_cast<unsigned char>(c)) + ' ';
    return codes + "0\n";
  });
}

std::string numbers(const std::string& name, const std::vector<std::size_t>& list) {
  return element("DataArray", "type=\"Int32\" Name=\"" + name + '"', list,
                 [](std::size_t number) { return std::to_string(number) + '\n'; });
}

}  // namespace

std::string links_vtp(const std::vector<PlacedLink>& links, const Obstacles& obstacles, const std::string& title) {
  const BodyMeshes surfaces = triangulate(links, obstacles);
  std::vector<std::string> bodies, parts;
  std::vector<std::size_t> body, part, corners, ends;
  for (const BodyMeshes::Body& of : surfaces.bodies) {
    if (std::ranges::find(parts, of.part) == parts.end()) parts.push_back(of.part);
    const auto number = static_cast<std::size_t>(std::ranges::find(parts, of.part) - parts.begin());
    part.resize(of.end, number);
    body.resize(of.end, bodies.size());
    bodies.push_back(of.name);
  }
  for (const auto& triangle : surfaces.all.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
    ends.push_back(corners.size());
  }
  const std::string points =
      element("DataArray", "type=\"Float32\" NumberOfComponents=\"3\"", surfaces.all.vertices, [](const auto& p) {
        std::string line;
        for (const double x : p) line += formatted("%.9g ", x);
        return line + '\n';
      });
  return "<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>\n<FieldData>\n" + texts("title", {title}) +
         texts("bodies", bodies) + texts("parts", parts) + "</FieldData>\n<Piece NumberOfPoints=\"" +
         std::to_string(surfaces.all.vertices.size()) + "\" NumberOfPolys=\"" + std::to_string(ends.size()) +
         "\">\n<CellData Scalars=\"part\">\n" + numbers("body", body) + numbers("part", part) +
         "</CellData>\n<Points>\n" + points + "</Points>\n<Polys>\n" + numbers("connectivity", corners) +
         numbers("offsets", ends) + "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace pkm
