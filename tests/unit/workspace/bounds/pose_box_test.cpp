// Whether constraints hold and matrices have full rank at every pose of a box.
#include "engine/workspace/bounds/pose_box.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

using Kind = PropertyResult::Kind;
using Box = std::vector<std::array<double, 2>>;

PoseCertificate certify(const std::vector<std::string>& constraints, const Box& ranges, std::size_t boxes = 100'000) {
  return bounds::certify(conditions(std::string("xyz").substr(0, ranges.size()), constraints), nullptr, {ranges},
                         {.max_boxes = boxes});
}
/// The rank of a matrix of formulas in x and y.
PropertyResult rank(std::size_t columns, const std::vector<std::string>& entries, const Box& ranges,
                    std::size_t boxes = 10'000) {
  Formulas formulas("xy");
  NamedMatrix matrix{.name = "J", .rows = entries.size() / columns, .columns = columns, .entries = {}};
  for (const std::string& entry : entries) matrix.entries.push_back(formulas.read(entry));
  const Matrices matrices(formulas.graph, {matrix}, formulas.positions, formulas.inputs());
  const PoseCertificate found = bounds::certify(formulas.conditions({"1"}), &matrices, {ranges}, {.max_boxes = boxes});
  EXPECT_EQ(found.feasible.kind, Kind::holds);
  return found.regular;
}

TEST(PoseBox, IsFeasible) {
  EXPECT_EQ(certify({"1 - x^2 - y^2"}, {{0, 0.7}, {0, 0.7}}).feasible.kind, Kind::holds);  // 0.98 at the corner
  // Decreasing, 0.05 at x = 1: one corner decides. Bounds of the terms, and the mean value form, are negative.
  const PoseCertificate corner = certify({"0.8 - x + x^2/4"}, {{0, 1}});
  EXPECT_EQ(corner.feasible.kind, Kind::holds);
  EXPECT_EQ(corner.boxes, 1u);
  // x^2 + y^2 - 2 x y + 1e-4 = (x - y)^2 + 1e-4, positive by a little everywhere
  EXPECT_EQ(certify({"x^2 + y^2 - 2*x*y + 1e-4"}, {{-1, 1}, {-1, 1}}).feasible.kind, Kind::holds);
  EXPECT_EQ(certify({"2 - sin(3*x)*cos(5*y) - z"}, {{-4, 4}, {-4, 4}, {0, 0.99}}).feasible.kind, Kind::holds);
}

TEST(PoseBox, HasAnInfeasiblePose) {
  const auto found = certify({"1.001 - sin(x)", "1 - x^2 - y^2"}, {{0, 0.71}, {0, 0.71}}).feasible;  // 1.008
  ASSERT_EQ(found.kind, Kind::fails);
  EXPECT_EQ(found.detail, "1 - x^2 - y^2");
  ASSERT_TRUE(found.pose);
  EXPECT_GT(std::hypot((*found.pose)[0], (*found.pose)[1]), 1);
  EXPECT_EQ(certify({"x^2 + y^2 - 1e-6"}, {{-1, 1}, {-1, 1}}).boxes, 1u) << "the centre is infeasible";
  EXPECT_EQ(certify({"sqrt(x)"}, {{-1e-3, 1}}).feasible.kind, Kind::fails) << "undefined";
}

TEST(PoseBox, StaysUndecidedWhereAConstraintIsZero) {
  const PoseCertificate found = certify({"x^2 + y^2 - 2*x*y"}, {{-1, 1}, {-0.9, 1}}, 1000);  // (x - y)^2
  EXPECT_EQ(found.feasible.kind, Kind::undecided);
  ASSERT_TRUE(found.feasible.pose);
  EXPECT_NEAR((*found.feasible.pose)[0], (*found.feasible.pose)[1], 0.3);
  EXPECT_EQ(found.regular.kind, Kind::not_examined);
}

TEST(PoseBox, MatricesHaveFullRank) {
  EXPECT_EQ(rank(2, {"1", "x", "0", "1"}, {{-9, 9}, {0, 1}}).kind, Kind::holds);
  // a rotation, and [x, 1; 1, x], whose determinant x^2 - 1 is zero at -1 and 1 only
  EXPECT_EQ(rank(2, {"cos(x)", "-sin(x)", "sin(x)", "cos(x)"}, {{-4, 4}, {0, 1}}).kind, Kind::holds);
  EXPECT_EQ(rank(2, {"x", "1", "1", "x"}, {{-0.99, 0.99}, {0, 1}}).kind, Kind::holds);
  // three rows, two of which may vanish, but not at the same pose
  EXPECT_EQ(rank(2, {"1", "0", "0", "x", "0", "1 - x"}, {{-2, 2}, {0, 1}}).kind, Kind::holds);
}

TEST(PoseBox, MatricesAreSingularSomewhere) {
  const PropertyResult sign = rank(2, {"x", "1", "1", "x"}, {{0.3, 1.9}, {0, 1}});
  ASSERT_EQ(sign.kind, Kind::fails);
  EXPECT_EQ(sign.detail, "J, where the determinant changes its sign");
  EXPECT_NEAR((*sign.pose)[0], 1, 1e-12);
  const PropertyResult middle = rank(2, {"x", "0", "0", "1"}, {{-1, 1}, {0, 1}});
  ASSERT_EQ(middle.kind, Kind::fails);
  EXPECT_EQ((*middle.pose)[0], 0);
  const PropertyResult tall = rank(2, {"1", "0", "0", "x", "0", "x"}, {{-1, 1}, {0, 1}});
  ASSERT_EQ(tall.kind, Kind::fails);
  EXPECT_EQ(tall.detail, "J, to working precision");
}

/// The determinant changes its sign where an entry jumps, or at a pole: there is no singular pose.
TEST(PoseBox, SignChangesOfDiscontinuousDeterminantsAreNoSingularities) {
  for (const char* const entry : {"x < 0.1 ? -1 : 1", "1/(x - 0.1)"})
    EXPECT_EQ(rank(2, {entry, "0", "0", "1"}, {{-1, 1}, {0, 1}}, 1000).kind, Kind::undecided) << entry;
}

TEST(PoseBox, RankIsNotExaminedIfAPoseIsInfeasible) {
  Formulas formulas("x");
  const Matrices matrices(formulas.graph, {{"J", 1, 1, {formulas.read("x")}}}, formulas.positions, formulas.inputs());
  const Box ranges = {{-1, 1}};
  const PoseCertificate found = bounds::certify(formulas.conditions({"x"}), &matrices, {ranges}, {});
  EXPECT_EQ(found.feasible.kind, Kind::fails);
  EXPECT_EQ(found.regular.kind, Kind::not_examined);
}

/// x + y <= c holds on the inscribed disc of radius 1 about (1, 1) exactly if c >= 2 + sqrt(2), and on its box if c
/// >= 4.
TEST(PoseBox, OnlyTheBallsOfASolidCount) {
  const auto on_disc = [](double excess) {
    const std::string constraint = std::to_string(2 + std::sqrt(2) + excess) + " - x - y";
    return bounds::certify(conditions("xy", {constraint}), nullptr, {{{0, 2}, {0, 2}}, {{0, 1}}}, {}).feasible;
  };
  EXPECT_EQ(on_disc(1e-3).kind, Kind::holds);
  const PropertyResult fails = on_disc(-1e-3);
  ASSERT_EQ(fails.kind, Kind::fails);
  EXPECT_LE(std::hypot((*fails.pose)[0] - 1, (*fails.pose)[1] - 1), 1);
  EXPECT_GT((*fails.pose)[0] + (*fails.pose)[1], 2 + std::sqrt(2) - 1e-3);
  // A cylinder along y and a sphere: the constraint is violated outside of them only.
  const PoseSolid cylinder = {{{-1, 1}, {0, 3}, {-1, 1}}, {{0, 2}}}, sphere = {{{-1, 1}, {0, 2}, {-1, 1}}, {{0, 1, 2}}};
  EXPECT_EQ(bounds::certify(conditions("xyz", {"1.001 - x^2 - z^2"}), nullptr, cylinder, {}).feasible.kind,
            Kind::holds);
  EXPECT_EQ(bounds::certify(conditions("xyz", {"1 - x^2 - (y - 0.1)^2 - z^2"}), nullptr, cylinder, {}).feasible.kind,
            Kind::fails);
  EXPECT_EQ(bounds::certify(conditions("xyz", {"1.001 - x^2 - (y - 1)^2 - z^2"}), nullptr, sphere, {}).feasible.kind,
            Kind::holds);
}

TEST(PoseBox, SingularitiesOutsideOfTheBallsDoNotCount) {
  Formulas formulas("xy");
  const auto regular_at = [&](double pole) {
    const Matrices matrices(formulas.graph, {{"J", 1, 1, {formulas.read(std::to_string(pole) + " - x - y")}}},
                            formulas.positions, formulas.inputs());
    return bounds::certify(formulas.conditions({"1"}), &matrices, {{{-1, 1}, {-1, 1}}, {{0, 1}}}, {}).regular;
  };
  EXPECT_EQ(regular_at(1.42).kind, Kind::holds);
  const PropertyResult singular = regular_at(1.4);
  ASSERT_EQ(singular.kind, Kind::fails);
  EXPECT_NEAR((*singular.pose)[0] + (*singular.pose)[1], 1.4, 1e-9);
  EXPECT_LE(std::hypot((*singular.pose)[0], (*singular.pose)[1]), 1 + 1e-12);
}

}  // namespace
}  // namespace pkm::bounds
