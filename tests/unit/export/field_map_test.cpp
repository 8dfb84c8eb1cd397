// Filled contours of fields with known regions, and the pictures of maps.
#include "engine/export/field_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/export/contour_labels.hpp"
#include "engine/export/picture.hpp"
#include "engine/export/simplify_line.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Squares of the unit square [0, 1]^2, without those whose centre is in the hole.
template <class Hole>
SliceMesh squares(std::size_t cells, const Hole& in_hole) {
  SliceMesh mesh{{WorkspaceAxis{0, "x", "m", 0, 1, 1}, WorkspaceAxis{1, "y", "m", 0, 1, 1}}, {}, {}};
  const auto node = [&](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  const auto at = [&](double k) { return k / static_cast<double>(cells); };
  for (std::size_t j = 0; j <= cells; ++j)
    for (std::size_t i = 0; i <= cells; ++i)
      mesh.points.push_back({at(static_cast<double>(i)), at(static_cast<double>(j))});
  for (std::size_t j = 0; j < cells; ++j)
    for (std::size_t i = 0; i < cells; ++i)
      if (!in_hole(at(static_cast<double>(i) + 0.5), at(static_cast<double>(j) + 0.5)))
        mesh.polygons.push_back({node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
  return mesh;
}

SliceMesh squares(std::size_t cells) {
  return squares(cells, [](double, double) { return false; });
}

template <class Field>
std::vector<double> values_of(const SliceMesh& mesh, const Field& field) {
  std::vector<double> values;
  for (const auto& [x, y] : mesh.points) values.push_back(field(x, y));
  return values;
}

TEST(FieldMap, LinearFieldHasStraightContoursAndExactAreas) {
  const SliceMesh mesh = squares(7);
  const auto field = [](double x, double y) { return x + 2 * y; };
  const FieldMap map = map_field(mesh, values_of(mesh, field), std::vector{0.4, 1.0, 2.0, 2.5});
  EXPECT_NEAR(map.defined.area, 1, 1e-14);
  EXPECT_TRUE(map.undefined.loops.empty());
  ASSERT_EQ(map.regions.size(), 4u);
  // Triangles and trapezia between the lines x + 2 y = level and the sides of the square.
  EXPECT_NEAR(map.regions[0].area, 1 - 0.4 * 0.2 / 2, 1e-14);
  EXPECT_NEAR(map.regions[1].area, 0.75, 1e-14);
  EXPECT_NEAR(map.regions[2].area, 0.25, 1e-14);
  EXPECT_NEAR(map.regions[3].area, 0.5 * 0.25 / 2, 1e-14);
  for (const FieldRegion& region : map.regions) {
    EXPECT_EQ(region.loops.size(), 1u);
    ASSERT_EQ(region.contours.size(), 1u);
  }
  for (const auto& [x, y] : map.regions[0].contours[0]) EXPECT_NEAR(field(x, y), 0.4, 1e-14);
  EXPECT_EQ(simplify_line(map.regions[0].contours[0], 1e-9).size(), 2u);
}

TEST(FieldMap, RegionsEndAtAHole) {
  const SliceMesh mesh =
      squares(8, [](double x, double y) { return std::fabs(x - 0.5) < 0.25 && std::fabs(y - 0.5) < 0.25; });
  const FieldMap map = map_field(mesh, values_of(mesh, [](double x, double) { return x; }), std::vector{0.5});
  EXPECT_NEAR(map.defined.area, 0.75, 1e-14);
  EXPECT_EQ(map.defined.loops.size(), 2u);
  EXPECT_NEAR(map.regions[0].area, 0.375, 1e-14);
  EXPECT_EQ(map.regions[0].loops.size(), 1u);     // around half of the hole
  EXPECT_EQ(map.regions[0].contours.size(), 2u);  // below the hole and above it
}

TEST(FieldMap, ClosedContourConvergesToACircle) {
  const auto radius = [](double x, double y) { return std::hypot(x - 0.5, y - 0.5); };
  const SliceMesh mesh = squares(100);
  const FieldMap map = map_field(mesh, values_of(mesh, radius), std::vector{0.3});
  ASSERT_EQ(map.regions[0].contours.size(), 1u);
  EXPECT_EQ(map.regions[0].contours[0].front(), map.regions[0].contours[0].back());
  EXPECT_EQ(map.regions[0].loops.size(), 2u);
  EXPECT_NEAR(map.regions[0].area, 1 - std::numbers::pi * 0.09, 1e-4);
}

TEST(FieldMap, UndefinedVerticesAreLeftOut) {
  const SliceMesh mesh = squares(10);
  std::vector<double> values = values_of(mesh, [](double x, double) { return x; });
  values[5 * 11 + 5] = kNan;  // the node in the middle belongs to four squares
  values[0] = std::numeric_limits<double>::infinity();
  const FieldMap map = map_field(mesh, values, std::vector{0.5});
  EXPECT_NEAR(map.undefined.area, 0.05, 1e-14);
  EXPECT_NEAR(map.defined.area, 0.95, 1e-14);
  EXPECT_NEAR(map.regions[0].area, 0.5 - 0.02, 1e-14);
  const ContourLevels levels = contour_levels(values);
  EXPECT_EQ(levels.minimum, 0);
  EXPECT_EQ(levels.maximum, 1);
  EXPECT_TRUE(contour_levels(std::vector{kNan}).values.empty());
}

TEST(ContourLevels, AreRound) {
  const auto levels = [](std::vector<double> values) { return contour_levels(values).values; };
  EXPECT_THAT(levels({0.02, 0.69}),
              ElementsAre(0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7));
  EXPECT_THAT(levels({-30, 50}), ElementsAre(-30, -20, -10, 0, 10, 20, 30, 40, 50));
  EXPECT_THAT(levels({3, 3 + 1e-12}), ElementsAre(3)) << "constant up to rounding errors";
  for (double upper = 1.001; upper < 11; upper *= 1.07) {
    const std::size_t intervals = levels({1, upper}).size() - 1;
    EXPECT_GE(intervals, 7u);
    EXPECT_LE(intervals, 19u);
  }
}

TEST(ContourLevels, ScaleIsOpenAtAPole) {
  std::vector<double> values;
  for (int k = 1; k <= 1000; ++k) values.push_back(10.0 / k);
  const ContourLevels levels = contour_levels(values);
  EXPECT_TRUE(levels.open_above);
  EXPECT_FALSE(levels.open_below);
  EXPECT_EQ(levels.maximum, 10);
  EXPECT_LT(levels.values.back(), 1);
  EXPECT_EQ(levels.thresholds().size(), levels.values.size() - 1);
}

TEST(PictureOfAMap, HasLabelsUnitAndRange) {
  const SliceMesh mesh = squares(20);
  const auto field = [](double x, double) { return 1e-4 * x; };
  const std::string um = svg_file(draw_map(mesh, {"gap", "m", "width of the gap", values_of(mesh, field)}, {"title"}));
  for (const char* const part : {">title<", ">gap: width of the gap<", ">from 0 um to 100 um<", ">gap [um]<", ">0<",
                                 ">50<", ">100<", "fill=\"#440154\"", "fill=\"#fde725\"", "rotate(-90 "})
    EXPECT_THAT(um, HasSubstr(part));
  EXPECT_THAT(um, Not(HasSubstr("undefined")));
  const auto angle = [](double x, double y) { return x < 0.2 ? kNan : y; };
  const std::string deg = svg_file(draw_map(mesh, {"turn", "rad", "angle", values_of(mesh, angle)}, {"title"}));
  for (const char* const part : {">turn [deg]<", ">from 0 deg to 57.3 deg<", ">undefined<", "fill=\"#c8c8c8\""})
    EXPECT_THAT(deg, HasSubstr(part));
  const std::string none = svg_file(draw_map(mesh, {"f", "1", "", std::vector(mesh.points.size(), kNan)}, {"title"}));
  EXPECT_THAT(none, HasSubstr(">undefined at all feasible poses<"));
  EXPECT_THAT(svg_file(draw_map({mesh.axes, {}, {}}, {"f", "1", "", {}}, {"title"})), HasSubstr(">no feasible pose<"));
  const std::string same = svg_file(draw_map(mesh, {"f", "1", "", std::vector(mesh.points.size(), 2.0)}, {"title"}));
  EXPECT_THAT(same, HasSubstr(">from 2 to 2<"));
  EXPECT_LT(um.size(), 1000000u);
}

TEST(ContourLabel, InterruptsTheLineAwayFromOthers) {
  const std::vector<PlanePoint> line = {{0, 0}, {50, 50}, {100, 100}};
  const auto label = place_label(line, 20, {}, {});
  ASSERT_TRUE(label);
  EXPECT_NEAR(label->at[0], 50, 1e-9);
  EXPECT_NEAR(label->angle, -45, 1e-9);  // y points downwards
  EXPECT_EQ(label->before.front(), line.front());
  EXPECT_EQ(label->after.back(), line.back());
  EXPECT_LT(label->before.back()[0], 50 - 10 / std::numbers::sqrt2);
  const auto moved = place_label(line, 20, {{50, 50}}, {});
  ASSERT_TRUE(moved);
  EXPECT_GE(std::hypot(moved->at[0] - 50, moved->at[1] - 50), 44);
  EXPECT_FALSE(place_label(line, 200, {}, {}));
  EXPECT_FALSE(place_label({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}, 20, {}, {}));
}

}  // namespace
}  // namespace pkm
