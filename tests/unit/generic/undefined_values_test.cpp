// A constraint whose value is not a finite number is violated, whoever evaluates it: poses, voxels, columns, certified
// bounds of volumes, boxes and motions.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/motion/motion_factories.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

using Kind = PropertyResult::Kind;

/// A square of 1 m, cut by one margin; the coordinates are the joints.
std::shared_ptr<const Mechanism> square(const std::string& formula, const std::string& sweep = "\"x\", \"y\"") {
  return read_mechanism_toml(R"([mechanism]
name = "square"
[parameters]
a = { default = "0.3 m", min = "-1 m", max = "1 m" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
sweep = [)" + sweep + R"(]
box = { x = [0, 1], y = [0, 1] }
[[limb]]
name = "a"
drive = "formula"
joints = { p = "x", q = "y" }
unit = "m"
[[margin]]
name = "cut"
unit = "1"
formula = ")" + formula + "\"\n",
                             "square.toml");
}

bool is_feasible(const Mechanism& mechanism, double x, double y) {
  const MechanismInfo& info = mechanism.info();
  return mechanism.inspect(test::nominal(info), {x, y}, info.modes.front(), no_limits(info)).feasible;
}

/// Share of feasible cells of a grid whose centres are at 0.05, 0.15, .. 0.95.
double share_of_cells(const Mechanism& mechanism, std::int64_t cells = 10) {
  return test::survey(mechanism, test::nominal(mechanism.info()), test::voxels(mechanism.info(), cells)).volume;
}

struct Cut {
  const char* formula;
  double area;  ///< of the square that is left
};

class UndefinedValues : public ::testing::TestWithParam<Cut> {
 protected:
  std::shared_ptr<const Mechanism> mechanism_ = square(GetParam().formula);
  const MechanismInfo& info() const { return mechanism_->info(); }
};

TEST_P(UndefinedValues, ViolateAConstraintInPosesVoxelsColumnsAndBounds) {
  for (double x = 0.05; x < 1; x += 0.1)
    EXPECT_EQ(is_feasible(*mechanism_, x, 0.5), x > 0.3 && GetParam().area > 0) << "at x = " << x;
  EXPECT_NEAR(share_of_cells(*mechanism_), GetParam().area, 1e-12);
  const WorkspaceResult<double> columns = test::survey(*mechanism_, test::nominal(info()), test::columns(info()));
  EXPECT_NEAR(columns.volume, GetParam().area, 1e-8);
  const VolumeBounds bounds =
      mechanism_->bounds()->volume(test::nominal(info()), test::columns(info()), "", {.gap = 1e-2, .max_boxes = 2000});
  EXPECT_LE(bounds.lower, GetParam().area + 1e-12);
  EXPECT_GE(bounds.upper, GetParam().area - 1e-12);
  EXPECT_LE(bounds.lower, columns.volume + 1e-8);
  EXPECT_GE(bounds.upper, columns.volume - 1e-8);
}

TEST_P(UndefinedValues, HoldNowhereForCertain) {
  const WorkspacePlan plan = test::columns(info());
  const auto box =
      mechanism_->bounds()->solid(test::nominal(info()), plan, "", {{{0.1, 0.2}, {0.4, 0.6}}}, {.max_boxes = 1000});
  EXPECT_NE(box.feasible.kind, Kind::holds);
}

INSTANTIATE_TEST_SUITE_P(All, UndefinedValues,
                         ::testing::Values(Cut{"1/max(0, x - a) - 1", 0.7},              // by x alone
                                           Cut{"(y + 2)/max(0, x - a) - 1", 0.7},        // a line in y
                                           Cut{"y^2 + 1/max(0, x - a) - 1", 0.7},        // convex in y
                                           Cut{"1/max(0, x - a) + 9 - y^2", 0.7},        // concave in y
                                           Cut{"sin(y)/10 + 1/max(0, x - a) - 1", 0.7},  // no polynomial in y
                                           Cut{"1 + 1/(x - x)", 0}, Cut{"1 + y/(x - x)", 0}),
                         [](const auto& each) { return "Cut" + std::to_string(each.index); });

TEST(UndefinedValues, AtAPoleViolateAConstraint) {
  const auto mechanism = square("1/(x - 0.5)^2 - 1");
  const MechanismInfo& info = mechanism->info();
  EXPECT_FALSE(is_feasible(*mechanism, 0.5, 0.5));
  EXPECT_TRUE(is_feasible(*mechanism, 0.499, 0.5));
  EXPECT_NEAR(share_of_cells(*mechanism, 5), 0.8, 1e-12);  // the middle ones of five are at the pole
  EXPECT_NEAR(test::survey(*mechanism, test::nominal(info), test::columns(info)).volume, 1, 1e-8);
  const WorkspacePlan plan = test::columns(info);
  const auto certificate = [&](double from, double to) {
    return mechanism->bounds()
        ->solid(test::nominal(info), plan, "", {{{from, to}, {0.4, 0.6}}}, {.max_boxes = 1000})
        .feasible.kind;
  };
  EXPECT_NE(certificate(0.49, 0.51), Kind::holds);
  EXPECT_EQ(certificate(0.51, 0.55), Kind::holds);
  const auto motion = [&](double centre) {
    const auto swing = oscillation(space_axes(info.coordinates), Pose<double>{centre, 0.5}, 0.01, 1, 1);
    return mechanism->bounds()
        ->motion(test::nominal(info), no_limits(info), "", *swing, {.max_boxes = 1000})
        .feasible.kind;
  };
  EXPECT_NE(motion(0.5), Kind::holds);
  EXPECT_EQ(motion(0.3), Kind::holds);
}

}  // namespace
}  // namespace pkm
