// Surfaces whose volume is known. Closedness and orientation are held to for every mechanism in tests/unit/contracts.
#include "engine/report/isosurface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/catalogue.hpp"
#include "tests/unit/report/enclosed_volume.hpp"

namespace pkm {
namespace {

/// Cells of [-1, 1]^3 with a margin given by a formula.
template <class Margin>
WorkspaceFields made_up(std::int64_t cells, const Margin& margin) {
  WorkspaceFields made;
  const char* const names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) made.axes.push_back({i, names[i], "m", -1, 1, cells});
  made.held = {{3, "phi", "rad", 0, 0, 0}};
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

TEST(Isosurface, OfASphereApproachesItsVolume) {
  constexpr double kRadius = 0.8, kVolume = 4 * std::numbers::pi / 3 * kRadius * kRadius * kRadius;
  const auto sphere = [](double x, double y, double z) { return kRadius - std::hypot(x, y, z); };
  const double coarse = std::fabs(test::enclosed_volume(isosurface(made_up(12, sphere))) / kVolume - 1),
               fine = std::fabs(test::enclosed_volume(isosurface(made_up(48, sphere))) / kVolume - 1);
  EXPECT_LT(coarse, 0.05);
  EXPECT_LT(fine, 0.003);  // of second order
  for (const auto& [x, y, z] : isosurface(made_up(48, sphere)).vertices)
    EXPECT_NEAR(std::hypot(x, y, z), kRadius, 0.002);
}

TEST(Isosurface, EndsOnTheBox) {
  const Isosurface all = isosurface(made_up(3, [](double, double, double) { return 0.3; }));
  EXPECT_NEAR(test::enclosed_volume(all), 8, 1e-12);
  for (const auto& at : all.vertices) EXPECT_TRUE(std::ranges::any_of(at, [](double c) { return std::fabs(c) == 1; }));
  const Isosurface half = isosurface(made_up(8, [](double x, double, double) { return 0.1 - x; }));
  EXPECT_NEAR(test::enclosed_volume(half), 1.1 * 4, 1e-12);
}

TEST(Isosurface, OfNothingIsEmpty) {
  const Isosurface none = isosurface(made_up(4, [](double, double, double) { return -1.0; }));
  EXPECT_TRUE(none.triangles.empty());
  EXPECT_TRUE(none.vertices.empty());
  EXPECT_EQ(test::enclosed_volume(none), 0);
}

TEST(Isosurface, IsRefusedWhereLessThanThreeCoordinatesAreSwept) {
  WorkspaceFields plane = made_up(2, [](double, double, double) { return 1.0; });
  EXPECT_FALSE(refuse_surface(names_of(plane.axes)));
  plane.axes.pop_back();
  EXPECT_EQ(refuse_surface(names_of(plane.axes)),
            "a surface needs three swept coordinates, and this workspace sweeps x, y");
  EXPECT_THROW(isosurface(plane), std::invalid_argument);
}

TEST(Isosurface, OfASingleCellIsClosedAroundIt) {
  const auto made = made_up(5, [](double x, double y, double z) { return std::hypot(x, y, z) < 0.1 ? 0.2 : -0.2; });
  const Isosurface one = isosurface(made);
  ASSERT_FALSE(one.triangles.empty());
  EXPECT_GT(test::enclosed_volume(one), 0);
  for (const auto& place : one.inside)  // the centre of the one in the middle
    for (const double c : place) EXPECT_NEAR(c, 0, 1e-12);
}

}  // namespace
}  // namespace pkm
