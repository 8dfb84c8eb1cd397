// Isolation of the sign changes of constraints along one coordinate, and volumes whose constraints change their signs
// more often than samples show.
#include "engine/generic/columns/sign_changes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/expression/derivative.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/motion/motion_factories.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

using generic::find_sign_changes;
using generic::SignChange;
using generic::SignChangeScratch;
using generic::WithDerivative;

/// The sign changes of formulas of x in [from, to].
SignChangeScratch changes_of(const std::vector<std::string>& formulas, double from, double to, long evaluations) {
  expression::Graph graph;
  const expression::Node x = graph.input(0, 1);
  const std::vector<std::string> names{"x"};
  std::vector<expression::Node> outputs;
  for (const std::string& formula : formulas) {
    const expression::Node node = expression::read_formula(graph, formula, names, {&x, 1});
    outputs.insert(outputs.end(), {node, expression::derivative(graph, node, x)});
  }
  const expression::Program program(graph, outputs, std::vector<expression::Groups>{2, 1});
  std::vector<WithDerivative> constraints;
  for (std::size_t i = 0; i < formulas.size(); ++i)
    constraints.push_back({program.outputs()[2 * i], program.outputs()[2 * i + 1]});
  std::vector<double> registers(program.registers());
  program.start<double>(registers);
  SignChangeScratch scratch;
  find_sign_changes(program, 1, constraints, from, to, evaluations, registers, scratch);
  std::ranges::sort(scratch.found, {}, &SignChange::at);
  return scratch;
}

TEST(SignChanges, OfASineAreMultiplesOfPi) {
  const SignChangeScratch scratch = changes_of({"sin(x)"}, 0.1, 100, 100'000);
  ASSERT_EQ(scratch.found.size(), 31U);
  for (std::size_t i = 0; i < scratch.found.size(); ++i) {
    EXPECT_NEAR(scratch.found[i].at, std::numbers::pi * static_cast<double>(i + 1), 1e-13);
    EXPECT_EQ(scratch.found[i].falls, i % 2 == 0);
  }
  EXPECT_EQ(scratch.undecided, 0);
}

TEST(SignChanges, OfSeveralConstraintsAreFoundTogether) {
  const SignChangeScratch scratch = changes_of({"x - 0.3", "0.7 - x", "x^2 + 1"}, 0, 1, 1000);
  ASSERT_EQ(scratch.found.size(), 2U);
  EXPECT_EQ(scratch.found[0].at, 0.3);
  EXPECT_EQ(scratch.found[0].constraint, 0U);
  EXPECT_FALSE(scratch.found[0].falls);
  EXPECT_EQ(scratch.found[1].at, 0.7);
  EXPECT_EQ(scratch.found[1].constraint, 1U);
  EXPECT_TRUE(scratch.found[1].falls);
}

TEST(SignChanges, OfARootAreAtTheEndOfItsDomain) {
  const SignChangeScratch scratch = changes_of({"sqrt(x - 0.25) + 1"}, 0, 1, 1000);
  ASSERT_EQ(scratch.found.size(), 1U);
  EXPECT_NEAR(scratch.found[0].at, 0.25, 1e-15);
  EXPECT_FALSE(scratch.found[0].falls);
  EXPECT_EQ(scratch.undecided, 0);
}

TEST(SignChanges, ThatTouchZeroStayUndecidedInAShortInterval) {
  const SignChangeScratch scratch = changes_of({"-(x - 1/3)^2"}, 0, 1, 1000);
  EXPECT_TRUE(scratch.found.empty());
  EXPECT_GT(scratch.undecided, 0);
  EXPECT_LT(scratch.undecided, 1e-8);
}

TEST(SignChanges, BeyondTheBudgetAreReportedAsUndecided) {
  const SignChangeScratch scratch = changes_of({"sin(1e6*x)"}, 0, 1, 1000);
  EXPECT_GT(scratch.undecided, 0.99);
  EXPECT_LT(scratch.evaluations, 4000);
}

/// A unit square or cube of which the coordinates are the joints, with margins.
std::shared_ptr<const Mechanism> box(const std::string& coordinates, const std::string& joints,
                                     const std::string& ranges, const std::string& margins) {
  return read_mechanism_toml(
      "[mechanism]\nname = \"comb\"\n[parameters]\n"
      "w = { default = \"50 mm\", min = \"1 um\", max = \"3 m\" }\n"
      "[platform]\ncoordinates = { " +
          coordinates + " }\n[survey]\nbox = { " + ranges +
          " }\n[[limb]]\nname = \"a\"\ndrive = \"formula\"\njoints = { " + joints + " }\nunit = \"m\"\n" + margins,
      "comb.toml");
}

WorkspaceResult<double> evaluated(const Mechanism& mechanism, double w) {
  return test::survey(mechanism, {w}, test::columns(mechanism.info()));
}

TEST(Combs, OfAnAreaAreCountedOrUnknown) {
  const auto comb = box(R"(x = "along x", y = "along y")", R"(p = "x", q = "y")", "x = [0, 1], y = [0, 1]",
                        "[[margin]]\nname = \"comb\"\nformula = \"sin(2*pi*x/w)\"\nunit = \"1\"\n");
  for (const double w : {0.05, 0.02, 0.001}) {
    const WorkspaceResult<double> result = evaluated(*comb, w);
    EXPECT_NEAR(result.volume, 0.5, 1e-12) << w;
    EXPECT_LT(result.error, 1e-8) << w;
  }
  EXPECT_GE(evaluated(*comb, 1e-6).error, 1);
}

TEST(Combs, AlongTheOutermostCoordinateAreCountedOrUnknown) {
  const auto comb =
      box(R"(x = "along x", y = "along y", z = "along z")", R"(p = "x", q = "y", r = "z")",
          "x = [0, 1], y = [0, 1], z = [0, 1]",
          "[[margin]]\nname = \"comb\"\nformula = \"sin(2*pi*x/w)\"\nunit = \"1\"\n"
          "[[margin]]\nname = \"ball\"\nformula = \"0.2 - sin((y - 0.5)^2 + (z - 0.5)^2)\"\nunit = \"1\"\n");
  WorkspacePlan plan{.method = ColumnOptions{.tolerance = 1e-5}, .limits = no_limits(comb->info())};
  const WorkspaceResult<double> result = test::survey(*comb, {0.1}, plan);
  const double volume = 0.5 * std::numbers::pi * std::asin(0.2);
  EXPECT_NEAR(result.volume, volume, result.error * volume);
  EXPECT_LT(result.error, 1e-5);
  EXPECT_GE(test::survey(*comb, {1e-6}, plan).error, 1);
}

}  // namespace
}  // namespace pkm
