// Laws that every mechanism of the catalogue obeys, and a user's, as far as it has what they speak of. A new mechanism
// is tested without a change here.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "engine/math/statistics.hpp"
#include "engine/problem/expression.hpp"
#include "engine/report/workspace_fields.hpp"
#include "engine/survey/plain_voxels.hpp"
#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

using test::nominal;
using test::survey;

class MechanismContract : public testing::TestWithParam<std::string> {
 protected:
  const Mechanism& mechanism() const { return *test::mechanism_called(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return nominal(info()); }

  struct Found {
    std::vector<Pose<double>> inside, outside;  ///< centres of feasible cells and of the others
  };
  /// Some 2700 cells of the usual sweep.
  Found centres() const {
    const auto axes = static_cast<double>(info().sweeps.front().swept.size());
    const test::Cells cells = test::some_cells(mechanism(), std::lround(std::pow(14, 3 / axes)));
    Found found;
    for (std::size_t i = 0; i < cells.poses.size(); ++i)
      (cells.feasible[i] ? found.inside : found.outside).push_back(cells.poses[i]);
    return found;
  }
  PoseReport inspect(const Pose<double>& pose) const {
    return mechanism().inspect(parameters(), pose, info().modes[0], no_limits(info()));
  }
};

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

/// What a mechanism has that is faster finds what testing every cell finds.
TEST_P(MechanismContract, SurveysOfVoxelsAreThoseOfEveryCell) {
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    SCOPED_TRACE(test::words(info(), sweep));
    SurveyPlan plan = test::voxels(info(), sweep, 11);
    plan.limits = survey_limits(info(), plan.limits);
    const VoxelMap map = voxel_map(mechanism(), parameters(), plan);
    VoxelOptions voxels = *plan.voxels();
    voxels.box.emplace();
    for (std::size_t i = 0; i < 3; ++i) (*voxels.box)[i] = {map.lower[i], map.upper[i]};
    EXPECT_EQ(prepare_plain_voxels(mechanism(), plan, voxels, {})->map(parameters()).feasible, map.feasible);
    const Demand demand = test::all_fields(mechanism());
    const Survey<double> fast = survey(mechanism(), parameters(), plan, demand);
    Survey<double> plain;
    survey_once<double>(*prepare_plain_voxels(mechanism(), plan, voxels, demand), parameters(), plain);
    EXPECT_EQ(plain.cells, fast.cells);
    EXPECT_EQ(plain.feasible_cells, fast.feasible_cells);
    EXPECT_NEAR(plain.volume / fast.volume, 1, 1e-12);
    const auto expect_same_mean = [&](const std::vector<double>& a, const std::vector<double>& b) {
      EXPECT_NEAR(weighted_mean(plain.weight, a), weighted_mean(fast.weight, b), 1e-9);
    };
    for (const PoseQuantity* const quantity : demand.fields)
      for (std::size_t i = 0; i < (quantity->per_joint ? info().joints.size() : 1); ++i) {
        SCOPED_TRACE(quantity->name);
        EXPECT_GT(fast.of(*quantity, i).size(), 0u);
        expect_same_mean(plain.of(*quantity, i), fast.of(*quantity, i));
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

TEST_P(MechanismContract, VoxelsConvergeToTheColumns) {
  if (!mechanism().columns()) GTEST_SKIP() << "no columns";
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    if (!test::has_columns(mechanism(), sweep)) continue;
    SCOPED_TRACE(test::words(info(), sweep));
    const double exact = survey(mechanism(), parameters(), test::columns(info(), sweep)).volume;
    ASSERT_GT(exact, 0);
    const auto voxels = [&](std::int64_t cells) {
      return survey(mechanism(), parameters(), test::voxels(info(), sweep, cells)).volume;
    };
    const double rounds[] = {2, 1.2,
                             1};  // a length is whole cells: nothing evens out; of an area less than of a volume
    EXPECT_NEAR(voxels(30) / exact, 1, rounds[sweep.swept.size() - 1] * 0.05);
    EXPECT_NEAR(voxels(240) / exact, 1, rounds[sweep.swept.size() - 1] * 0.005);
  }
}

TEST_P(MechanismContract, ColumnsAreCutByABoxOrRefuseIt) {
  if (!mechanism().columns()) GTEST_SKIP() << "no columns";
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    if (!test::has_columns(mechanism(), sweep)) continue;
    SCOPED_TRACE(test::words(info(), sweep));
    const VoxelMap all = voxel_map(mechanism(), parameters(), test::voxels(info(), sweep, 1));
    Box box;
    for (std::size_t k = 0; k < 3; ++k) box[k] = {all.lower[k], all.upper[k]};
    SurveyPlan columns = test::columns(info(), sweep);
    const double whole = survey(mechanism(), parameters(), columns).volume;
    columns.method = ColumnOptions{.tolerance = 1e-8, .nodes = {}, .box = box};
    if (!mechanism().columns()->take_box()) {
      EXPECT_THROW(prepare_survey(mechanism(), columns, {}), std::invalid_argument);
      continue;
    }
    EXPECT_NEAR(survey(mechanism(), parameters(), columns).volume / whole, 1, 1e-7);
    box[0][1] = (box[0][0] + box[0][1]) / 2;
    std::get<ColumnOptions>(columns.method).box = box;
    SurveyPlan voxels = test::voxels(info(), sweep, 90);
    std::get<VoxelOptions>(voxels.method).box = box;
    const double cut = survey(mechanism(), parameters(), columns).volume;
    EXPECT_LT(cut, 0.9 * whole);
    EXPECT_NEAR(survey(mechanism(), parameters(), voxels).volume, cut, 0.03 * cut);  // which may be nothing
  }
}

TEST_P(MechanismContract, InactiveLimitsLieInTheirRangeAndCutNothing) {
  for (const Sweep& sweep : test::sweeps(mechanism()))
    for (SurveyPlan& p : test::plans(mechanism(), sweep, 30)) {
      if (info().limits.empty()) continue;
      const auto free = survey(mechanism(), parameters(), p);
      for (std::size_t i = 0; i < info().limits.size(); ++i) {
        const LimitInfo& limit = info().limits[i];
        EXPECT_LE(limit.lower, limit.inactive) << limit.name;
        EXPECT_LE(limit.inactive, limit.upper) << limit.name;
        p.limits = no_limits(info());
        p.limits.given[i] = limit.inactive;
        const auto limited = survey(mechanism(), parameters(), p);
        EXPECT_EQ(limited.feasible_cells, free.feasible_cells) << limit.name;
        EXPECT_NEAR(limited.volume / free.volume, 1, 1e-8) << limit.name;
      }
    }
}

TEST_P(MechanismContract, AbsurdLimitsLeaveAnEmptyWorkspace) {
  if (info().limits.empty()) GTEST_SKIP() << "no limits";
  for (const Sweep& sweep : test::sweeps(mechanism()))
    for (SurveyPlan& p : test::plans(mechanism(), sweep, 10)) {
      p.limits = test::absurd_limits(mechanism(), p);
      if (p.limits.given == no_limits(info()).given)
        continue;  // columns of a mechanism whose only limit is a clearance
      const auto empty = survey(mechanism(), parameters(), p, test::no_inertia(mechanism()));
      EXPECT_EQ(empty.volume, 0);
      EXPECT_EQ(empty.feasible_cells, 0);
      EXPECT_FALSE(empty.touches_box);
      EXPECT_TRUE(std::isfinite(empty.error));
    }
}

/// Power of the metre in a unit such as "m^2 rad".
int metres(const std::string& unit) {
  if (unit.starts_with("m^")) return unit[2] - '0';
  return unit == "m" || unit.starts_with("m ") ? 1 : 0;
}

TEST_P(MechanismContract, ScalingAllLengthsScalesTheVolumeAsItsUnitSays) {
  constexpr double kScale = 4;  // a power of two: no cell's centre comes to lie on another side of a limit by rounding
  auto larger = parameters();
  for (std::size_t i = 0; i < larger.size(); ++i)
    if (info().parameters[i].unit == "m") larger[i] *= kScale;
  if (const Size* const size = mechanism().size()) {
    EXPECT_NEAR(size->of(larger) / size->of(parameters()), std::pow(kScale, metres(size->unit())), 1e-12);
  }
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    SCOPED_TRACE(test::words(info(), sweep));
    const SurveyPlan p = test::best_plan(mechanism(), sweep);
    const Demand demand = test::no_inertia(mechanism());
    const auto small = survey(mechanism(), parameters(), p, demand), large = survey(mechanism(), larger, p, demand);
    EXPECT_NEAR(large.volume / small.volume, std::pow(kScale, metres(volume_unit(info(), p))), 1e-7);
    ASSERT_EQ(large.of(kConditioning).size(), small.of(kConditioning).size());
    for (std::size_t i = 0; i < small.of(kConditioning).size(); ++i)
      EXPECT_NEAR(large.of(kConditioning)[i], small.of(kConditioning)[i], 1e-7) << i;
  }
}

TEST_P(MechanismContract, ExpressionsKnowItsNumbersByDistinctNames) {
  const SurveyPlan p = test::best_plan(mechanism());
  const auto design = parameters();
  std::set<std::string> distinct;
  for (const ExpressionName& known : expression_names(mechanism(), p)) {
    SCOPED_TRACE(known.name);
    EXPECT_TRUE(distinct.insert(known.name).second) << "twice";
    EXPECT_NE(known.unit, "");
    EXPECT_NE(known.meaning, "");
    Options options = default_options(expression_options());
    options.set("expression", known.name);
    const EntryContext context{mechanism(), p, options};
    const Expression expression(context);
    Demand demand;
    expression.add_demand(context, demand);
    const auto found = survey(mechanism(), design, p, demand);
    Scratch scratch;
    std::vector<double> thresholds(info().limits.size());
    mechanism().thresholds(design, p.limits, thresholds);
    using Origin = ExpressionName::Origin;
    EXPECT_EQ(expression.needs_survey(), known.origin == Origin::survey);
    const double expected = known.origin == Origin::parameter   ? design[known.index]
                            : known.origin == Origin::threshold ? thresholds[known.index]
                            : known.origin == Origin::size      ? mechanism().size()->of(design)
                                                           : survey_results()[known.index].value(found, 1, scratch);
    EXPECT_EQ(expression.value(DesignView<double>{mechanism(), design, &found, scratch}), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MechanismContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
