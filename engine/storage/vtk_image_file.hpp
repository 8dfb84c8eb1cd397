// Fields on a grid of cells as a file that ParaView and VTK read: ImageData of the VTKHDF format. The layout is
// described in README.md.
//
// The cells' centres become the image's points: that is where the fields were evaluated, what contours are drawn from,
// and all that VTK 9.1 reads, which takes arrays of cells for arrays of points.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace pkm {

struct VtkArray {
  std::string name;
  std::string unit;
  std::string meaning;
  std::vector<double> values;  ///< one per cell, the last axis fastest
};

struct VtkAxis {
  std::string name;
  std::string unit;
  double lower = 0, upper = 0;
  std::int64_t cells = 0;
};

struct VtkImage {
  std::string title;
  std::array<VtkAxis, 3> axes;  ///< become VTK's x, y and z
  std::vector<VtkArray> arrays;
  std::vector<VtkArray> numbers;  ///< single values that go with all of it, each a list of one
};

/// Replaces `path` as replace_file does. Throws StorageError.
void write_vtk_image(const std::string& path, const VtkImage& image);

}  // namespace pkm
