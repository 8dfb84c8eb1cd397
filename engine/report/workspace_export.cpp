#include "engine/report/workspace_export.hpp"

#include <bit>
#include <cmath>

namespace pkm {
namespace {

/// Little-endian, whatever the machine.
void append(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xff);
}
void append(std::string& bytes, const std::array<double, 3>& point) {
  for (const double value : point) append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

}  // namespace

VtkImage vtk_image(const WorkspaceFields& workspace, const MechanismInfo& info, std::span<const double> parameters,
                   const std::string& title) {
  VtkImage image;
  image.title = title;
  image.axes.fill({"none", "1", 0, 1, 1});
  for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
    const WorkspaceAxis& axis = workspace.axes[i];
    image.axes[i] = {axis.name, axis.unit, axis.lower, axis.upper, axis.cells};
  }
  for (const WorkspaceField& field : workspace.fields)
    image.arrays.push_back({field.name, field.unit, field.meaning, field.values});
  for (std::size_t i = 0; i < workspace.held.size(); ++i) {
    const WorkspaceAxis& held = workspace.held[i];
    image.numbers.push_back({"held_" + held.name, held.unit, workspace.held_note[i], {held.lower}});
  }
  image.numbers.push_back({"volume", workspace.volume_unit, "volume of the feasible cells", {workspace.volume}});
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    image.numbers.push_back({"parameter_" + parameter.name, parameter.unit, parameter.meaning, {parameters[i]}});
  }
  return image;
}

CsvTable workspace_table(const WorkspaceFields& workspace) {
  std::vector<std::string> columns;
  for (const auto* const axes : {&workspace.axes, &workspace.held})
    for (const WorkspaceAxis& axis : *axes) columns.push_back(header(axis.name, axis.unit));
  for (const WorkspaceField& field : workspace.fields) columns.push_back(header(field.name, field.unit));
  CsvTable table(columns);
  for (std::size_t cell = 0; cell < workspace.cells(); ++cell) {
    const Pose<double> pose = workspace.pose(cell);
    table.begin_row();
    for (const auto* const axes : {&workspace.axes, &workspace.held})
      for (const WorkspaceAxis& axis : *axes) table.add(pose[static_cast<std::size_t>(axis.coordinate)]);
    for (const WorkspaceField& field : workspace.fields) table.add(field.values[cell]);
  }
  return table;
}

std::string stl_file(const Isosurface& surface, const std::string& title) {
  std::string facets;
  std::uint32_t count = 0;
  for (const auto& triangle : surface.triangles) {
    const auto &p = surface.vertices[triangle[0]], &q = surface.vertices[triangle[1]],
               &r = surface.vertices[triangle[2]];
    const Point3<double> normal = cross(difference(q, p), difference(r, p));
    const double area = std::sqrt(dot(normal, normal));
    if (!(area > 0)) continue;  // along the box's rim, where corners coincide
    append(facets, {normal[0] / area, normal[1] / area, normal[2] / area});
    for (const auto& corner : {p, q, r}) append(facets, corner);
    facets.append(2, '\0');  // no attributes
    ++count;
  }
  std::string bytes = ("pkmopt " + title).substr(0, 80);  // does not begin with "solid", which would mean text
  bytes.resize(80, ' ');
  append(bytes, count);
  return bytes + facets;
}

}  // namespace pkm
