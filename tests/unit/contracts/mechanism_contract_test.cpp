// Contract of mechanisms: description, sweeps, kinematics and feasibility, for every mechanism of the catalogue, of
// tests/own_mechanisms and from files, as far as it supports the tested capability. New mechanisms are tested
// automatically.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/math/statistics.hpp"
#include "tests/unit/contracts/mechanism_contract.hpp"

namespace pkm {
namespace {

template <class Axes>
void expect_valid_axes(const Axes& axes, std::size_t max_size) {
  std::set<std::string> names;
  EXPECT_GE(axes.size(), 1u);
  EXPECT_LE(axes.size(), max_size);
  for (const AxisInfo& axis : axes) {
    EXPECT_TRUE(names.insert(axis.name).second) << axis.name << " twice";
    EXPECT_TRUE(axis.unit == "m" || axis.unit == "rad") << axis.name;
  }
}

TEST_P(MechanismContract, HasDistinctNamesUnitsAndConsistentBounds) {
  for (const std::string& words : {info().name, info().title, info().source}) EXPECT_NE(words, "") << info().name;
  expect_valid_axes(info().coordinates, kMaxCoordinates);
  expect_valid_axes(info().joints, kMaxJoints);
  ASSERT_FALSE(info().modes.empty());
  std::set<std::string> names;
  for (const Parameter& p : info().parameters) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " twice";
    EXPECT_NE(p.unit, "") << p.name;
    EXPECT_NE(p.meaning, "") << p.name;
    EXPECT_LE(p.lower, p.nominal) << p.name;
    EXPECT_LE(p.nominal, p.upper) << p.name;
  }
}

TEST_P(MechanismContract, SweepsAreSelectedByTheirSweptOrFixedCoordinates) {
  std::set<int> all, fixable;
  for (int coordinate = 0; coordinate < std::ssize(info().coordinates); ++coordinate) all.insert(coordinate);
  ASSERT_FALSE(info().sweeps.empty());
  for (const Sweep& sweep : info().sweeps) {
    SCOPED_TRACE(test::words(info(), sweep));
    EXPECT_GE(sweep.swept.size(), 1u);
    EXPECT_LE(sweep.swept.size(), 3u);
    std::multiset<int> coordinates(sweep.swept.begin(), sweep.swept.end());
    EXPECT_TRUE(coordinates.contains(sweep.column));
    coordinates.insert(sweep.fixed.begin(), sweep.fixed.end());
    EXPECT_EQ(coordinates, std::multiset<int>(all.begin(), all.end()));  // each coordinate is either swept or fixed
    EXPECT_TRUE(std::ranges::is_sorted(sweep.fixed));
    WorkspacePlan plan = test::voxels(info(), sweep, 2);
    std::ranges::reverse(plan.swept);  // the order of the plan's coordinates is irrelevant
    EXPECT_EQ(&sweep_of(info(), plan), &sweep) << "another sweep has the same swept coordinates";
    plan.swept.clear();
    EXPECT_TRUE(std::ranges::includes(sweep_of(info(), plan).fixed, sweep.fixed)) << "a fixed coordinate is missing";
    EXPECT_NE(volume_unit(info(), plan), "");
    for (const int coordinate : sweep.fixed)
      EXPECT_TRUE(mechanism().default_value(parameters(), coordinate)) << coordinate;
    fixable.insert(sweep.fixed.begin(), sweep.fixed.end());
  }
  for (int coordinate = -1; coordinate <= std::ssize(info().coordinates); ++coordinate) {
    if (fixable.contains(coordinate)) continue;
    for (WorkspacePlan& plan : test::plans(mechanism(), info().sweeps.front(), 2)) {
      plan.fixed = {{.coordinate = coordinate}};
      EXPECT_THROW(prepare_workspace(mechanism(), plan, {}), std::invalid_argument) << coordinate;
    }
  }
}

TEST_P(MechanismContract, AcceptsNominalParametersAndRejectsThoseOutOfRange) {
  EXPECT_FALSE(mechanism().refuse(parameters()));
  for (std::size_t i = 0; i < info().parameters.size(); ++i)
    for (const double wrong : {info().parameters[i].lower - 1, info().parameters[i].upper + 1, std::nan("")}) {
      auto p = parameters();
      p[i] = wrong;
      EXPECT_NE(mechanism().refuse(p).value_or("").find(info().parameters[i].name), std::string::npos) << wrong;
    }
}

TEST_P(MechanismContract, NoPoseIsFeasibleOutsideTheReach) {
  for (const Sweep& sweep : info().sweeps)
    for (const int fixed : sweep.fixed) {
      const auto reach = mechanism().reach(parameters(), fixed);
      const bool full_rotation = reach && info().coordinates[static_cast<std::size_t>(fixed)].turns() &&
                                 (*reach)[1] - (*reach)[0] >= 2 * std::numbers::pi;
      if (!reach || full_rotation) continue;
      for (Pose<double> pose : centres().inside)
        for (const double value : {(*reach)[0] - 1e-3, (*reach)[1] + 1e-3}) {
          pose[static_cast<std::size_t>(fixed)] = value;
          EXPECT_FALSE(inspect(pose).feasible) << test::words(info(), pose);
        }
    }
}

TEST_P(MechanismContract, ReachIsLargestAtVerticesOfTheParameterBounds) {
  // Varies one parameter at a time around its nominal value.
  const auto varied = [&](std::size_t i, double share) {
    const Parameter& p = info().parameters[i];
    return std::clamp(parameters()[i] + 0.1 * share * (std::fabs(parameters()[i]) + 0.01), p.lower, p.upper);
  };
  const int coordinate = info().sweeps[0].fixed.empty() ? -1 : info().sweeps[0].fixed[0];
  if (coordinate < 0 || !mechanism().reach(parameters(), coordinate))
    GTEST_SKIP() << "the mechanism does not provide the reach";
  for (std::size_t i = 0; i < info().parameters.size(); ++i) {
    const auto at = [&](double share) {
      auto p = parameters();
      p[i] = varied(i, share);
      return *mechanism().reach(p, coordinate);
    };
    const auto low = at(-1), high = at(1);
    for (const double share : {-0.7, -0.2, 0.0, 0.4, 0.9}) {
      EXPECT_GE(at(share)[0], std::fmin(low[0], high[0])) << info().parameters[i].name;
      EXPECT_LE(at(share)[1], std::fmax(low[1], high[1])) << info().parameters[i].name;
    }
  }
}

TEST_P(MechanismContract, PosesAreFeasibleExactlyInTheFeasibleCellsOfTheVoxelMap) {
  const CellCentres found = centres();
  EXPECT_GT(found.inside.size(), 20u);
  EXPECT_GT(found.outside.size(), 20u);
  for (const auto& pose : found.inside) {
    const PoseReport report = inspect(pose);
    EXPECT_TRUE(report.assembles && report.feasible) << test::words(info(), pose) << ": " << report.reason;
    ASSERT_TRUE(report.joints) << test::words(info(), pose);
    EXPECT_EQ(report.joints->size(), info().joints.size());
    for (const auto& [name, margin] : report.margins) EXPECT_GE(margin, 0) << name;
  }
  for (const auto& pose : found.outside) {
    const PoseReport report = inspect(pose);
    EXPECT_FALSE(report.feasible) << test::words(info(), pose);
    EXPECT_NE(report.reason, "") << test::words(info(), pose);
  }
}

TEST_P(MechanismContract, MarginsHaveTheSameNamesAtEveryPoseThatAssembles) {
  const auto names = [](const PoseReport& report) {
    std::vector<std::string> all;
    for (const auto& named : report.margins) all.push_back(named.first);
    return all;
  };
  const auto expected = names(inspect(test::reference_pose(mechanism())));
  EXPECT_FALSE(expected.empty());
  const CellCentres found = centres();
  for (const auto& poses : {found.inside, found.outside})
    for (const auto& pose : poses) {
      const PoseReport report = inspect(pose);
      if (report.assembles) {
        ASSERT_EQ(names(report), expected) << test::words(info(), pose);
      }
    }
}

TEST_P(MechanismContract, ForwardOfInverseContainsThePose) {
  if (!mechanism().forward()) GTEST_SKIP() << "no forward kinematics";
  constexpr double kRoundoff = 1e-7;  // square roots near the ends of a stroke amplify rounding errors
  const auto poses = centres().inside;
  const std::size_t step = test::is_from_file(info()) ? poses.size() / 6 + 1
                                                      : 1;  // forward kinematics of files, by Newton's method, are slow
  for (std::size_t at = 0; at < poses.size(); at += step) {
    const Pose<double>& pose = poses[at];
    const PoseReport report = inspect(pose);
    ASSERT_TRUE(report.joints) << test::words(info(), pose);
    bool contained = false;
    const auto found = mechanism().forward()->assemblies(parameters(), *report.joints);
    for (const AssemblyMode& mode : found) {
      ASSERT_EQ(mode.pose.size(), pose.size());
      double worst = 0;
      for (std::size_t i = 0; i < pose.size(); ++i) {
        const double error = mode.pose[i] - pose[i];
        worst = std::fmax(
            worst, std::fabs(info().coordinates[i].turns() ? std::remainder(error, 2 * std::numbers::pi) : error));
      }
      contained = contained || worst < kRoundoff;
    }
    EXPECT_TRUE(contained) << test::words(info(), pose);
    EXPECT_EQ(mechanism().forward()->status(parameters(), *report.joints, found).word, "OK");
  }
}

TEST_P(MechanismContract, JacobianEqualsFiniteDifferencesOfTheJoints) {
  if (!inspect(test::reference_pose(mechanism())).J) GTEST_SKIP() << "no Jacobian";
  constexpr double kStep = 1e-5;
  int compared = 0;
  const auto poses = centres().inside;
  // The poses of files take longer.
  const std::size_t step = test::is_from_file(info()) ? poses.size() / 150 + 1 : 1;
  for (std::size_t at = 0; at < poses.size(); at += step) {
    const Pose<double>& pose = poses[at];
    const PoseReport here = inspect(pose);
    // Near a singularity the third derivative is unbounded, and with it the error of the finite differences.
    if (!here.J || std::ranges::any_of(*here.J, [](double element) { return std::fabs(element) > 10; })) continue;
    ASSERT_EQ(here.J->rows(), info().joints.size());
    ASSERT_EQ(here.J->cols(), info().coordinates.size());
    for (std::size_t c = 0; c < pose.size(); ++c) {
      const auto moved = [&](double by) {
        Pose<double> p = pose;
        p[c] += by;
        return inspect(p).joints;
      };
      const auto before = moved(-kStep), after = moved(kStep);
      if (!before || !after) continue;
      ++compared;
      for (std::size_t joint = 0; joint < info().joints.size(); ++joint) {
        const double scale = std::fmax(1, std::fabs((*here.J)(joint, c)));
        EXPECT_NEAR(((*after)[joint] - (*before)[joint]) / (2 * kStep), (*here.J)(joint, c), 1e-5 * scale)
            << test::words(info(), pose) << ", " << c;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

INSTANTIATE_TEST_SUITE_P(All, MechanismContract, testing::ValuesIn(test::mechanisms_and_all_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
