// Clearance of (3CRR/R)&CRU and the Quadrupteron: where the links are, which pairs of them count, their distances
// against points distributed over them, and cells under a clearance limit against single poses.
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

constexpr const char* kNominalMode = "-,-,+,-";

/// Nominal lengths with other radii of rods, platforms and rails.
std::vector<double> with_radii(double rod, double platform, double rail) {
  auto p = nominal();
  p[kRadii] = rod;
  p[kRadii + 1] = platform;
  p[kRadii + 2] = rail;
  return p;
}

PoseReport report(const std::string& name, const std::vector<double>& p, const pkm::Pose<double>& pose,
                  std::optional<double> least = {}, const std::string& mode = kNominalMode) {
  return mechanism(name).inspect(p, pose, mode, limit_spec(0, 0, least));
}

double clearance_of(const PoseReport& r) {
  if (!r.assembles) throw std::logic_error(r.reason);
  return by_name(r.angles).at("clearance");
}

double distance(const Point3<double>& a, const Point3<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

struct Drawn {
  std::string name;
  std::vector<double> p;
  Pose<double> pose;
  std::string mode;
};

/// Random designs at poses that assemble, in all modes.
std::vector<Drawn> random_poses(int count, int seed) {
  Uniform uniform(seed);
  std::vector<Drawn> all;
  while (static_cast<int>(all.size()) < count) {
    const std::size_t n = all.size();
    Drawn drawn{both()[n % 2], random_design(uniform, 0.2), {}, {}};
    WorkingMode mode;
    for (int& sign : mode) sign = uniform(0, 1) < 0.5 ? -1 : 1;
    drawn.mode = mode_name(mode);
    drawn.pose = {uniform(0.05, 0.35), uniform(0.05, 0.35), uniform(0.05, 0.35), uniform(-1.2, 1.2)};
    if (!links(drawn.name, drawn.p, drawn.pose, drawn.mode).empty()) all.push_back(drawn);
  }
  return all;
}

/// The links that the links' clearance does not count together with each of them.
std::map<std::string, std::set<std::string>> joined(const std::string& name) {
  std::map<std::string, std::set<std::string>> others;
  for (const JoinedLinks& each : mechanism(name).links()->joined())
    others[each.link] = {each.others.begin(), each.others.end()};
  return others;
}

/// Calls visit(first, second) with the names of each pair of links that counts.
template <class Visit>
void for_counted_pairs(const std::string& name, const Visit& visit) {
  const auto others = joined(name);
  for (auto first = others.begin(); first != others.end(); ++first)
    for (auto second = others.begin(); second != first; ++second)
      if (!first->second.contains(second->first)) visit(first->first, second->first);
}

TEST(CrrCruLinks, HaveTheirLengthsAndMeetInTheirJoints) {
  for (const Drawn& drawn : random_poses(200, 1)) {
    const auto g = geometry_of(drawn.name, drawn.p);
    const auto all = links(drawn.name, drawn.p, drawn.pose, drawn.mode);
    const auto axis = [&](const std::string& link) { return all.at(link).axis; };
    const auto length = [&](const std::string& link) { return distance(axis(link).from, axis(link).to); };
    const Point3<double> D = {drawn.pose.x, drawn.pose.y, drawn.pose.z};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string n = std::to_string(i + 1), inner = "rod " + n + "1", outer = "rod " + n + "2";
      EXPECT_NEAR(length(inner), g.l_1[i], kRoundoff);
      EXPECT_NEAR(length(outer), g.l_2[i], kRoundoff);
      EXPECT_EQ(distance(axis(inner).to, axis(outer).from), 0);
      EXPECT_NEAR(length("rail " + n), g.rho_max - g.rho_min, kRoundoff);
      // the slide is on the line of the rail
      for (std::size_t k = 0; k < 3; ++k)
        if (k != kLimbs[i].e) {
          EXPECT_NEAR(axis(inner).from[k], axis("rail " + n).from[k], kRoundoff);
        }
      EXPECT_EQ(distance(axis("slide " + n).from, axis(inner).from), 0);
      EXPECT_NEAR(length("arm " + n), i == 3 ? g.l : g.r, kRoundoff);
      EXPECT_EQ(distance(axis("arm " + n).to, axis(outer).to), 0);
    }
    EXPECT_NEAR(length("post"), g.h, kRoundoff);
    EXPECT_NEAR(distance(axis("post").to, D), 0, kRoundoff);
    EXPECT_NEAR(distance(axis("arm 4").from, D), 0, kRoundoff);
    EXPECT_EQ(all.at("rod 11").radius, drawn.p[kRadii]);
    EXPECT_EQ(all.at("post").radius, drawn.p[kRadii + 1]);
    EXPECT_EQ(all.at("rail 1").radius, drawn.p[kRadii + 2]);
  }
}

TEST(CrrCruLinks, PairsThatAreNotJoinedCount) {
  for (const std::string& name : both()) {
    // 24 pairs of rods, 36 of rods and arms or post, 24 of rods and rails, 20 of rails and arms or post
    int pairs = 0;
    for_counted_pairs(name, [&](const std::string&, const std::string&) { ++pairs; });
    EXPECT_EQ(pairs, 104);
    const auto others = joined(name);
    const auto counts = [&](const std::string& a, const std::string& b) {
      EXPECT_EQ(others.at(a).contains(b), others.at(b).contains(a));
      return !others.at(a).contains(b);
    };
    EXPECT_FALSE(counts("rod 11", "rod 12"));
    EXPECT_TRUE(counts("rod 12", "rod 42"));
    EXPECT_FALSE(counts("rod 12", "arm 1"));  // jointed in C_1
    EXPECT_FALSE(counts("rod 42", "arm 4"));  // jointed in C_4
    EXPECT_TRUE(counts("rod 41", "arm 4"));
    EXPECT_TRUE(counts("rod 12", "arm 4"));     // the arm passes over C_1
    EXPECT_FALSE(counts("post", "arm 4"));      // meet in D
    EXPECT_FALSE(counts("rod 11", "rail 1"));   // slides on it
    EXPECT_TRUE(counts("rod 11", "rail 2"));    // of another limb
    EXPECT_FALSE(counts("rail 1", "rail 2"));   // do not move
    EXPECT_FALSE(counts("slide 1", "rod 21"));  // drawn only
  }
}

TEST(CrrCruClearance, IsTheLeastDistanceOfPointsStrewnOverTheLinks) {
  constexpr int kPoints = 60;
  for (const Drawn& drawn : random_poses(30, 2)) {
    const auto all = links(drawn.name, drawn.p, drawn.pose, drawn.mode);
    const auto point = [&](const std::string& link, int k) {
      const auto& [from, to] = all.at(link).axis;
      const double t = static_cast<double>(k) / kPoints;
      return Point3<double>{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]),
                            from[2] + t * (to[2] - from[2])};
    };
    double least = 10, spacing = 0;
    for_counted_pairs(drawn.name, [&](const std::string& first, const std::string& second) {
      for (const std::string& link : {first, second})
        spacing = std::max(spacing, distance(point(link, 0), point(link, 1)));
      const double radii = all.at(first).radius + all.at(second).radius;
      for (int a = 0; a <= kPoints; ++a)
        for (int b = 0; b <= kPoints; ++b) least = std::min(least, distance(point(first, a), point(second, b)) - radii);
    });
    const double found = clearance_of(report(drawn.name, drawn.p, drawn.pose, {}, drawn.mode));
    EXPECT_LE(found, least + kRoundoff);
    EXPECT_GE(found, least - spacing);
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
  EXPECT_EQ(broken.reason, "clearance_min is violated: rod 12 and arm 4 are too near");
  EXPECT_TRUE(report("3crr-r-cru", p, pose, 0.005).feasible);
  EXPECT_EQ(report("3crr-r-cru", with_radii(0.02, 0.02, 0), pose, 0).reason,
            "clearance_min is violated: rod 12 and arm 4 overlap");
  for (const auto& margin : report("3crr-r-cru", p, pose).margins) EXPECT_NE(margin.first, "clearance_min");
}

TEST(CrrCruClearance, VoxelsAreThePosesThatAreClear) {
  std::int64_t cut = 0, left = 0;
  for (const auto& name : both())
    for (const int held : {3, 0, 2}) {
      const auto p = with_radii(0.008, 0.006, 0.012);
      const double value = held == 3 ? 0.4 : 0.2;
      VoxelOptions grid{.cells = {11, 12, 13}};
      const VoxelMap all = voxel_map(mechanism(name), p, plan(grid, held, value, limit_spec(0.1, 0.1)));
      grid.box = Box{};
      for (std::size_t k = 0; k < 3; ++k) (*grid.box)[k] = {all.lower[k], all.upper[k]};
      const WorkspacePlan limited = plan(grid, held, value, limit_spec(0.1, 0.1, 0.002));
      const VoxelMap map = voxel_map(mechanism(name), p, limited);
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
      const auto found = survey(name, p, limited, {.fields = {&kConditioning, &kCouplingIndex}});
      EXPECT_EQ(found.feasible_cells, count);
      EXPECT_EQ(static_cast<std::int64_t>(found.field(kCouplingIndex, 0).size()), count);
      EXPECT_NEAR(found.volume, static_cast<double>(count) * found.cell_volume, kRoundoff);
    }
  EXPECT_GT(cut, 200);
  EXPECT_GT(left, 200);
}

// The accelerators do not know clearances: voxels are those of the generic engine, columns are refused.
TEST(CrrCruClearance, ColumnsAreRefused) {
  const auto message = [](const WorkspacePlan& plan, const FieldRequest& request) {
    try {
      prepare_workspace(mechanism("quadrupteron"), plan, request);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const auto under = [](const auto& method, double least) { return plan(method, 3, 0, limit_spec(0, 0, least)); };
  const ColumnOptions columns{.tolerance = 1e-10};
  EXPECT_EQ(message(under(columns, 0), {}),
            "mechanism quadrupteron has no exact columns with a clearance limit (clearance_min), because the distance "
            "of two links is not given by a formula; set workspace.method = \"voxels\"");
  EXPECT_EQ(message(under(columns, -2), {}), "accepted") << "it cuts nothing";
  EXPECT_EQ(message(under(VoxelOptions{.cells = {4, 4, 4}}, 0), {.fields = {&kCouplingIndex}, .mode = "+,+,+,+"}),
            "accepted");
}

TEST(CrrCruClearance, IsAMarginOfPosesWithDerivatives) {
  Uniform uniform(5);
  const auto margin = [](const std::string& name, const auto& p, const pkm::Pose<double>& pose) {
    using S = typename std::remove_cvref_t<decltype(p)>::value_type;
    std::vector<S> margins;
    Scratch scratch;
    mechanism(name).pose_margins()->append(p, "", limit_spec(0, 0, 0.003), {&pose, 1}, scratch, margins);
    return margins.back();
  };
  int compared = 0;
  for (const Drawn& drawn : random_poses(200, 4)) {
    const auto& p = drawn.p;
    const auto values = quantities(drawn.name, p, drawn.pose, kNominalMode);
    bool regular = true;
    for (const char* sine : {"sin_theta_12", "sin_theta_22", "sin_theta_32", "sin_theta_42"})
      regular = regular && std::fabs(values.at(sine)) >= 0.3;
    if (!regular) continue;
    EXPECT_NEAR(margin(drawn.name, p, drawn.pose), clearance_of(report(drawn.name, p, drawn.pose)) - 0.003, kRoundoff);
    std::vector<Dual4> moving(p.begin(), p.end());
    std::vector<double> direction;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const bool is_of_links = i < kParameters || (i >= kRadii && i < kFirstOfModel);
      direction.push_back(is_of_links ? p[i] * uniform(-1, 1) : 0);
      moving[i].v[0] = direction[i];
    }
    const auto at = [&](double t) {
      auto moved = p;
      for (std::size_t i = 0; i < p.size(); ++i) moved[i] += t * direction[i];
      return margin(drawn.name, moved, drawn.pose);
    };
    const double exact = margin(drawn.name, moving, drawn.pose).v[0];
    const double left = (at(0) - at(-1e-6)) / 1e-6, right = (at(1e-6) - at(0)) / 1e-6;
    if (std::fabs(left - right) > 1e-3) continue;  // another pair becomes the nearest
    EXPECT_NEAR(exact, (left + right) / 2, 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace pkm::testing::crr
