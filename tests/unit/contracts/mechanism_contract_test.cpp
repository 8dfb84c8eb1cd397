// Laws that every mechanism of the catalogue obeys. A new mechanism is tested without a change here.
#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "engine/problem/expression.hpp"
#include "engine/problem/survey_results.hpp"
#include "engine/survey/voxel_grid.hpp"
#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

using test::nominal;
using test::plan;
using test::survey;

class MechanismContract : public testing::TestWithParam<std::shared_ptr<const Mechanism>> {
 protected:
  const Mechanism& mechanism() const { return *GetParam(); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return nominal(info()); }

  /// The held coordinate's value at which a coarse grid has most feasible cells: a plane where poses can be tested.
  double plane() const {
    double best_value = 0;
    std::int64_t most = -1;
    for (int i = -60; i <= 60; ++i) {
      const double value = 0.1 * i;
      const std::int64_t cells = survey(mechanism(), parameters(), at(value, 10)).feasible_cells;
      if (cells > most) {
        most = cells;
        best_value = value;
      }
    }
    return best_value;
  }
  SurveyPlan at(double held, std::int64_t cells) const {
    SurveyPlan p = plan(info(), Method::voxels, cells);
    p.held = {HeldCoordinate::Kind::value, held};
    return p;
  }

  struct Found {
    std::vector<Pose<double>> inside, outside;  ///< centres of feasible cells and of the others
  };
  Found centres() const {
    const double held = plane();
    const VoxelMap map = mechanism().voxel_map(parameters(), at(held, 14));
    Box box;
    for (std::size_t i = 0; i < 3; ++i) box[i] = {map.lower[i], map.upper[i]};
    const VoxelGrid grid({map.cells[0], map.cells[1], map.cells[2]}, box);
    Found found;
    std::size_t cell = 0;
    for (std::int64_t i = 0; i < grid.cells[0]; ++i)
      for (std::int64_t j = 0; j < grid.cells[1]; ++j)
        for (std::int64_t k = 0; k < grid.cells[2]; ++k) {
          std::array<double, 4> c{};
          c[static_cast<std::size_t>(info().held)] = held;
          c[static_cast<std::size_t>(info().swept[0])] = grid.centre(0, i);
          c[static_cast<std::size_t>(info().swept[1])] = grid.centre(1, j);
          c[static_cast<std::size_t>(info().swept[2])] = grid.centre(2, k);
          (map.feasible[cell++] ? found.inside : found.outside).push_back({c[0], c[1], c[2], c[3]});
        }
    return found;
  }
  PoseReport inspect(const Pose<double>& pose) const {
    return mechanism().inspect(parameters(), pose, info().modes[0], no_limits(info()));
  }
};

std::string text(const Pose<double>& p) {
  return "pose " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + " " +
         std::to_string(p.angle);
}

TEST_P(MechanismContract, DescribesItself) {
  for (const std::string& words : {info().name, info().title, info().source, info().volume_unit})
    EXPECT_NE(words, "") << info().name;
  ASSERT_FALSE(info().modes.empty());
  std::set<std::string> names;
  for (const Parameter& p : info().parameters) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " twice";
    EXPECT_NE(p.unit, "") << p.name;
    EXPECT_NE(p.meaning, "") << p.name;
    EXPECT_LE(p.lower, p.nominal) << p.name;
    EXPECT_LE(p.nominal, p.upper) << p.name;
  }
  std::set<int> held;
  for (const Sweep& sweep : sweeps_of(info())) {
    std::set<int> coordinates(sweep.swept.begin(), sweep.swept.end());
    coordinates.insert(sweep.held);
    EXPECT_EQ(coordinates, (std::set<int>{0, 1, 2, 3}));  // each is swept or held
    EXPECT_NE(sweep.column, sweep.held);
    EXPECT_NE(sweep.volume_unit, "");
    EXPECT_TRUE(held.insert(sweep.held).second) << "two sweeps hold coordinate " << sweep.held;
  }
  SurveyPlan other = plan(info(), Method::voxels, 4);
  for (int coordinate = -1; coordinate < 5; ++coordinate) {
    other.held.coordinate = coordinate;
    if (held.contains(coordinate)) continue;
    EXPECT_THROW(mechanism().prepare(other, {}), std::invalid_argument) << coordinate;
  }
}

TEST_P(MechanismContract, TakesItsNominalParametersAndRefusesThoseOutOfRange) {
  EXPECT_EQ(mechanism().refuse(parameters()), "");
  for (std::size_t i = 0; i < info().parameters.size(); ++i)
    for (const double wrong : {info().parameters[i].lower - 1, info().parameters[i].upper + 1, std::nan("")}) {
      auto p = parameters();
      p[i] = wrong;
      EXPECT_NE(mechanism().refuse(p).find(info().parameters[i].name), std::string::npos) << wrong;
    }
}

TEST_P(MechanismContract, AssemblesWhereTheVoxelMapSaysAndNowhereElse) {
  const Found found = centres();
  EXPECT_GT(found.inside.size(), 20u);
  EXPECT_GT(found.outside.size(), 20u);
  for (const auto& pose : found.inside) {
    const PoseReport report = inspect(pose);
    EXPECT_TRUE(report.assembles && report.feasible) << text(pose) << ": " << report.reason;
    EXPECT_TRUE(report.joints) << text(pose);
  }
  for (const auto& pose : found.outside) EXPECT_FALSE(inspect(pose).feasible) << text(pose);
}

TEST_P(MechanismContract, ForwardOfInverseContainsThePose) {
  constexpr double kRoundoff = 1e-7;  // of the square roots near the ends of a stroke
  for (const auto& pose : centres().inside) {
    const PoseReport report = inspect(pose);
    ASSERT_TRUE(report.joints) << text(pose);
    bool contained = false;
    for (const AssemblyMode& mode : mechanism().forward(parameters(), *report.joints)) {
      const Pose<double>& p = mode.pose;
      const double turn = std::remainder(p.angle - pose.angle, 2 * std::numbers::pi);
      contained = contained || (std::fabs(p.x - pose.x) < kRoundoff && std::fabs(p.y - pose.y) < kRoundoff &&
                                std::fabs(p.z - pose.z) < kRoundoff && std::fabs(turn) < kRoundoff);
    }
    EXPECT_TRUE(contained) << text(pose);
  }
}

TEST_P(MechanismContract, JacobianEqualsDifferencesOfTheJoints) {
  constexpr double kStep = 1e-5;
  int compared = 0;
  for (const auto& pose : centres().inside) {
    const PoseReport here = inspect(pose);
    // Close to a singularity the third derivative, and with it the error of the differences, grows without bound.
    if (!here.J || here.J->cwiseAbs().maxCoeff() > 10) continue;
    for (int c = 0; c < 4; ++c) {
      const auto moved = [&](double by) {
        Pose<double> p = pose;
        (c == 0 ? p.x : c == 1 ? p.y : c == 2 ? p.z : p.angle) += by;
        return inspect(p).joints;
      };
      const auto before = moved(-kStep), after = moved(kStep);
      if (!before || !after) continue;
      ++compared;
      for (int joint = 0; joint < 4; ++joint) {
        const auto at = static_cast<std::size_t>(joint);
        const double scale = std::fmax(1, std::fabs((*here.J)(joint, c)));
        EXPECT_NEAR(((*after)[at] - (*before)[at]) / (2 * kStep), (*here.J)(joint, c), 1e-5 * scale)
            << text(pose) << ", " << c;
      }
    }
  }
  EXPECT_GT(compared, 100);
}

TEST_P(MechanismContract, VoxelsConvergeToTheColumns) {
  for (const Sweep& sweep : sweeps_of(info())) {
    SCOPED_TRACE("held coordinate " + std::to_string(sweep.held));
    const double exact = survey(mechanism(), parameters(), plan(info(), sweep, Method::columns)).volume;
    ASSERT_GT(exact, 0);
    const auto voxels = [&](std::int64_t cells) {
      return survey(mechanism(), parameters(), plan(info(), sweep, Method::voxels, cells)).volume;
    };
    EXPECT_NEAR(voxels(30) / exact, 1, 0.05);
    EXPECT_NEAR(voxels(240) / exact, 1, 0.005);
  }
}

TEST_P(MechanismContract, InactiveLimitsLieInTheirRangeAndCutNothing) {
  for (const Sweep& sweep : sweeps_of(info()))
    for (const auto method : {Method::voxels, Method::columns}) {
      SurveyPlan p = plan(info(), sweep, method, method == Method::voxels ? 30 : 0);
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
  for (const Sweep& sweep : sweeps_of(info()))
    for (const auto method : {Method::voxels, Method::columns}) {
      SurveyPlan p = plan(info(), sweep, method, method == Method::voxels ? 10 : 0);
      p.limits = test::absurd_limits(mechanism(), p);
      Demand demand;
      demand.conditioning = !info().characteristic_length.empty();
      const auto empty = survey(mechanism(), parameters(), p, demand);
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
  auto larger = parameters();
  for (std::size_t i = 0; i < larger.size(); ++i)
    if (info().parameters[i].unit == "m") larger[i] *= 3;
  EXPECT_NEAR(mechanism().size(larger) / mechanism().size(parameters()), std::pow(3, metres(info().size_unit)), 1e-12);
  for (const Sweep& sweep : sweeps_of(info())) {
    const SurveyPlan p = plan(info(), sweep, Method::columns);
    Demand demand;
    demand.conditioning = !info().characteristic_length.empty();
    const auto small = survey(mechanism(), parameters(), p, demand), large = survey(mechanism(), larger, p, demand);
    EXPECT_NEAR(large.volume / small.volume, std::pow(3, metres(sweep.volume_unit)), 1e-7);
    ASSERT_EQ(large.conditioning.size(), small.conditioning.size());
    for (std::size_t i = 0; i < small.conditioning.size(); ++i)
      EXPECT_NEAR(large.conditioning[i], small.conditioning[i], 1e-7) << i;
  }
}

TEST_P(MechanismContract, ExpressionsKnowItsNumbersByDistinctNames) {
  const SurveyPlan p = plan(info(), Method::columns);
  const auto design = parameters();
  const auto names = expression_names(info(), p);
  std::set<std::string> distinct;
  for (const ExpressionName& known : names) {
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
                            : known.origin == Origin::size      ? mechanism().size(design)
                                                                : survey_results()[known.index].value(found, scratch);
    EXPECT_EQ(expression.value(DesignView<double>{mechanism(), design, &found, scratch}), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MechanismContract, testing::ValuesIn(all_mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
