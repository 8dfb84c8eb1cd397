// VTKHDF images, read back with the readers of VTK and h5py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/export/vtk_image.hpp"
#include "tests/unit/storage/python_output.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

/// 2 x 3 x 4 cells; the margin of a cell is its number divided by 3.
WorkspaceFields sample() {
  WorkspaceFields fields;
  fields.axes = {{0, "x", "m", -1, 1, 2}, {2, "z", "m", 0, 3, 3}, {3, "theta", "rad", -0.5, 1.5, 4}};
  fields.fixed = {{1, "y", "m", 1.25, 1.25, 0}};
  fields.fixed_note = {"default value"};
  fields.fields = {{"feasible", "1", "1 or 0", {}}, {"margin", "m", "minimum margin", {}}};
  for (int cell = 0; cell < 24; ++cell) {
    fields.fields[0].values.push_back(cell % 2);
    fields.fields[1].values.push_back(cell == 5 ? test::odd_nan() : cell / 3.0);
  }
  fields.volume = 0.75;
  fields.volume_unit = "m^2 rad";
  return fields;
}

void write(const std::string& path, const WorkspaceFields& fields) {
  MechanismInfo info;
  info.parameters.push_back({.name = "a", .unit = "m", .meaning = "a length"});
  write_vtk_image(path, fields, info, std::array{0.25}, "made up", Existing::refused);
}

TEST(VtkImage, VtkReadsGridAndFields) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOHDF' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9 is missing";
  const test::Folder folder;
  const WorkspaceFields fields = sample();
  write(folder / "image.vtkhdf", fields);
  std::string expected = "dimensions 2 3 4\nspacing 1.0 1.0 0.5\norigin -0.5 0.5 -0.25\n";
  for (const WorkspaceField& field : fields.fields) {
    std::vector<double> reordered;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 2; ++i) reordered.push_back(field.values[(i * 3 + j) * 4 + k]);
    expected += field.name + test::bits(reordered) + "\n";
  }
  EXPECT_EQ(test::python_output("read_vtk.py", "'" + folder / "image.vtkhdf" + "'"), expected);
}

TEST(VtkImage, H5pyReadsUnitsAndMetadata) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "python3-h5py is missing";
  const test::Folder folder;
  write(folder / "image.vtkhdf", sample());
  const std::string read =
      "import h5py; f = h5py.File('" + folder / "image.vtkhdf" +
      "'); p = f['VTKHDF/PointData']; print(p['margin'].shape, p['margin'].attrs['unit'], f['VTKHDF'].attrs['Type'], "
      "f['pkmopt/axes'].asstr()[:].tolist(), f['pkmopt/fixed_y'][0], f['pkmopt/volume'][0], "
      "f['pkmopt/parameter_a'][0], "
      "f['VTKHDF'].attrs['description'])";
  EXPECT_EQ(test::output_of("/usr/bin/python3 -c \"" + read + "\""),
            "(4, 3, 2) m b'ImageData' ['x [m]', 'z [m]', 'theta [rad]'] 1.25 0.75 0.25 made up\n");
}

TEST(VtkImage, FailedWriteKeepsTheExistingFile) {
  const test::Folder folder;
  WorkspaceFields wrong = sample();
  wrong.fields[1].values.pop_back();
  test::spill(folder / "image.vtkhdf", "old");
  EXPECT_THAT(test::storage_error([&] { write(folder / "image.vtkhdf", wrong); }),
              HasSubstr("image.vtkhdf: cannot be written (margin: has 23 values for 24 cells)"));
  EXPECT_EQ(test::slurp(folder / "image.vtkhdf"), "old");
  EXPECT_THAT(test::storage_error([&] { write(folder / "none/image.vtkhdf", sample()); }),
              HasSubstr("because no file can be created in its folder"));
}

}  // namespace
}  // namespace pkm
