// Isosurfaces with known enclosed volumes. Tests in tests/unit/contracts check for every mechanism that the surface is
// closed and oriented.
#include "engine/export/isosurface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/catalogue.hpp"
#include "tests/unit/export/enclosed_volume.hpp"

namespace pkm {
namespace {

/// Cells of [-1, 1]^3 whose margin is a function of x, y and z.
template <class Margin>
WorkspaceFields synthetic(std::int64_t cells, const Margin& margin) {
  WorkspaceFields made;
  const char* const names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) made.axes.push_back({i, names[i], "m", -1, 1, cells});
  made.fixed = {{3, "phi", "rad", 0, 0, 0}};
  made.fields = {{"feasible", "1", "", {}}, {"margin", "m", "", {}}};
  const VoxelGrid grid = made.grid();
  for (std::int64_t i = 0; i < cells; ++i)
    for (std::int64_t j = 0; j < cells; ++j)
      for (std::int64_t k = 0; k < cells; ++k) {
        const double value = margin(grid.centre(0, i), grid.centre(1, j), grid.centre(2, k));
        made.fields[0].values.push_back(value > 0 ? 1 : 0);
        made.fields[1].values.push_back(value);
      }
  return made;
}

TEST(Isosurface, VolumeOfASphereConvergesQuadratically) {
  constexpr double kRadius = 0.8, kVolume = 4 * std::numbers::pi / 3 * kRadius * kRadius * kRadius;
  const auto sphere = [](double x, double y, double z) { return kRadius - std::hypot(x, y, z); };
  const double coarse = std::fabs(test::enclosed_volume(isosurface(synthetic(12, sphere))) / kVolume - 1),
               fine = std::fabs(test::enclosed_volume(isosurface(synthetic(48, sphere))) / kVolume - 1);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, 0.003);  // second order: 16 times smaller on 4 times as many cells per axis
  for (const auto& [x, y, z] : isosurface(synthetic(48, sphere)).vertices)
    EXPECT_NEAR(std::hypot(x, y, z), kRadius, 0.002);
}

TEST(Isosurface, IsClosedOnTheFacesOfTheBox) {
  const Isosurface all = isosurface(synthetic(3, [](double, double, double) { return 0.3; }));
  EXPECT_NEAR(test::enclosed_volume(all), 8, 1e-12);
  for (const auto& at : all.vertices) EXPECT_TRUE(std::ranges::any_of(at, [](double c) { return std::fabs(c) == 1; }));
  const Isosurface half = isosurface(synthetic(8, [](double x, double, double) { return 0.1 - x; }));
  EXPECT_NEAR(test::enclosed_volume(half), 1.1 * 4, 1e-12);
}

TEST(Isosurface, IsEmptyWithoutFeasibleCells) {
  const Isosurface none = isosurface(synthetic(4, [](double, double, double) { return -1.0; }));
  EXPECT_TRUE(none.triangles.empty());
  EXPECT_TRUE(none.vertices.empty());
  EXPECT_EQ(test::enclosed_volume(none), 0);
}

TEST(Isosurface, NeedsThreeSweptCoordinates) {
  WorkspaceFields plane = synthetic(2, [](double, double, double) { return 1.0; });
  EXPECT_FALSE(surface_unsupported(names_of(plane.axes)));
  plane.axes.pop_back();
  EXPECT_EQ(surface_unsupported(names_of(plane.axes)),
            "a surface needs three swept coordinates; this workspace sweeps x, y");
  EXPECT_THROW(isosurface(plane), std::invalid_argument);
}

TEST(Isosurface, EnclosesASingleFeasibleCell) {
  const auto made = synthetic(5, [](double x, double y, double z) { return std::hypot(x, y, z) < 0.1 ? 0.2 : -0.2; });
  const Isosurface one = isosurface(made);
  ASSERT_FALSE(one.triangles.empty());
  EXPECT_GT(test::enclosed_volume(one), 0);
  for (const auto& point : one.inside)  // the centre of the feasible cell
    for (const double c : point) EXPECT_NEAR(c, 0, 1e-12);
}

}  // namespace
}  // namespace pkm
