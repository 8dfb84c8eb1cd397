// Laws that every mechanism of the catalogue obeys, and a user's, as far as it has what they speak of. A new mechanism
// is tested without a change here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/math/statistics.hpp"
#include "tests/unit/contracts/mechanism_contract.hpp"

namespace pkm {
namespace {

template <class Axes>
void expect_named(const Axes& axes, std::size_t most) {
  std::set<std::string> names;
  EXPECT_GE(axes.size(), 1u);
  EXPECT_LE(axes.size(), most);
  for (const AxisInfo& axis : axes) {
    EXPECT_TRUE(names.insert(axis.name).second) << axis.name << " twice";
    EXPECT_TRUE(axis.unit == "m" || axis.unit == "rad") << axis.name;
  }
}

TEST_P(MechanismContract, DescribesItself) {
  for (const std::string& words : {info().name, info().title, info().source}) EXPECT_NE(words, "") << info().name;
  expect_named(info().coordinates, kMostCoordinates);
  expect_named(info().joints, kMostJoints);
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

TEST_P(MechanismContract, SweepsAreFoundByWhatTheySweepOrHold) {
  std::set<int> all, can_hold;
  for (int coordinate = 0; coordinate < std::ssize(info().coordinates); ++coordinate) all.insert(coordinate);
  ASSERT_FALSE(info().sweeps.empty());
  for (const Sweep& sweep : info().sweeps) {
    SCOPED_TRACE(test::words(info(), sweep));
    EXPECT_GE(sweep.swept.size(), 1u);
    EXPECT_LE(sweep.swept.size(), 3u);
    std::multiset<int> coordinates(sweep.swept.begin(), sweep.swept.end());
    EXPECT_TRUE(coordinates.contains(sweep.column));
    coordinates.insert(sweep.held.begin(), sweep.held.end());
    EXPECT_EQ(coordinates, std::multiset<int>(all.begin(), all.end()));  // each is swept or held
    EXPECT_TRUE(std::ranges::is_sorted(sweep.held));
    SurveyPlan plan = test::voxels(info(), sweep, 2);
    std::ranges::reverse(plan.swept);  // their order is the mechanism's
    EXPECT_EQ(&sweep_of(info(), plan), &sweep) << "another sweeps the same";
    plan.swept.clear();
    EXPECT_TRUE(std::ranges::includes(sweep_of(info(), plan).held, sweep.held)) << "it holds something else";
    EXPECT_NE(volume_unit(info(), plan), "");
    for (const int coordinate : sweep.held) EXPECT_TRUE(mechanism().middle(parameters(), coordinate)) << coordinate;
    can_hold.insert(sweep.held.begin(), sweep.held.end());
  }
  for (int coordinate = -1; coordinate <= std::ssize(info().coordinates); ++coordinate) {
    if (can_hold.contains(coordinate)) continue;
    for (SurveyPlan& plan : test::plans(mechanism(), info().sweeps.front(), 2)) {
      plan.held = {{.coordinate = coordinate}};
      EXPECT_THROW(prepare_survey(mechanism(), plan, {}), std::invalid_argument) << coordinate;
    }
  }
}

TEST_P(MechanismContract, TakesItsNominalParametersAndRefusesThoseOutOfRange) {
  EXPECT_FALSE(mechanism().refuse(parameters()));
  for (std::size_t i = 0; i < info().parameters.size(); ++i)
    for (const double wrong : {info().parameters[i].lower - 1, info().parameters[i].upper + 1, std::nan("")}) {
      auto p = parameters();
      p[i] = wrong;
      EXPECT_NE(mechanism().refuse(p).value_or("").find(info().parameters[i].name), std::string::npos) << wrong;
    }
}

TEST_P(MechanismContract, NoPoseIsFeasibleOutOfItsReach) {
  for (const Sweep& sweep : info().sweeps)
    for (const int held : sweep.held) {
      const auto reach = mechanism().reach(parameters(), held);
      const bool whole_turn = reach && info().coordinates[static_cast<std::size_t>(held)].turns() &&
                              (*reach)[1] - (*reach)[0] >= 2 * std::numbers::pi;
      if (!reach || whole_turn) continue;
      for (Pose<double> pose : centres().inside)
        for (const double value : {(*reach)[0] - 1e-3, (*reach)[1] + 1e-3}) {
          pose[static_cast<std::size_t>(held)] = value;
          EXPECT_FALSE(inspect(pose).feasible) << test::words(info(), pose);
        }
    }
}

TEST_P(MechanismContract, ReachIsWidestAtCornersOfTheDesigns) {
  // along each parameter on its own, about its nominal value
  const auto near = [&](std::size_t i, double share) {
    const Parameter& p = info().parameters[i];
    return std::clamp(parameters()[i] + 0.1 * share * (std::fabs(parameters()[i]) + 0.01), p.lower, p.upper);
  };
  const int coordinate = info().sweeps[0].held.empty() ? -1 : info().sweeps[0].held[0];
  if (coordinate < 0 || !mechanism().reach(parameters(), coordinate)) GTEST_SKIP() << "says nothing";
  for (std::size_t i = 0; i < info().parameters.size(); ++i) {
    const auto at = [&](double share) {
      auto p = parameters();
      p[i] = near(i, share);
      return *mechanism().reach(p, coordinate);
    };
    const auto low = at(-1), high = at(1);
    for (const double share : {-0.7, -0.2, 0.0, 0.4, 0.9}) {
      EXPECT_GE(at(share)[0], std::fmin(low[0], high[0])) << info().parameters[i].name;
      EXPECT_LE(at(share)[1], std::fmax(low[1], high[1])) << info().parameters[i].name;
    }
  }
}

TEST_P(MechanismContract, AssemblesWhereTheVoxelMapSaysAndNowhereElse) {
  const Found found = centres();
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
  const auto expected = names(inspect(test::usual_pose(mechanism())));
  EXPECT_FALSE(expected.empty());
  const Found found = centres();
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
  constexpr double kRoundoff = 1e-7;  // of the square roots near the ends of a stroke
  const auto poses = centres().inside;
  const std::size_t step = test::is_of_file(info()) ? poses.size() / 6 + 1 : 1;  // Newton's method takes its time
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
        const double way = mode.pose[i] - pose[i];
        worst = std::fmax(worst,
                          std::fabs(info().coordinates[i].turns() ? std::remainder(way, 2 * std::numbers::pi) : way));
      }
      contained = contained || worst < kRoundoff;
    }
    EXPECT_TRUE(contained) << test::words(info(), pose);
    EXPECT_EQ(mechanism().forward()->status(parameters(), *report.joints, found).word, "OK");
  }
}

TEST_P(MechanismContract, JacobianEqualsDifferencesOfTheJoints) {
  if (!inspect(test::usual_pose(mechanism())).J) GTEST_SKIP() << "no Jacobian";
  constexpr double kStep = 1e-5;
  int compared = 0;
  for (const auto& pose : centres().inside) {
    const PoseReport here = inspect(pose);
    // Close to a singularity the third derivative, and with it the error of the differences, grows without bound.
    if (!here.J || std::ranges::any_of(*here.J, [](double slope) { return std::fabs(slope) > 10; })) continue;
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

INSTANTIATE_TEST_SUITE_P(All, MechanismContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
