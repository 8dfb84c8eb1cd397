// Balance of forces on boxes of poses: comparison with the drive forces at sampled poses of the boxes.
#include "engine/workspace/bounds/force_balance.hpp"

#include <random>

#include <gtest/gtest.h>

#include "engine/dynamics/force_distribution.hpp"
#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

using Result = ForceBalance::Result;

constexpr double kMinimum = 5, kMaximum = 200, kWeight = 30, kForce = 10;
constexpr std::array<std::array<double, 2>, 4> kAnchors = {{{-1, 2}, {1.2, 1.9}, {0.9, 0}, {-1.1, 0.1}}};

/// A point that cables carry in the plane of x and y.
struct PointOnCables {
  std::size_t cables;
  bool has_slide;  ///< a drive without limits pulls along x, in addition to the cables
  bool is_closure = false;

  std::size_t joints() const { return cables + (has_slide ? 1 : 0); }

  ForceBalance balance() const {
    Formulas formulas("xy");
    BalanceFormulas of{.joints = joints(),
                       .coordinates = 2,
                       .is_limited = std::vector<bool>(cables, true),
                       .half_axes = {is_closure ? 0U : 1U},
                       .is_closure = is_closure,
                       .all = {}};
    for (std::size_t j = 0; j < cables; ++j) {
      const std::string x = "(x - (" + std::to_string(kAnchors[j][0]) + "))",
                        y = "(y - (" + std::to_string(kAnchors[j][1]) + "))",
                        length = "sqrt(" + x + "^2 + " + y + "^2)";
      of.all.push_back(formulas.read(x + "/" + length));
      of.all.push_back(formulas.read(y + "/" + length));
    }
    if (has_slide) {
      of.is_limited.push_back(false);
      of.all.push_back(formulas.read("1"));
      of.all.push_back(formulas.read("0"));
    }
    const auto number = [&](double value) { of.all.push_back(formulas.read(std::to_string(value))); };
    for (std::size_t j = 0; j < 2 * cables; ++j) number(j % 2 == 0 ? kMinimum : kMaximum);
    if (!is_closure) {
      number(0);  // the drives balance the weight: -J^T t = (0, weight) + u (force, 0)
      number(kWeight);
      number(kForce);
      number(0);
    }
    return {formulas.graph, of, formulas.positions, formulas.inputs()};
  }

  bool is_balanced_at(double x, double y) const {
    AxisMatrix<double> J(joints(), 2);
    DriveLimits limits = no_drive_limits(joints());
    for (std::size_t j = 0; j < cables; ++j) {
      const double dx = x - kAnchors[j][0], dy = y - kAnchors[j][1], length = std::hypot(dx, dy);
      J(j, 0) = dx / length;
      J(j, 1) = dy / length;
      limits.lower[j] = -kMaximum;
      limits.upper[j] = -kMinimum;
    }
    if (has_slide) J(cables, 0) = 1;
    if (is_closure) {  // the tensions are proportional to the minors of J^T
      const auto minor = [&](std::size_t a, std::size_t b) { return J(a, 0) * J(b, 1) - J(b, 0) * J(a, 1); };
      const double t0 = minor(1, 2), t1 = -minor(0, 2), t2 = minor(0, 1);
      return t0 * t1 > 0 && t1 * t2 > 0;
    }
    for (const double force : {-kForce, kForce}) {
      AxisVector<double> load(2);
      load[0] = force;
      load[1] = kWeight;
      if (!distribute_forces(J, load, limits)) return false;
    }
    return true;
  }
};

/// Numbers of poses around which a box has each result.
struct Counts {
  int balanced = 0, not_balanced = 0, undecided = 0;
};

/// Finds the largest box around each of some random poses that has a result. No sample of the box contradicts it; an
/// enclosure that is too narrow would give a larger box, beyond the boundary of the workspace.
Counts examine_largest_boxes(const PointOnCables& robot) {
  const ForceBalance balance = robot.balance();
  std::mt19937 random(7);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  Counts counts;
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<double, 2> centre = {number(-1.5, 1.5), number(-0.5, 2.2)},
                                size = {number(0.1, 1), number(0.1, 1)};
    const auto box = [&](double scale) {
      IntervalBox sides{};
      for (std::size_t i = 0; i < 2; ++i) sides[i] = {centre[i] - scale * size[i], centre[i] + scale * size[i]};
      return sides;
    };
    double from = 0.01, to = 1;
    const Result result = balance.examine(box(from));
    if (result == Result::undecided) {
      ++counts.undecided;
      continue;
    }
    ++(result == Result::balanced ? counts.balanced : counts.not_balanced);
    for (int step = 0; step < 16; ++step) {
      const double scale = (from + to) / 2;
      (balance.examine(box(scale)) == result ? from : to) = scale;
    }
    const IntervalBox largest = box(from);
    for (int sample = 0; sample < 30; ++sample) {
      // vertices, where a wrong result shows first, and poses between them
      const double u = sample < 4 ? sample % 2 : number(0, 1), v = sample < 4 ? sample / 2 : number(0, 1);
      const double x = std::lerp(largest[0].lower, largest[0].upper, u),
                   y = std::lerp(largest[1].lower, largest[1].upper, v);
      EXPECT_EQ(robot.is_balanced_at(x, y), result == Result::balanced) << x << ' ' << y << " of trial " << trial;
    }
  }
  return counts;
}

TEST(ForceBalance, LargestBoxesAgreeWithForcesAtTheirPoses) {
  const Counts redundant = examine_largest_boxes({4, false});
  EXPECT_GT(redundant.balanced, 40);
  EXPECT_GT(redundant.not_balanced, 40);
  EXPECT_LT(redundant.undecided, 20);
  const Counts suspended = examine_largest_boxes({2, false});
  EXPECT_GT(suspended.balanced, 20);
  EXPECT_GT(suspended.not_balanced, 60);
  EXPECT_LT(suspended.undecided, 20);
}

TEST(ForceBalance, DrivesWithoutLimits) { EXPECT_GT(examine_largest_boxes({2, true}).balanced, 40); }

TEST(ForceBalance, WrenchClosure) {
  const Counts counts = examine_largest_boxes({3, false, true});
  EXPECT_GT(counts.balanced, 30);
  EXPECT_GT(counts.not_balanced, 60);
  EXPECT_LT(counts.undecided, 20);
}

TEST(ForceBalance, BoxWithAnAnchorIsUndecided) {
  const ForceBalance balance = PointOnCables{2, false}.balance();
  EXPECT_EQ(balance.examine({Interval(-1.1, -0.9), Interval(1.9, 2.1)}), Result::undecided);
}

}  // namespace
}  // namespace pkm::bounds
