#include "engine/storage/vtk_image_file.hpp"

#include "engine/core/error.hpp"
#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/safe_file.hpp"

namespace pkm {
namespace {

const std::string kRoot = "/VTKHDF", kPoints = kRoot + "/PointData";
const std::string kNotes = "/pkmopt";  // VTK 9.1 takes FieldData of an image for arrays of points

/// VTK runs along the first axis fastest.
std::vector<double> first_axis_fastest(const VtkArray& array, const Extent& n) {
  std::vector<double> turned(n[0] * n[1] * n[2]);
  if (array.values.size() != turned.size())
    throw ImageError(array.name + ": has " + std::to_string(array.values.size()) + " values for " +
                     std::to_string(turned.size()) + " cells");
  std::size_t cell = 0;
  for (std::size_t i = 0; i < n[0]; ++i)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t k = 0; k < n[2]; ++k) turned[(k * n[1] + j) * n[0] + i] = array.values[cell++];
  return turned;
}

std::string image_bytes(const VtkImage& image) {
  ImageWriter file(0);
  file.group(kRoot, image.title);
  file.ascii_attribute(kRoot, "Type", "ImageData");
  file.list_attribute<std::int64_t>(kRoot, "Version", {1, 0});
  std::vector<std::int64_t> extent;
  std::vector<double> origin, spacing;
  Extent cells;
  for (const VtkAxis& axis : image.axes) {
    extent.insert(extent.end(), {0, axis.cells - 1});
    spacing.push_back((axis.upper - axis.lower) / static_cast<double>(axis.cells));
    origin.push_back(axis.lower + spacing.back() / 2);
    cells.push_back(static_cast<std::size_t>(axis.cells));
  }
  file.list_attribute(kRoot, "WholeExtent", extent);
  file.list_attribute(kRoot, "Origin", origin);
  file.list_attribute(kRoot, "Spacing", spacing);
  file.list_attribute<double>(kRoot, "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});

  file.group(kPoints, "one value per cell, at its centre");
  for (const VtkArray& array : image.arrays)
    file.array(Leaf{kPoints + "/" + array.name, array.meaning, {array.unit}, {}}, first_axis_fastest(array, cells),
               {cells[2], cells[1], cells[0]});
  file.group(kNotes, "what goes with all cells; not read by VTK");
  std::vector<std::string> axes;
  for (const VtkAxis& axis : image.axes) axes.push_back(axis.name + " [" + axis.unit + "]");
  file.array(Leaf{kNotes + "/axes", "coordinates along x, y and z of the image", {"1"}, {}}, axes, {3});
  for (const VtkArray& number : image.numbers)
    file.array(Leaf{kNotes + "/" + number.name, number.meaning, {number.unit}, {}}, number.values,
               {number.values.size()});
  return file.finish();
}

}  // namespace

void write_vtk_image(const std::string& path, const VtkImage& image) {
  std::string bytes;
  try {
    bytes = image_bytes(image);
  } catch (const ImageError& error) {
    throw StorageError(path + ": cannot be written (" + error.what() + ")");
  }
  replace_file(path, bytes);
}

}  // namespace pkm
