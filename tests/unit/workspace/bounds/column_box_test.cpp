// One box of the outer coordinates: which columns over it are feasible, and enclosures of the volume.
#include "engine/workspace/bounds/column_box.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

constexpr ColumnGrid kUnit{0, 1};

/// A box over x in [from, to], with z in [0, 1] and all constraints open.
ColumnBox box_of(const Constraints& all, double from, double to) {
  ColumnBox box{.side = {{{from, to}}}};
  OpenConstraints open;
  for (std::size_t k = 0; k < all.size(); ++k) open.set(k);
  box.open.push_back({0, ColumnGrid::kSteps, open});
  return box;
}
ColumnBox examined(const Constraints& all, double from, double to, std::vector<Step>* steps = nullptr,
                   bool skipped = false) {
  const ColumnPruner pruner(all, kUnit, {{{0, 1}}});
  ColumnPruner::Scratch scratch = pruner.make_scratch();
  ColumnBox box = box_of(all, from, to);
  pruner.prune(box, scratch, steps, skipped);
  return box;
}
void expect_holds(const Interval& found, double value) {
  EXPECT_LE(found.lower, value);
  EXPECT_GE(found.upper, value);
}

TEST(ColumnGrid, RoundDownAndUpToGridPoints) {
  const ColumnGrid grid{-0.3, 1.1};
  EXPECT_EQ(grid.at(0), -0.3);
  EXPECT_EQ(grid.at(ColumnGrid::kSteps), 1.1);
  for (const double height : {-0.3, -0.1, 0.123456789, 1.0, 1.1}) {
    const std::int64_t below = grid.step_below(height, 0, ColumnGrid::kSteps),
                       above = grid.step_above(height, 0, ColumnGrid::kSteps);
    EXPECT_LE(grid.at(below), height);
    EXPECT_GE(grid.at(above), height);
    EXPECT_LE(above - below, 2) << height;
  }
  EXPECT_EQ(grid.step_below(-5, 10, 20), 10) << "the lowest possible";
  EXPECT_EQ(grid.step_above(5, 10, 20), 20);
  expect_holds(grid.length(0, ColumnGrid::kSteps), 1.4);
}

TEST(ColumnBox, IsFeasibleOrInfeasibleAsAWhole) {
  const ColumnBox inside = examined(conditions("xz", {"3 - x - z", "x + z + 1"}), 0.25, 0.5);
  EXPECT_TRUE(inside.open.empty());
  expect_holds(inside.volume, 0.25);
  EXPECT_LT(inside.volume.width(), 1e-14);
  std::vector<Step> steps;
  const ColumnBox outside = examined(conditions("xz", {"3 - x - z", "x - z - 2"}), 0.25, 0.5, &steps);
  EXPECT_TRUE(outside.open.empty());
  EXPECT_EQ(outside.volume.upper, 0);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].kind, Step::Kind::satisfied);
  EXPECT_EQ(steps[1].kind, Step::Kind::violated);
  EXPECT_EQ(steps[1].constraint, 1u);
}

TEST(ColumnBox, EnclosesTheAreaUnderACircle) {
  const Constraints disc = conditions("xz", {"1 - x^2 - z^2"});
  const auto integral = [](double x) { return (std::asin(x) + x * std::sqrt(1 - x * x)) / 2; };
  for (const auto& [from, to] : {std::pair(0.0, 1.0), {0.0, 0.5}, {0.5, 0.75}, {0.75, 1.0}, {0.99, 1.0}})
    expect_holds(examined(disc, from, to).volume, integral(to) - integral(from));
  // 1/2 <= x <= 3/4 is worked out in engine/workspace/bounds/README.md
  const Interval worked = examined(disc, 0.5, 0.75).volume;
  EXPECT_NEAR(worked.lower, 0.25 * 0.7602, 2e-5);
  EXPECT_NEAR(worked.upper, 0.25 * 0.8010, 2e-5);
}

/// Linear terms of the root have the mean 0 over the box: the mean length has an error of second order.
TEST(ColumnBox, HasAnErrorOfThirdOrderInTheWidth) {
  const Constraints disc = conditions("xz", {"1 - x^2 - z^2"});
  double before = examined(disc, 0.3, 0.4).volume.width();
  for (const double width : {0.05, 0.025, 0.0125}) {
    const double now = examined(disc, 0.35 - width / 2, 0.35 + width / 2).volume.width();
    EXPECT_GT(before / now, 7) << width;
    before = now;
  }
}

/// Constraints of z alone cut the same interval out of every column: 1/4 < z < 1/2, found to the grid of z.
TEST(ColumnBox, FindsRootsThatDoNotMove) {
  const ColumnBox box = examined(conditions("xz", {"(z - 0.25)*(0.5 - z)"}), 0, 1);
  expect_holds(box.volume, 0.25);
  EXPECT_LT(box.volume.width(), 1e-6);
}

TEST(ColumnBox, StaysOpenIfSkipped) {
  std::vector<Step> steps;
  const ColumnBox box = examined(conditions("xz", {"3 - x - z"}), 0.25, 0.5, &steps, true);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].kind, Step::Kind::open);
  EXPECT_EQ(box.open.size(), 1u);
  EXPECT_EQ(box.volume.lower, 0);
  EXPECT_GE(box.volume.upper, 0.25);
}

/// The halves of a box start with its open segments, and together they have no more volume than allowed by it.
TEST(ColumnBox, HalvesAreContinuedFromTheWhole) {
  const Constraints disc = conditions("xz", {"1 - x^2 - z^2"});
  const ColumnPruner pruner(disc, kUnit, {{{0, 1}}});
  ColumnPruner::Scratch scratch = pruner.make_scratch();
  ColumnBox whole = box_of(disc, 0.2, 0.6), lower, upper;
  pruner.prune(whole, scratch, nullptr, false);
  lower = upper = whole;
  lower.side[0][1] = upper.side[0][0] = 0.4;
  pruner.prune(lower, scratch, nullptr, false);
  pruner.prune(upper, scratch, nullptr, false);
  const auto integral = [](double x) { return (std::asin(x) + x * std::sqrt(1 - x * x)) / 2; };
  expect_holds(lower.volume, integral(0.4) - integral(0.2));
  expect_holds(upper.volume, integral(0.6) - integral(0.4));
  EXPECT_LT((lower.volume + upper.volume).width(), whole.volume.width() / 3);
}

}  // namespace
}  // namespace pkm::bounds
