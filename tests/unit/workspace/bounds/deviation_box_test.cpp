// The largest box of deviations, for constraints whose largest box is known in closed form.
#include "engine/workspace/bounds/deviation_box.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/team.hpp"
#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

using CoordinateRanges = std::vector<std::array<double, 2>>;

/// Constraints of the axes `letters`: coordinates x, y, then deviations a, b.
ParametricConstraints constraints_of(const std::string& letters, const std::vector<std::string>& texts,
                                     bool is_strict = false) {
  Formulas formulas(letters);
  std::vector<ParametricConstraint> all;
  for (const std::string& text : texts) all.push_back({text, formulas.read(text), is_strict});
  ParametricConstraints made;
  made.add(formulas.graph, all, formulas.positions, formulas.inputs());
  return made;
}

DeviationBox find(const ParametricConstraints& constraints, const CoordinateRanges& ranges, double largest = 10,
                  const DeviationBoxOptions& options = {.gap = 1e-3}) {
  const auto known = ViolationSearch(constraints, ranges).search(largest, options.stop);
  return largest_deviation_box(constraints, ranges, largest, known, options);
}

void expect_scale(const DeviationBox& found, double scale, double gap = 1e-3) {
  EXPECT_LE(found.certified, scale);
  EXPECT_GE(found.certified, scale * (1 - 1.1 * gap));
  ASSERT_TRUE(found.violation);
  EXPECT_GE(found.violation->scale, scale * (1 - 1e-9));
  EXPECT_LE(found.violation->scale, scale * (1 + gap));
}

TEST(DeviationBox, OfAConstraintThatIsViolatedFirstAtAVertex) {
  // an arm of two links, 0.7 + a and 0.5 + 2 b, which reaches (0.6, 0.8) at a distance of 1: 3 t = 0.2
  const auto reach = constraints_of("xyab", {"0.7 + a + 0.5 + 2*b - sqrt(x^2 + y^2)"});
  const DeviationBox found = find(reach, {{0.1, 0.6}, {0.1, 0.8}});
  expect_scale(found, 0.2 / 3);
  EXPECT_LE(found.boxes, 10u);
  EXPECT_NEAR(found.violation->point[0], 0.6, 1e-6);
  EXPECT_NEAR(found.violation->point[1], 0.8, 1e-6);
  EXPECT_LT(found.violation->point[2], 0);
  // the inner boundary: 0.7 + a - (0.5 + 2 b) <= 0.3 at (0.3, 0)
  expect_scale(
      find(constraints_of("xyab", {"sqrt(x^2 + y^2) - (0.7 + a) + 0.5 + 2*b", "1.2 + a - x"}), {{0.3, 0.6}, {0, 0.1}}),
      0.1 / 3);
}

TEST(DeviationBox, OfAConstraintThatIsViolatedFirstInside) {
  expect_scale(find(constraints_of("xab", {"1 - (a + b)*(1 - (x - 0.3)^2)"}), {{-1, 1}}), 0.5);
  // nonlinear in the deviations: 1 - (a + b)^2 - a b = 1 - 5 t^2 in the corners (t, t) and (-t, -t)
  expect_scale(find(constraints_of("xab", {"1 - (a + b)^2 - a*b + x^2"}), {{-0.3, 1}}), std::sqrt(0.2));
  expect_scale(find(constraints_of("xya", {"0.4 + sin(3*x)*cos(2*y) + 0.7 - a"}), {{-4, 4}, {-4, 4}}), 0.1);
}

TEST(DeviationBox, OfStrictAndUndefinedConstraints) {
  expect_scale(find(constraints_of("xa", {"x^2 + 0.25 + a"}, true), {{-1, 1}}), 0.25);
  expect_scale(find(constraints_of("xa", {"sqrt(1 + a - x)"}), {{0, 0.9}}), 0.1);
  // a > 0 is required for d = 0, too
  const DeviationBox zero = find(constraints_of("xa", {"x*a"}, true), {{1, 2}});
  EXPECT_EQ(zero.certified, 0);
}

TEST(DeviationBox, OfADeterminantWithItsMatrix) {
  // The matrix (1 + a, b; c, 1 + a) is singular if (1 + a)^2 = b c; of the smallest scale if 1 - t = t.
  const auto determinant = [](bool has_matrix) {
    Formulas formulas("xabc");
    ParametricConstraint constraint{"det", formulas.read("(1 + a)*(1 + a) - b*c"), true};
    if (has_matrix) {
      for (const char* entry : {"1 + a", "b", "c", "1 + a"}) constraint.matrix.push_back(formulas.read(entry));
      constraint.columns = 2;
    }
    ParametricConstraints made;
    made.add(formulas.graph, {constraint}, formulas.positions, formulas.inputs());
    return find(made, {{0, 1}});
  };
  expect_scale(determinant(true), 0.5);
  EXPECT_LE(determinant(true).boxes, determinant(false).boxes);
  // The matrix is regular, and its determinant is negative in the whole box: both are violations of det > 0.
  Formulas formulas("xa");
  ParametricConstraint negative{"det", formulas.read("-(1 + a)"), true, {formulas.read("-(1 + a)")}, 1};
  ParametricConstraints made;
  made.add(formulas.graph, {negative}, formulas.positions, formulas.inputs());
  const DeviationBox found = find(made, {{0, 1}}, 0.5);
  ASSERT_TRUE(found.violation);
  EXPECT_EQ(found.violation->scale, 0);
}

TEST(DeviationBox, WithoutAViolation) {
  const DeviationBox found = find(constraints_of("xa", {"2 + x - a^2/100"}), {{-1, 1}}, 3);
  EXPECT_FALSE(found.violation);
  EXPECT_EQ(found.certified, 3);
}

TEST(DeviationBox, OfADesignThatViolatesAConstraint) {
  const DeviationBox found = find(constraints_of("xa", {"0.5 - x + a"}), {{0, 1}});
  ASSERT_TRUE(found.violation);
  EXPECT_EQ(found.violation->scale, 0);
  EXPECT_EQ(found.certified, 0);
}

TEST(DeviationBox, IsCertifiedWhenTheSearchIsLimited) {
  const auto hard = constraints_of("xyab", {"0.01 + (x - y)^2*(1 + a) + x*b - y*b - 0.02*a"});
  const CoordinateRanges ranges = {{-1, 1}, {-1, 1}};
  const DeviationBox exact = find(hard, ranges, 10, {.gap = 1e-2});
  const DeviationBox limited = find(hard, ranges, 10, {.gap = 1e-2, .max_boxes = 500});
  EXPECT_LT(limited.certified, exact.certified);
  const DeviationBox stopped = find(hard, ranges, 10, {.gap = 1e-2, .stop = [] { return true; }});
  EXPECT_TRUE(stopped.stopped);
  EXPECT_EQ(stopped.certified, 0);
}

TEST(DeviationBox, DoesNotDependOnTheNumberOfThreads) {
  const auto hard = constraints_of("xyab", {"0.01 + (x - y)^2*(1 + a) + x*b - y*b - 0.02*a"});
  const CoordinateRanges ranges = {{-1, 1}, {-1, 1}};
  const DeviationBoxOptions options{.gap = 5e-2, .max_boxes = 20000};
  const DeviationBox one = find(hard, ranges, 10, options);
  DeviationBox three;
  with_team(3, [&] { three = find(hard, ranges, 10, options); });
  EXPECT_EQ(one.certified, three.certified);
  EXPECT_EQ(one.boxes, three.boxes);
  EXPECT_EQ(one.violation->point, three.violation->point);
}

}  // namespace
}  // namespace pkm::bounds
