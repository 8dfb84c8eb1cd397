// Mechanism files with [[solve]]: the 3-PRS against its closed form, and a slider-crank mechanism that drives a
// four-bar linkage against theirs. mechanism_frames_test.cpp compares inertia and forces of the 3-PRS with Lagrange's
// equations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/team.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/config/report_at.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const Mechanism> robot(const std::string& name) {
  return read_mechanism_toml(test::text_of_mechanism("frames/" + name), name + ".toml");
}
std::shared_ptr<const Mechanism> slider_crank() {
  return read_mechanism_toml(test::text_of_file(PKM_TEST_DATA "/keys/solve.toml"), "solve.toml");
}

Pose<double> pose_at(double x) {
  Pose<double> pose(1);
  pose[0] = x;
  return pose;
}

TEST(Solve, GivesThe3PrsOfItsClosedForm) {
  const auto formulas = robot("3-prs"), solved = robot("3-prs-solved");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-1, 1), height(-0.2, 0.2);
  int feasible = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose<double> pose{{height(random), angle(random), angle(random)}};
    const PoseReport expected = report_at(*formulas, pose), found = report_at(*solved, pose);
    EXPECT_EQ(found.assembles, expected.assembles);
    EXPECT_EQ(found.feasible, expected.feasible);
    if (!expected.assembles) continue;
    feasible += expected.feasible;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((*found.joints)[k], (*expected.joints)[k], 1e-12);
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR((*found.J)(k / 3, k % 3), (*expected.J)(k / 3, k % 3), 1e-11);
  }
  EXPECT_GT(feasible, 20);
}

TEST(Solve, CountsTheVoxelsOfTheClosedFormWithAnyNumberOfThreads) {
  const auto count = [](const Mechanism& mechanism, int threads) {
    WorkspacePlan plan{.method = VoxelOptions{.cells = {12, 24, 24}}, .limits = no_limits(mechanism.info())};
    FieldRequest request;
    request.poses = true;
    WorkspaceResult<double> result;
    with_team(threads, [&] {
      evaluate_once<double>(*prepare_workspace(mechanism, plan, request), test::nominal(mechanism.info()), result);
    });
    return result;
  };
  const auto formulas = robot("3-prs"), solved = robot("3-prs-solved");
  const auto expected = count(*formulas, 1), one = count(*solved, 1), two = count(*solved, 2);
  EXPECT_GT(one.feasible_cells, 500);
  EXPECT_EQ(one.feasible_cells, expected.feasible_cells);
  EXPECT_EQ(one.volume, two.volume);
  EXPECT_EQ(one.pose, two.pose);
}

// The columns are along z, on which the unknowns do not depend.
TEST(Solve, IntegratesColumnsWithTheGradientOfTheClosedForm) {
  const auto volume = [](const Mechanism& mechanism) {
    const MechanismInfo& info = mechanism.info();
    const WorkspacePlan plan{
        .method = ColumnOptions{.tolerance = 1e-3, .box = Box{{{-0.3, 0.4}, {-0.5, 0.4}, {-0.4, 0.5}}}},
        .limits = no_limits(info)};
    std::vector<Dual4> design;
    for (std::size_t i = 0; i < info.parameters.size(); ++i)  // derivatives with respect to R, r, L and q_min
      design.push_back(i < 4 ? Dual4::variable(info.parameters[i].nominal, static_cast<int>(i))
                             : info.parameters[i].nominal);
    WorkspaceResult<Dual4> result;
    evaluate_once<Dual4>(*prepare_workspace(mechanism, plan, {}), design, result);
    return result.volume;
  };
  const Dual4 expected = volume(*robot("3-prs")), found = volume(*robot("3-prs-solved"));
  EXPECT_NEAR(found.a, expected.a, 1e-9);
  EXPECT_GT(std::fabs(expected.v[1]), 0.1);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found.v[i], expected.v[i], 1e-7);
}

TEST(Solve, GivesTheAnglesOfASliderCrankAndAFourBarLinkage) {
  const auto mechanism = slider_crank();
  const double a = 0.1, b = 0.25, c = 0.22, d = 0.2, e = 0.3;
  for (double x = 0.16; x < 0.345; x += 0.01) {
    SCOPED_TRACE(x);
    const PoseReport report = report_at(*mechanism, pose_at(x));
    ASSERT_TRUE(report.feasible) << report.reason;
    const double q = std::acos((x * x + a * a - b * b) / (2 * a * x));
    EXPECT_NEAR((*report.joints)[0], q, 1e-14);
    // x^2 - 2 a x cos(q) + a^2 = b^2
    EXPECT_NEAR((*report.J)(0, 0), (a * std::cos(q) - x) / (a * x * std::sin(q)), 1e-11);
    // the rocker from its pivot (-e, 0): |crank - rocker end| = c
    const double px = a * std::cos(q) + e, py = a * std::sin(q), distance = std::hypot(px, py);
    const double w = std::atan2(py, px) + std::acos((d * d + distance * distance - c * c) / (2 * d * distance));
    const auto& known = mechanism->info().quantities;
    const auto rocker = std::ranges::find(known, "rocker", &QuantityInfo::name) - known.begin();
    EXPECT_NEAR(report.quantities[static_cast<std::size_t>(rocker)], w, 1e-13);
  }
}

TEST(Solve, ReportsPosesWithoutASolutionAsInfeasible) {
  for (const double x : {0.1, 0.149, 0.351, 0.4}) {
    const PoseReport report = report_at(*slider_crank(), pose_at(x));
    EXPECT_FALSE(report.assembles);
    EXPECT_THAT(report.reason, HasSubstr("the equations of q, p are not solved: Newton's method does not converge"));
    const auto margin = std::ranges::find(report.margins, "q, p solved", &NamedValues::value_type::first);
    ASSERT_NE(margin, report.margins.end());
    EXPECT_EQ(margin->second, -1);
  }
}

// x between b - a and b + a, where the crank and the coupler are in line; the four-bar linkage is not at its limits
TEST(Solve, FindsTheWholeWorkspace) {
  const auto mechanism = slider_crank();
  const std::vector<double> design = test::nominal(mechanism->info());
  VoxelOptions voxels;
  voxels.cells[0] = 900;
  WorkspacePlan plan{.method = voxels, .limits = no_limits(mechanism->info())};
  EXPECT_NEAR(test::survey(*mechanism, design, plan).volume, 0.2, 2 * 0.45 / 900);
  for (const auto& [from, to, feasible] : {std::tuple{0.2, 0.3, 0.1}, std::tuple{0.32, 0.38, 0.03}}) {
    plan.method = ColumnOptions{.box = Box{{{from, to}, {0, 0}, {0, 0}}}};
    const VolumeBounds bounds = mechanism->bounds()->volume(design, plan, "", {.gap = 0.1, .max_boxes = 5000});
    EXPECT_GT(bounds.lower, 0.9 * feasible);
    EXPECT_LE(bounds.lower, feasible + 1e-12);
    EXPECT_GE(bounds.upper, feasible - 1e-12);
    EXPECT_LT(bounds.upper, 1.1 * feasible);
  }
}

}  // namespace
}  // namespace pkm
