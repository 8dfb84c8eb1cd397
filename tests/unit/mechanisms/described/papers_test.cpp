// The four mechanisms of the papers as files against the built-in ones: the same joints, verdicts, Jacobians,
// thresholds, clearances and cells. Clearance is set to what cuts nothing where it is not looked at, because the hybrid
// counts it without being asked. What files have no counterpart of: the phase theta0 of the hybrid's auxiliary chain,
// which limits no pose; and the hybrid's conditioning, which leaves its carriage out. Its own box follows the working
// mode closely, so both count in the golden ones.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/dynamics/coupling.hpp"
#include "engine/math/statistics.hpp"
#include "engine/survey/survey_set.hpp"
#include "tests/unit/mechanisms/crr_cru/golden.hpp"
#include "tests/unit/mechanisms/described/papers.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"
#include "tests/unit/mechanisms/hybrid/golden.hpp"
#include "tests/unit/survey/own_inertia.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;

struct GoldenPose {
  std::vector<double> design;
  Pose<double> pose;
};
struct GoldenGrid {
  std::vector<double> design;
  LimitSpec limits;
  VoxelOptions voxels;
  std::vector<HeldCoordinate> held;
  std::int64_t feasible;  ///< -1: it counts clearances, too
};

Pose<double> pose_of(const Json& x) { return {x[0], x[1], x[2], x[3]}; }
std::array<std::int64_t, 3> cells_of(const Json& x) { return {x[0], x[1], x[2]}; }

class PaperMechanism : public test::PaperPair {
 protected:
  std::vector<GoldenPose> golden_poses() const {
    std::vector<GoldenPose> all;
    if (GetParam() == "4ppa-2par") {
      for (const Json& entry : testing::golden()["kinematics"])
        all.push_back({testing::design_of(entry), pose_of(entry["pose"])});
    } else if (GetParam() == "2t1r-p-hybrid") {
      for (const char* const list : {"ik", "jac", "feasibility", "quality"})
        for (const Json& entry : testing::hybrid::golden()[list])
          all.push_back({testing::hybrid::design_of(entry), pose_of(entry["X"])});
    } else {
      for (const char* const list : {"cases", "feasibility"})
        for (const Json& entry : testing::crr::golden()[list])
          if (entry["mechanism"] == GetParam()) all.push_back({testing::crr::design_of(entry), pose_of(entry["X"])});
    }
    return all;
  }
  std::vector<GoldenGrid> golden_grids() const {
    std::vector<GoldenGrid> all;
    const LimitSpec none = without_clearance(no_limits(own().info()));
    if (GetParam() == "4ppa-2par") {
      for (const Json& entry : testing::golden()["workspace"])
        for (const Json& grid : entry["voxel"])
          all.push_back({testing::design_of(entry),
                         without_clearance(testing::limits_of(entry)),
                         {.cells = cells_of(grid["cells"])},
                         {},
                         grid["feasible"]});
      auto paper = testing::nominal();
      all.push_back({paper, none, {.cells = {32, 34, 60}}, {}, 12412});
      for (const auto& [name, value] : std::map<std::string, double>{{"a", 0.3}, {"b", 1}, {"l_u", 0.7}, {"l_d", 0.7}})
        paper[static_cast<std::size_t>(find_named(own().info().parameters, name) - own().info().parameters.data())] =
            value;
      all.push_back({paper, none, {.cells = {32, 34, 60}}, {}, 12564});
    } else if (GetParam() == "2t1r-p-hybrid") {
      for (const Json& entry : testing::hybrid::golden()["workspace"])
        for (const Json& grid : entry["grids"]) {
          VoxelOptions voxels{.cells = cells_of(grid["shape"]), .box = Box{}};
          for (std::size_t k = 0; k < 3; ++k) (*voxels.box)[k] = {entry["box"][k][0], entry["box"][k][1]};
          all.push_back({testing::hybrid::design_of(entry), none, voxels, {}, -1});
        }
    } else {
      for (const Json& entry : testing::crr::golden()["dci_stats"]) {
        if (entry["mechanism"] != GetParam()) continue;
        VoxelOptions voxels{.cells = cells_of(entry["n"]), .box = Box{}};
        for (std::size_t k = 0; k < 3; ++k) (*voxels.box)[k] = {entry["lo"][k], entry["hi"][k]};
        all.push_back({testing::crr::design_of(entry),
                       without_clearance(testing::crr::limit_spec(entry["smin"], entry["cmin"])),
                       voxels,
                       {{.coordinate = 3, .kind = HeldCoordinate::Kind::value, .value = entry["phi"]}},
                       entry["feasible"]});
      }
    }
    return all;
  }

  struct Compared {
    int joints = 0, feasible = 0, slopes = 0, conditioned = 0, cleared = 0;
  };
  void expect_same(const std::vector<double>& design, const Pose<double>& pose, const LimitSpec& limits,
                   Compared& compared) const {
    for (const std::string& mode : file().info().modes) {
      SCOPED_TRACE(test::words(file().info(), pose) + " in mode " + mode);
      const PoseReport mine = file().inspect(of_file(design), pose, mode, of_file(limits)),
                       theirs = own().inspect(design, pose, own_mode(mode), limits);
      EXPECT_EQ(mine.feasible, theirs.feasible) << "'" << mine.reason << "', '" << theirs.reason << "'";
      compared.feasible += mine.feasible;
      if (!theirs.assembles || !mine.assembles) continue;
      for (std::size_t i = 0; i < 4; ++i, ++compared.joints)
        EXPECT_NEAR((*mine.joints)[i], (*theirs.joints)[i], 1e-12 * (1 + std::fabs((*theirs.joints)[i])));
      const auto clearance = [](const PoseReport& report) {
        const auto found = std::ranges::find(report.angles, "clearance", &NamedValues::value_type::first);
        return found == report.angles.end() ? std::nullopt : std::optional(found->second);
      };
      if (const auto here = clearance(mine), there = clearance(theirs); there) {
        ASSERT_TRUE(here);
        EXPECT_NEAR(*here, *there, 1e-12);
        ++compared.cleared;
      }
      if (mine.J && theirs.J) {
        double largest = 1;
        for (const double slope : *theirs.J) largest = std::fmax(largest, std::fabs(slope));
        for (std::size_t i = 0; i < 4; ++i)
          for (std::size_t j = 0; j < 4; ++j, ++compared.slopes)
            EXPECT_NEAR((*mine.J)(i, j), (*theirs.J)(i, j), 1e-10 * largest) << i << j;
      }
      if (mine.conditioning && theirs.conditioning && GetParam() != "2t1r-p-hybrid") {
        EXPECT_NEAR(*mine.conditioning, *theirs.conditioning, 1e-9);
        ++compared.conditioned;
      }
    }
  }
};

TEST_P(PaperMechanism, HasTheSameNames) {
  for (const Parameter& p : own().info().parameters) {
    if (p.name == "theta0") continue;
    const Parameter* const same = find_named(file().info().parameters, p.name);
    ASSERT_TRUE(same) << p.name;
    EXPECT_EQ(same->unit, p.unit) << p.name;
    EXPECT_NEAR(same->nominal, p.nominal, 1e-15) << p.name;
    EXPECT_EQ(same->lower, p.lower) << p.name;
    EXPECT_EQ(same->upper, p.upper) << p.name;
  }
  for (const LimitInfo& limit : own().info().limits) {
    const LimitInfo* const same = find_named(file().info().limits, limit.name);
    ASSERT_TRUE(same) << limit.name;
    EXPECT_EQ(same->unit, limit.unit) << limit.name;
    EXPECT_EQ(same->group, limit.group) << limit.name;
    EXPECT_NEAR(same->inactive, limit.inactive, 1e-15) << limit.name;
    EXPECT_EQ(same->derivation.empty(), limit.derivation.empty()) << limit.name;
  }
  std::set<std::string> modes;
  for (const std::string& mode : file().info().modes) modes.insert(own_mode(mode));
  EXPECT_EQ(modes, std::set<std::string>(own().info().modes.begin(), own().info().modes.end()));
  EXPECT_EQ(own_mode(file().info().modes.front()), own().info().modes.front());
}

TEST_P(PaperMechanism, AgreesOnGoldenPosesInEveryMode) {
  const LimitSpec limits = without_clearance(no_limits(own().info()));
  Compared compared;
  for (const GoldenPose& golden : golden_poses()) expect_same(golden.design, golden.pose, limits, compared);
  EXPECT_GT(compared.joints, 100);
  EXPECT_GT(compared.feasible, 5);
  EXPECT_GT(compared.slopes, 400);
  EXPECT_EQ(compared.conditioned > 20, GetParam() != "2t1r-p-hybrid");
  EXPECT_EQ(compared.cleared > 20, GetParam() != "2t1r-p-hybrid");  // it has a margin for each pair
}

TEST_P(PaperMechanism, AgreesOnRandomPosesUnderRandomLimits) {
  const MechanismInfo& info = own().info();
  Stream random(11, 0, 0, Stream::Use::start);
  Compared compared;
  for (int i = 0; i < 200; ++i) {
    const bool nominal = i % 2 == 0;
    const std::vector<double> design = nominal ? test::nominal(info) : test::random_design(info, random);
    const LimitSpec limits = without_clearance(test::random_limits(info, random));
    Pose<double> pose(4);
    const auto ranges = *file().ranges(of_file(design));
    for (std::size_t k = 0; k < 4; ++k) pose[k] = ranges[k][0] + (ranges[k][1] - ranges[k][0]) * random.u01();
    expect_same(design, pose, limits, compared);

    std::vector<double> mine(file().info().limits.size()), theirs(info.limits.size());
    file().thresholds(of_file(design), of_file(limits), mine);
    own().thresholds(design, limits, theirs);
    for (std::size_t k = 0; k < mine.size(); ++k) {
      const auto at =
          static_cast<std::size_t>(find_named(info.limits, file().info().limits[k].name) - info.limits.data());
      EXPECT_NEAR(mine[k], theirs[at], 1e-15) << info.limits[at].name;
    }
    if (const Size* const size = own().size()) {
      EXPECT_NEAR(file().size()->of(of_file(design)) / size->of(design), 1, 1e-14);
    }
  }
  EXPECT_GT(compared.joints, 200);
  EXPECT_GT(compared.feasible, 3);
  EXPECT_GT(compared.slopes, 800);
}

TEST_P(PaperMechanism, TestsDesignsAlike) {
  if (!own().design_tests()) GTEST_SKIP() << "there are none";
  Stream random(12, 0, 0, Stream::Use::start);
  const auto& tests = own().design_tests()->list();
  ASSERT_EQ(file().design_tests()->list().size(), tests.size());
  for (int i = 0; i < 50; ++i) {
    const std::vector<double> design = test::random_design(own().info(), random);
    const LimitSpec limits = test::random_limits(own().info(), random);
    std::vector<double> mine(tests.size()), theirs(tests.size());
    file().design_tests()->test(of_file(design), of_file(limits), mine);
    own().design_tests()->test(design, limits, theirs);
    for (std::size_t k = 0; k < tests.size(); ++k) {
      EXPECT_EQ(file().design_tests()->list()[k].name, tests[k].name);
      EXPECT_EQ(mine[k] >= 0, theirs[k] >= 0) << tests[k].name;
    }
  }
}

TEST_P(PaperMechanism, HasTheSameCellsOnEveryGoldenGrid) {
  const auto grids = golden_grids();
  ASSERT_GT(grids.size(), 1u);
  for (const GoldenGrid& grid : grids) {
    SurveyPlan mine{.method = grid.voxels, .held = grid.held, .limits = of_file(grid.limits)},
        theirs{.method = grid.voxels, .held = grid.held, .limits = grid.limits};
    const VoxelMap here = voxel_map(file(), of_file(grid.design), mine), there = voxel_map(own(), grid.design, theirs);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(here.lower[k], there.lower[k], 1e-14);
      EXPECT_NEAR(here.upper[k], there.upper[k], 1e-14);
    }
    EXPECT_TRUE(here.feasible == there.feasible);
    EXPECT_GT(std::ranges::count(there.feasible, 1), 0);
    const Survey<double> survey = test::survey(file(), of_file(grid.design), mine);
    EXPECT_EQ(survey.feasible_cells, std::ranges::count(here.feasible, 1));
    if (grid.feasible >= 0) {
      EXPECT_EQ(survey.feasible_cells, grid.feasible);
    }
    EXPECT_NEAR(survey.volume, test::survey(own(), grid.design, theirs).volume, 1e-12 * survey.volume);
  }
}

TEST_P(PaperMechanism, HasTheSameCellsUnderAClearance) {
  std::int64_t cut = 0, left = 0;
  for (const double least : {0.0, 0.0041, 0.0207})  // round numbers are distances of some cells, but for roundoff
    for (GoldenGrid& grid : golden_grids()) {
      SurveyPlan mine{.method = grid.voxels, .held = grid.held, .limits = of_file(grid.limits)};
      const auto all = std::ranges::count(voxel_map(file(), of_file(grid.design), mine).feasible, 1);
      for (std::size_t i = 0; i < grid.limits.given.size(); ++i)
        if (own().info().limits[i].group == "clearance") grid.limits.given[i] = least;
      mine.limits = of_file(grid.limits);
      const SurveyPlan theirs{.method = grid.voxels, .held = grid.held, .limits = grid.limits};
      const VoxelMap here = voxel_map(file(), of_file(grid.design), mine),
                     there = voxel_map(own(), grid.design, theirs);
      EXPECT_TRUE(here.feasible == there.feasible) << least;
      const auto count = std::ranges::count(here.feasible, 1);
      EXPECT_EQ(test::survey(file(), of_file(grid.design), mine).feasible_cells, count);
      cut += all - count;
      left += count;
    }
  EXPECT_GT(cut, 0);
  EXPECT_GT(left, 0);
}

/// Largest difference of two matrices over the largest element.
template <class M>
double off(const M& mine, const M& theirs) {
  double difference = 0, largest = 0;
  for (std::size_t k = 0; k < theirs.size(); ++k) {
    difference = std::fmax(difference, std::fabs(mine[k] - theirs[k]));
    largest = std::fmax(largest, std::fabs(theirs[k]));
  }
  return largest > 0 ? difference / largest : difference;
}

TEST_P(PaperMechanism, HasTheSameForcesAndInertiaOnGoldenPosesInEveryMode) {
  if (!own().dynamics()) GTEST_SKIP() << "no masses";
  const AxisVector<double> rates = {0.4, -0.3, 0.2, 1.1}, acceleration = {3, -5, 4, 12};
  const Wrench<double> wrench{{7, -3, 5, 0.2, -0.4, 0.3}};
  int compared = 0;
  std::vector<GoldenPose> poses = golden_poses();
  for (const double payload : {0.0, 0.4})
    for (GoldenPose& golden : poses) {
      for (const auto& [name, value] : std::map<std::string, double>{{"m_p", payload}, {"c_p", payload / 10}})
        golden.design[static_cast<std::size_t>(find_named(own().info().parameters, name) -
                                               own().info().parameters.data())] = value;
      for (const std::string& mode : file().info().modes) {
        const MotionState<double> state{golden.pose, rates};
        PoseDynamics<double> mine, theirs;
        file().dynamics()->equations(std::span<const double>(of_file(golden.design)), mode, {&state, 1}, {&mine, 1});
        own().dynamics()->equations(std::span<const double>(golden.design), own_mode(mode), {&state, 1}, {&theirs, 1});
        if (!mine.assembles || !theirs.assembles || is_singular(theirs.J)) continue;
        const AxisMatrix<double> M_q = joint_inertia(theirs);
        if (!std::ranges::all_of(M_q, [](double x) { return std::fabs(x) < 1e4; })) continue;  // a limb is stretched
        EXPECT_LE(off(joint_inertia(mine), M_q), 1e-10) << mode;
        EXPECT_LE(off(coupling_indices(joint_inertia(mine)), coupling_indices(M_q)), 1e-10) << mode;
        EXPECT_LE(off(drive_forces(mine, acceleration, wrench), drive_forces(theirs, acceleration, wrench)), 1e-10);
        EXPECT_LE(off(joint_space(mine).c_q, joint_space(theirs).c_q), 1e-9) << mode;
        EXPECT_LE(off(joint_space(mine).G_q, joint_space(theirs).G_q), 1e-10) << mode;
        ++compared;
      }
    }
  EXPECT_GT(compared, 100);
}

TEST_P(PaperMechanism, HasTheSameCouplingOverEveryGoldenGrid) {
  if (!own().dynamics()) GTEST_SKIP() << "no masses";
  for (const GoldenGrid& grid : golden_grids()) {
    SurveyPlan mine{.method = grid.voxels, .held = grid.held, .limits = of_file(grid.limits)},
        theirs{.method = grid.voxels, .held = grid.held, .limits = grid.limits};
    const Demand demand{.fields = {&kCouplingIndex, &kInertiaCondition}};
    const Survey<double> here = test::survey(file(), of_file(grid.design), mine, demand),
                         there = test::survey(own(), grid.design, theirs, demand);
    ASSERT_EQ(here.weight.size(), there.weight.size());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(weighted_mean(here.weight, here.of(kCouplingIndex, i)),
                  weighted_mean(there.weight, there.of(kCouplingIndex, i)), 1e-10);
      EXPECT_NEAR(weighted_deviation(here.weight, here.of(kCouplingIndex, i)),
                  weighted_deviation(there.weight, there.of(kCouplingIndex, i)), 1e-8);
      EXPECT_NEAR(weighted_quantile(here.weight, here.of(kCouplingIndex, i), 0.95),
                  weighted_quantile(there.weight, there.of(kCouplingIndex, i), 0.95), 1e-8);
    }
    EXPECT_NEAR(weighted_mean(here.weight, here.of(kInertiaCondition)),
                weighted_mean(there.weight, there.of(kInertiaCondition)), 1e-10);
  }
}

/// Random designs with and without limits, to the closed forms' volumes; where columns of the file say that they know
/// no better, to what they say.
TEST_P(PaperMechanism, HasTheSameExactVolumes) {
  const MechanismInfo& info = own().info();
  Stream random(13, 0, 0, Stream::Use::start);
  const SurveyPlan usual = test::columns(file().info()), closed = test::columns(info);
  Scratch scratch;
  Survey<double> mine, theirs;
  int compared = 0, exact = 0;
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> design = i == 0 ? test::nominal(info) : test::random_design(info, random);
    const LimitSpec limits = i % 2 == 0 ? no_limits(info) : test::random_limits(info, random);
    SurveyPlan here = usual, there = closed;
    there.limits = without_clearance(limits);
    here.limits = of_file(there.limits);
    prepare_survey(file(), here, {})->survey(of_file(design), scratch, mine);
    prepare_survey(own(), there, {})->survey(design, scratch, theirs);
    SCOPED_TRACE("design " + std::to_string(i));
    EXPECT_NEAR(mine.volume, theirs.volume, (1e-7 + mine.error + theirs.error) * theirs.volume + 1e-12);
    compared += theirs.volume > 0;
    exact += theirs.volume > 0 && mine.error < 1e-7;
  }
  EXPECT_GT(compared, 30);
  EXPECT_GT(exact, 0.95 * compared);
}

/// Along four directions of all parameters, from nodes of their own.
TEST_P(PaperMechanism, HasTheSameSlopesOfSamples) {
  const MechanismInfo& info = own().info();
  if (GetParam() != "3crr-r-cru") GTEST_SKIP() << "the mean is infinite, or takes more nodes along other coordinates";
  // Far from where limbs stretch and fold, and inertia runs to infinity.
  static const std::map<std::string, double> limits = {{"s_min", 0.3}, {"c_min", 0.2}};
  SurveyPlan there = test::columns(info, {.nodes = {24, 24}}), here = test::columns(file().info(), {.nodes = {24, 24}});
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (const auto limit = limits.find(info.limits[i].name); limit != limits.end())
      there.limits.given[i] = limit->second;
  here.limits = of_file(there.limits);
  Stream random(17, 0, 0, Stream::Use::start);
  std::vector<Dual4> moving;  // beside the nominal design, where nothing is symmetric
  for (const double p : test::nominal(info)) {
    moving.emplace_back(p * (1 + 0.02 * random.u01()));
    for (int k = 0; k < 4; ++k) moving.back().v[k] = (2 * random.u01() - 1) * p;
  }
  std::vector<Dual4> of_file;
  for (const Parameter& p : file().info().parameters)
    of_file.push_back(moving[static_cast<std::size_t>(find_named(info.parameters, p.name) - info.parameters.data())]);
  const Demand demand{.fields = {&test::kOwnInertia}};
  Survey<Dual4> mine, theirs;
  survey_once<Dual4>(*prepare_survey(file(), here, demand), of_file, mine);
  survey_once<Dual4>(*prepare_survey(own(), there, demand), moving, theirs);
  for (std::size_t joint = 0; joint < info.joints.size(); ++joint) {
    const Dual4 here_mean = weighted_mean(mine.weight, mine.of(test::kOwnInertia, joint)),
                there_mean = weighted_mean(theirs.weight, theirs.of(test::kOwnInertia, joint));
    EXPECT_GT(there_mean.a, 0);
    EXPECT_NEAR(here_mean.a / there_mean.a, 1, 1e-6);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(here_mean.v[k] / there_mean.a, there_mean.v[k] / there_mean.a, 1e-6) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, PaperMechanism, test::kPapers,
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
