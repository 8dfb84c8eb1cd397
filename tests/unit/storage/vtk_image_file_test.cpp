// What VTK's own reader finds in our images.
#include "engine/storage/vtk_image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/storage/python_output.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using testing::HasSubstr;

/// 2 x 3 x 4 cells; values count the cells.
VtkImage sample() {
  VtkImage image{"made up", {{{"x", "m", -1, 1, 2}, {"z", "m", 0, 3, 3}, {"theta", "rad", -0.5, 1.5, 4}}}, {}, {}};
  image.arrays = {{"feasible", "1", "1 or 0", {}}, {"margin", "m", "least margin", {}}};
  for (int cell = 0; cell < 24; ++cell) {
    image.arrays[0].values.push_back(cell % 2);
    image.arrays[1].values.push_back(cell == 5 ? test::odd_nan() : cell / 3.0);
  }
  image.numbers = {{"held_y", "m", "the middle", {1.25}}};
  return image;
}

TEST(VtkImageFile, IsReadByVtk) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOHDF' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-vtk9 is missing";
  const test::Folder folder;
  const VtkImage image = sample();
  write_vtk_image(folder / "image.vtkhdf", image);
  std::string expected = "dimensions 2 3 4\nspacing 1.0 1.0 0.5\norigin -0.5 0.5 -0.25\n";
  for (const VtkArray& array : image.arrays) {
    std::vector<double> turned;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 2; ++i) turned.push_back(array.values[(i * 3 + j) * 4 + k]);
    expected += array.name + test::bits(turned) + "\n";
  }
  EXPECT_EQ(test::python_output("read_vtk.py", "'" + folder / "image.vtkhdf" + "'"), expected);
}

TEST(VtkImageFile, SaysUnitsToH5py) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "python3-h5py is missing";
  const test::Folder folder;
  write_vtk_image(folder / "image.vtkhdf", sample());
  const std::string read =
      "import h5py; f = h5py.File('" + folder / "image.vtkhdf" +
      "'); p = f['VTKHDF/PointData']; print(p['margin'].shape, p['margin'].attrs['unit'], f['VTKHDF'].attrs['Type'], "
      "f['pkmopt/axes'].asstr()[:].tolist(), f['pkmopt/held_y'][0], f['VTKHDF'].attrs['description'])";
  EXPECT_EQ(test::output_of("/usr/bin/python3 -c \"" + read + "\""),
            "(4, 3, 2) m b'ImageData' ['x [m]', 'z [m]', 'theta [rad]'] 1.25 made up\n");
}

TEST(VtkImageFile, ThatCannotBeWrittenLeavesWhatWasThere) {
  const test::Folder folder;
  VtkImage wrong = sample();
  wrong.arrays[1].values.pop_back();
  test::spill(folder / "image.vtkhdf", "old");
  EXPECT_THAT(test::storage_error([&] { write_vtk_image(folder / "image.vtkhdf", wrong); }),
              HasSubstr("image.vtkhdf: cannot be written (margin: has 23 values for 24 cells)"));
  EXPECT_EQ(test::slurp(folder / "image.vtkhdf"), "old");
  EXPECT_THAT(test::storage_error([&] { write_vtk_image(folder / "none/image.vtkhdf", sample()); }),
              HasSubstr("its folder does not take a new file"));
}

}  // namespace
}  // namespace pkm
