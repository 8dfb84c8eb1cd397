// Clearance of (3CRR/R)&CRU and the Quadrupteron: where the links are, their distances against points strewn over
// them, and voxel surveys under a clearance limit against single poses.
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/mechanisms/crr_cru/links.hpp"
#include "tests/unit/mechanisms/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

const WorkingMode kNominalMode = {-1, -1, 1, -1};

std::size_t radius_index(std::size_t which) { return nominal().size() - kLinkRadii + which; }

/// Nominal lengths with other radii of rods, platforms and rails.
std::vector<double> with_radii(double rod, double platform, double rail) {
  auto p = nominal();
  p[radius_index(0)] = rod;
  p[radius_index(1)] = platform;
  p[radius_index(2)] = rail;
  return p;
}

PoseReport report(const std::string& name, const std::vector<double>& p, const Pose<double>& pose,
                  std::optional<double> least = {}, const WorkingMode& mode = kNominalMode) {
  return mechanism(name).inspect(p, pose, mode_name(mode), limit_spec(0, 0, least));
}

double clearance_of(const PoseReport& r) {
  for (const auto& [name, value] : r.angles)
    if (name == "clearance") return value;
  throw std::logic_error("the pose does not assemble: " + r.reason);
}

double distance(const Point3<double>& a, const Point3<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

struct Drawn {
  std::string name;
  std::vector<double> p;
  Pose<double> pose;
  WorkingMode mode;
};

/// Random designs at poses that assemble, in all modes.
std::vector<Drawn> random_poses(int count, int seed) {
  Uniform uniform(seed);
  std::vector<Drawn> all;
  while (static_cast<int>(all.size()) < count) {
    const std::size_t n = all.size();
    Drawn drawn{both()[n % 2], random_design(uniform, 0.2), {}, {}};
    for (int& sign : drawn.mode) sign = uniform(0, 1) < 0.5 ? -1 : 1;
    drawn.pose = {uniform(0.05, 0.35), uniform(0.05, 0.35), uniform(0.05, 0.35), uniform(-1.2, 1.2)};
    if (inverse(geometry_of(drawn.name, drawn.p), drawn.pose, drawn.mode).assembles) all.push_back(drawn);
  }
  return all;
}

TEST(CrrCruLinks, HaveTheirLengthsAndMeetInTheirJoints) {
  for (const Drawn& drawn : random_poses(200, 1)) {
    const auto g = geometry_of(drawn.name, drawn.p);
    const auto all = links(g, link_radii(std::span<const double>(drawn.p)), inverse(g, drawn.pose, drawn.mode));
    const auto length = [&](std::size_t link) { return distance(all[link].axis.from, all[link].axis.to); };
    const Point3<double> D = {drawn.pose.x, drawn.pose.y, drawn.pose.z};
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(length(2 * i), g.l_1[i], kRoundoff);
      EXPECT_NEAR(length(2 * i + 1), g.l_2[i], kRoundoff);
      EXPECT_EQ(distance(all[2 * i].axis.to, all[2 * i + 1].axis.from), 0);
      EXPECT_NEAR(length(kFirstRail + i), g.rho_max - g.rho_min, kRoundoff);
      // the slide is on the line of the rail
      const auto& rail = all[kFirstRail + i].axis;
      const auto& A = all[2 * i].axis.from;
      for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(k == kLimbs[i].e || A[k] == rail.from[k]);
      const std::size_t arm = i == 3 ? kArm4 : kFirstArm + i;
      EXPECT_NEAR(length(arm), i == 3 ? g.l : g.r, kRoundoff);
      EXPECT_EQ(distance(all[arm].axis.to, all[2 * i + 1].axis.to), 0);
    }
    EXPECT_NEAR(length(kPost), g.h, kRoundoff);
    EXPECT_NEAR(distance(all[kPost].axis.to, D), 0, kRoundoff);
    EXPECT_NEAR(distance(all[kArm4].axis.from, D), 0, kRoundoff);
    EXPECT_EQ(all[0].radius, drawn.p[radius_index(0)]);
    EXPECT_EQ(all[kPost].radius, drawn.p[radius_index(1)]);
    EXPECT_EQ(all[kFirstRail].radius, drawn.p[radius_index(2)]);
  }
}

TEST(CrrCruLinks, EveryPairIsTestedOnce) {
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const LinkPair& pair : kPairs) EXPECT_TRUE(seen.insert(std::minmax(pair.first, pair.second)).second);
  EXPECT_EQ(seen.size(), kLinkPairs);
  const auto tested = [&](std::size_t a, std::size_t b) { return seen.contains(std::minmax(a, b)); };
  EXPECT_FALSE(tested(0, 1));              // rods of one limb
  EXPECT_TRUE(tested(1, 7));               // rods 12 and 42
  EXPECT_FALSE(tested(1, kFirstArm));      // jointed in C_1
  EXPECT_FALSE(tested(7, kArm4));          // jointed in C_4
  EXPECT_TRUE(tested(6, kArm4));           // rod 41
  EXPECT_TRUE(tested(1, kArm4));           // the arm passes over C_1
  EXPECT_FALSE(tested(kPost, kArm4));      // meet in D
  EXPECT_FALSE(tested(0, kFirstRail));     // runs on it
  EXPECT_TRUE(tested(0, kFirstRail + 1));  // another limb's
  EXPECT_EQ(link_name(0, Platform::jointed), "rod 11");
  EXPECT_EQ(link_name(7, Platform::rigid), "rod 42");
  EXPECT_EQ(link_name(10, Platform::rigid), "rail 3");
  EXPECT_EQ(link_name(kPost, Platform::jointed), "middle platform");
  EXPECT_EQ(link_name(kArm4, Platform::jointed), "moving platform");
  EXPECT_EQ(link_name(kArm4, Platform::rigid), "platform");
}

TEST(CrrCruClearance, IsTheLeastDistanceOfPointsStrewnOverTheLinks) {
  constexpr int kPoints = 60;
  for (const Drawn& drawn : random_poses(30, 2)) {
    const auto g = geometry_of(drawn.name, drawn.p);
    const auto all = links(g, link_radii(std::span<const double>(drawn.p)), inverse(g, drawn.pose, drawn.mode));
    double least = 10, spacing = 0;
    for (const LinkPair& pair : kPairs) {
      const auto point = [&](std::size_t link, int k) {
        const auto& [from, to] = all[link].axis;
        const double t = static_cast<double>(k) / kPoints;
        return Point3<double>{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]),
                              from[2] + t * (to[2] - from[2])};
      };
      for (const std::size_t link : {pair.first, pair.second})
        spacing = std::max(spacing, distance(point(link, 0), point(link, 1)));
      for (int a = 0; a <= kPoints; ++a)
        for (int b = 0; b <= kPoints; ++b)
          least = std::min(least, distance(point(pair.first, a), point(pair.second, b)) - all[pair.first].radius -
                                      all[pair.second].radius);
    }
    const double found = clearance_of(report(drawn.name, drawn.p, drawn.pose, {}, drawn.mode));
    EXPECT_LE(found, least + kRoundoff);
    EXPECT_GE(found, least - spacing);
    for (const double limit : {found - 1e-9, found + 1e-9})
      EXPECT_EQ(keep_clear(all, limit, {}), limit < found) << limit;
  }
}

TEST(CrrCruClearance, GrowsWithTheLengths) {
  for (const Drawn& drawn : random_poses(50, 3)) {
    auto large = drawn.p;
    const auto& parameters = mechanism(drawn.name).info().parameters;
    for (std::size_t i = 0; i < large.size(); ++i)
      if (parameters[i].unit == "m") large[i] *= 3;
    const Pose<double> pose = {3 * drawn.pose.x, 3 * drawn.pose.y, 3 * drawn.pose.z, drawn.pose.angle};
    EXPECT_NEAR(clearance_of(report(drawn.name, large, pose, {}, drawn.mode)),
                3 * clearance_of(report(drawn.name, drawn.p, drawn.pose, {}, drawn.mode)), 1e-11);
  }
}

TEST(CrrCruClearance, ThePoseNamesThePairThatIsTooNear) {
  // At phi = beta_1 the arm D C_4 passes over C_1, h above it, where rod 12 ends.
  const Pose<double> pose = {0.2, 0.17, 0.22, kPi / 3};
  const auto p = with_radii(0.004, 0.005, 0.001);
  EXPECT_NEAR(clearance_of(report("3crr-r-cru", p, pose)), 0.020 - 0.009, 1e-3);
  const PoseReport broken = report("3crr-r-cru", p, pose, 0.012);
  EXPECT_FALSE(broken.feasible);
  EXPECT_EQ(broken.margins.back().first, "clearance_min");
  EXPECT_EQ(broken.reason, "limit clearance_min is broken: rod 12 and moving platform are too near");
  EXPECT_TRUE(report("3crr-r-cru", p, pose, 0.005).feasible);
  EXPECT_EQ(report("3crr-r-cru", with_radii(0.02, 0.02, 0), pose, 0).reason,
            "limit clearance_min is broken: rod 12 and moving platform overlap");
  for (const auto& margin : report("3crr-r-cru", p, pose).margins) EXPECT_NE(margin.first, "clearance_min");
}

// --- surveys

TEST(CrrCruClearance, VoxelsAreThePosesThatAreClear) {
  std::int64_t cut = 0, left = 0;
  for (const auto& name : both())
    for (const int held : {3, 0, 2}) {
      const auto p = with_radii(0.008, 0.006, 0.012);
      const LimitSpec limits = limit_spec(0.1, 0.1, 0.002);
      const double value = held == 3 ? 0.4 : 0.2;
      const VoxelOptions grid{.cells = {11, 12, 13}};
      const SurveyPlan with = plan(grid, held, value, limits);
      SurveyPlan without = with;
      without.limits = limit_spec(0.1, 0.1);
      const VoxelMap map = voxel_map(mechanism(name), p, with), all = voxel_map(mechanism(name), p, without);
      std::int64_t count = 0;
      for (std::size_t i = 0; i < map.feasible.size(); ++i) {
        EXPECT_LE(map.feasible[i], all.feasible[i]);
        if (!all.feasible[i]) continue;
        const auto at = static_cast<std::int64_t>(i);
        const std::array<std::int64_t, 3> cell = {at / (12 * 13), at / 13 % 12, at % 13};
        std::array<double, 4> x{};
        x[static_cast<std::size_t>(held)] = value;
        for (std::size_t k = 0, axis = 0; k < 4; ++k) {
          if (static_cast<int>(k) == held) continue;
          const double step = (map.upper[axis] - map.lower[axis]) / static_cast<double>(grid.cells[axis]);
          x[k] = map.lower[axis] + (static_cast<double>(cell[axis]) + 0.5) * step;
          ++axis;
        }
        const double clearance = clearance_of(report(name, p, {x[0], x[1], x[2], x[3]}));
        EXPECT_EQ(map.feasible[i] == 1, clearance >= 0.002) << clearance;
        count += map.feasible[i];
        ++(map.feasible[i] ? left : cut);
      }
      const auto found = survey(name, p, with, {.fields = {&kConditioning, &kCouplingIndex}});
      EXPECT_EQ(found.feasible_cells, count);
      EXPECT_EQ(static_cast<std::int64_t>(found.of(kCouplingIndex, 0).size()), count);
      EXPECT_NEAR(found.volume, static_cast<double>(count) * found.cell_volume, kRoundoff);
    }
  EXPECT_GT(cut, 200);
  EXPECT_GT(left, 200);
}

TEST(CrrCruClearance, ColumnsAndOtherModesAreRefused) {
  const auto message = [](const SurveyPlan& plan, const Demand& demand) {
    try {
      prepare_survey(mechanism("quadrupteron"), plan, demand);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto under = [](const auto& method, double least) { return plan(method, 3, 0, limit_spec(0, 0, least)); };
  const ColumnOptions columns{.tolerance = 1e-10};
  const VoxelOptions grid{.cells = {4, 4, 4}};
  EXPECT_EQ(message(under(columns, 0), {}),
            "mechanism quadrupteron has no column surveys under a clearance (clearance_min), because rods that meet "
            "end columns where no formula says; take workspace.method = \"voxels\"");
  EXPECT_EQ(message(under(columns, -2), {}), "accepted") << "it cuts nothing";
  EXPECT_EQ(message(under(grid, 0), {.fields = {&kCouplingIndex}, .mode = "-,-,+,-"}), "accepted");
  EXPECT_EQ(message(under(grid, 0), {.fields = {&kCouplingIndex}, .mode = "+,+,+,+"}),
            "mechanism quadrupteron surveys a clearance (clearance_min) in the mode -,-,+,- only, so inertia is not "
            "surveyed in the mode +,+,+,+ beside it");
}

TEST(CrrCruClearance, IsAMarginOfPosesWithDerivatives) {
  Uniform uniform(5);
  const auto margin = [](const std::string& name, const auto& p, const pkm::Pose<double>& pose) {
    using S = typename std::remove_cvref_t<decltype(p)>::value_type;
    std::vector<S> margins;
    mechanism(name).pose_margins()->append(p, "", limit_spec(0, 0, 0.003), {&pose, 1}, margins);
    EXPECT_EQ(margins.size(), 18u);
    return margins.back();
  };
  int compared = 0;
  for (const Drawn& drawn : random_poses(200, 4)) {
    const auto& p = drawn.p;
    const auto g = geometry_of(drawn.name, p);
    const auto limbs = inverse(g, drawn.pose, kNominalMode);
    if (std::ranges::any_of(limbs.limb, [](const auto& limb) { return std::fabs(limb.sin_2) < 0.3; })) continue;
    EXPECT_NEAR(margin(drawn.name, p, drawn.pose), clearance_of(report(drawn.name, p, drawn.pose)) - 0.003, kRoundoff);
    std::vector<Dual4> moving(p.begin(), p.end());
    std::vector<double> direction;
    for (std::size_t i = 0; i < p.size(); ++i) {
      direction.push_back(i < kParameters || i >= radius_index(0) ? p[i] * uniform(-1, 1) : 0);
      moving[i].v[0] = direction[i];
    }
    const auto at = [&](double t) {
      auto moved = p;
      for (std::size_t i = 0; i < p.size(); ++i) moved[i] += t * direction[i];
      return margin(drawn.name, moved, drawn.pose);
    };
    const double exact = margin(drawn.name, moving, drawn.pose).v[0];
    const double left = (at(0) - at(-1e-6)) / 1e-6, right = (at(1e-6) - at(0)) / 1e-6;
    if (std::fabs(left - right) > 1e-3) continue;  // another pair takes over
    EXPECT_NEAR(exact, (left + right) / 2, 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace pkm::testing::crr
