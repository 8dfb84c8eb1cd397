#include "engine/export/vtk_image.hpp"

#include "engine/core/error.hpp"
#include "engine/storage/hdf5_image.hpp"

namespace pkm {
namespace {

/// Values of a field in the order of VTK, in which the first axis varies fastest.
std::vector<double> first_axis_fastest(const WorkspaceField& field, const std::array<std::int64_t, 3>& cells) {
  const Extent n(cells.begin(), cells.end());
  std::vector<double> reordered(n[0] * n[1] * n[2]);
  if (field.values.size() != reordered.size())
    throw ImageError(field.name + ": has " + std::to_string(field.values.size()) + " values for " +
                     std::to_string(reordered.size()) + " cells");
  std::size_t cell = 0;
  for (std::size_t i = 0; i < n[0]; ++i)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t k = 0; k < n[2]; ++k) reordered[(k * n[1] + j) * n[0] + i] = field.values[cell++];
  return reordered;
}

/// The bytes of a file of the VTKHDF format; docs/reference/study-file/images.md describes its layout.
std::string vtk_image(const WorkspaceFields& workspace, const MechanismInfo& info, std::span<const double> parameters,
                      const std::string& title) {
  const std::string root = "/VTKHDF", points = root + "/PointData";
  // Name of the group for further data; VTK 9.1 would read the group FieldData as point arrays.
  const std::string notes = "/pkmopt";
  const VoxelGrid grid = workspace.grid();
  std::vector<std::int64_t> extent;
  std::vector<double> origin;
  std::vector<std::string> axes(3, "none [1]");
  for (std::size_t i = 0; i < 3; ++i) {
    extent.insert(extent.end(), {0, grid.cells[i] - 1});
    origin.push_back(grid.lower[i] + grid.step[i] / 2);
    if (i < workspace.axes.size()) axes[i] = workspace.axes[i].name + " [" + workspace.axes[i].unit + "]";
  }
  ImageWriter file(0);
  file.group(root, title);
  file.ascii_attribute(root, "Type", "ImageData");
  file.list_attribute<std::int64_t>(root, "Version", {1, 0});
  file.list_attribute(root, "WholeExtent", extent);
  file.list_attribute(root, "Origin", origin);
  file.list_attribute(root, "Spacing", std::vector(grid.step.begin(), grid.step.end()));
  file.list_attribute<double>(root, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});

  file.group(points, "one value per cell, at its centre");
  for (const WorkspaceField& field : workspace.fields)
    file.array(Leaf{points + "/" + field.name, field.meaning, {field.unit}}, first_axis_fastest(field, grid.cells),
               Extent(grid.cells.rbegin(), grid.cells.rend()));
  file.group(notes, "data on the whole image; not read by VTK");
  file.array(Leaf{notes + "/axes", "coordinates along x, y and z of the image"}, axes, {3});
  const auto number = [&](const std::string& name, const std::string& unit, const std::string& meaning, double value) {
    file.array(Leaf{notes + "/" + name, meaning, {unit}}, std::vector{value}, {1});
  };
  for (std::size_t i = 0; i < workspace.fixed.size(); ++i)
    number("fixed_" + workspace.fixed[i].name, workspace.fixed[i].unit, workspace.fixed_note[i],
           workspace.fixed[i].lower);
  number("volume", workspace.volume_unit, "volume of the feasible cells", workspace.volume);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    number("parameter_" + parameter.name, parameter.unit, parameter.meaning, parameters[i]);
  }
  return file.finish();
}

}  // namespace

void write_vtk_image(const std::string& path, const WorkspaceFields& workspace, const MechanismInfo& info,
                     std::span<const double> parameters, const std::string& title, Existing existing) {
  std::string bytes;
  try {
    bytes = vtk_image(workspace, info, parameters, title);
  } catch (const ImageError& error) {
    throw StorageError(path + ": cannot be written (" + error.what() + ")");
  }
  write_file(path, bytes, existing);
}

}  // namespace pkm
