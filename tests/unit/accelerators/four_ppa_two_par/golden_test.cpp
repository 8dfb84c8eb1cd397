// All golden cases of 4PPa-2PaR, the paper's tables and its two designs.
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/math/dual.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

SchoenfliesPose<double> pose_of(const nlohmann::json& p) { return {p[0], p[1], p[2], p[3]}; }

double distance(const SchoenfliesPose<double>& a, const SchoenfliesPose<double>& b) {
  return std::max({std::fabs(a.x - b.x), std::fabs(a.y - b.y), std::fabs(a.z - b.z), std::fabs(a.angle - b.angle)});
}

TEST(FourPpaGolden, KinematicsOfEveryCase) {
  // J_q is made of the joints alone: z_c from q loses digits where C_j is near its rail.
  constexpr double kRoundoff = 1e-13, kRoundoffOfJq = 1e-12;
  for (const auto& entry : golden()["kinematics"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const auto word = [](int mode) { return std::string(mode == 1 ? "lower" : "upper"); };
    const std::string mode = word(entry["modes"][0]) + "," + word(entry["modes"][1]);
    const PoseReport r = four_ppa().inspect(p, pose_of(entry["pose"]), mode, no_limits(four_ppa().info()));
    ASSERT_TRUE(r.assembles) << r.reason;
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR((*r.joints)[static_cast<std::size_t>(i)], entry["q"][i].get<double>(), kRoundoff);
      for (int j = 0; j < 4; ++j) {
        const double jq = entry["Jq"][i][j];
        EXPECT_NEAR((*r.Jq)(i, j), jq, kRoundoffOfJq * (1 + std::fabs(jq)));
        EXPECT_NEAR((*r.G)(i, j), entry["G"][i][j].get<double>(), kRoundoff);
      }
    }
    for (int j = 0; j < 2; ++j) {
      const std::string n = std::to_string(j + 1);
      EXPECT_NEAR(named(r.angles, "alpha_" + n), entry["alpha"][j].get<double>(), kRoundoff);
      EXPECT_NEAR(named(r.angles, "beta_" + n), entry["beta"][j].get<double>(), kRoundoff);
      EXPECT_NEAR(named(r.angles, "z_c_" + n), entry["z_c"][j].get<double>(), kRoundoff);
    }
    EXPECT_NEAR(*r.det_Jq / entry["det_Jq"].get<double>(), 1, 1e-12);
    EXPECT_NEAR(*r.det_G, entry["det_G"].get<double>(), kRoundoff);

    const auto q = entry["q"];
    const auto modes = four_ppa().forward()->assemblies(p, {q[0], q[1], q[2], q[3]});
    std::size_t usual = 0;
    for (const auto& m : modes) usual += m.usual;
    EXPECT_EQ(usual, entry["fk_all"].size());
    for (const auto& expected : entry["fk_all"]) {
      double nearest = 1;
      for (const auto& m : modes)
        if (m.usual) nearest = std::min(nearest, distance(schoenflies(m.pose), pose_of(expected)));
      EXPECT_LT(nearest, 1e-12) << expected;
    }
  }
}

TEST(FourPpaGolden, VolumesAndGradientsOfEveryCase) {
  using Scalar = Dual<6>;
  const char* const keys[6] = {"a", "b", "lu", "ld", "d", "L0"};
  for (const auto& entry : golden()["workspace"]) {
    SCOPED_TRACE(entry["design"].dump());
    const auto p = design_of(entry);
    const LimitSpec limits_spec = limits_of(entry);
    const double exact = entry["volume_exact"];
    const auto found = survey(p, columns(limits_spec, at_y(entry["y"])));
    EXPECT_NEAR(found.volume / exact, 1, 1e-9);  // the golden values' own accuracy
    EXPECT_LE(found.error, 1e-10);

    std::vector<Scalar> moving(p.begin(), p.end());
    for (int i = 0; i < 6; ++i) moving[static_cast<std::size_t>(i)].v[i] = 1;
    const auto g = geometry(std::span<const Scalar>(moving));
    ColumnScratch<Scalar> scratch;
    const Scalar v = plane_volume(sliced_design(g, limits(g, limits_spec), Scalar(g.L0 * 0.5)), 1e-10, scratch).value;
    double largest = 0;
    for (const auto* key : keys) largest = std::max(largest, std::fabs(entry["volume_gradient"][key].get<double>()));
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(v.v[i], entry["volume_gradient"][keys[i]].get<double>(), 1e-5 * largest) << keys[i];
  }
}

TEST(FourPpaGolden, VoxelCountsOfEveryCase) {
  for (const auto& entry : golden()["workspace"])
    for (const auto& grid : entry["voxel"]) {
      SCOPED_TRACE(entry["design"].dump());
      const auto& c = grid["cells"];
      const auto found = survey(design_of(entry), voxels(limits_of(entry), {c[0], c[1], c[2]}));
      EXPECT_EQ(found.feasible_cells, grid["feasible"].get<std::int64_t>());
      EXPECT_NEAR(found.volume / grid["volume"].get<double>(), 1, 1e-13);
      EXPECT_NEAR(found.cell_volume / grid["cell_volume"].get<double>(), 1, 1e-13);
    }
}

TEST(FourPpaGolden, VolumesOffTheMiddlePlane) {
  for (const auto& entry : golden()["off_plane"]) {
    const auto found = survey(design_of(entry), columns(limits_of(entry), at_y(entry["y"])));
    EXPECT_NEAR(found.volume / entry["volume"].get<double>(), 1, entry["tolerance"].get<double>());
  }
}

TEST(FourPpaPaper, TwoDesignsWithoutLimits) {
  const auto none = no_limits(four_ppa().info());
  auto p = nominal();
  EXPECT_NEAR(survey(p, columns(none)).volume, 0.550157374606, 1e-12);
  EXPECT_NEAR(survey(p, columns(none)).volume / four_ppa().size()->of(p), 0.1903484, 5e-8);
  EXPECT_EQ(survey(p, voxels(none, {32, 34, 60})).feasible_cells, 12412);
  EXPECT_NEAR(survey(p, voxels(none, {32, 34, 60})).volume, 0.549540, 5e-7);
  p[kA] = 0.3, p[kB] = 1.0, p[kLu] = 0.7, p[kLd] = 0.7;
  EXPECT_NEAR(survey(p, columns(none)).volume, 0.851292176055, 1e-12);
  EXPECT_NEAR(survey(p, columns(none)).volume / four_ppa().size()->of(p), 0.1935533683, 5e-11);
  EXPECT_EQ(survey(p, voxels(none, {32, 34, 60})).feasible_cells, 12564);
}

// Table 2: pose, then q for the branches, as the paper prints them, to 4 digits. The last row's q1 is printed as 0.9033
// in our copy, which contradicts its own q2: q1 + q2 = 2 y_1 = 2.8268 gives 0.9035.
TEST(FourPpaPaper, TableTwo) {
  struct Row {
    SchoenfliesPose<double> pose;
    const char* mode;
    std::array<double, 4> q;
  };
  const Row rows[] = {
      {{0.40, 1.25, -0.20, 0}, "lower,lower", {0.8129, 1.6871, 0.8129, 1.6871}},
      {{0.40, 1.25, -0.20, 0}, "upper,lower", {0.9355, 1.5645, 0.8129, 1.6871}},
      {{0.40, 1.25, -0.20, 0}, "lower,upper", {0.8129, 1.6871, 0.9355, 1.5645}},
      {{0.40, 1.25, -0.20, 0}, "upper,upper", {0.9355, 1.5645, 0.9355, 1.5645}},
      {{0.25, 0.85, -0.80, kPi / 6}, "lower,lower", {0.2131, 1.3869, 0.4154, 1.3846}},
      {{0.50, 1.50, -0.15, kPi / 3}, "upper,upper", {0.9035, 1.9233, 1.2402, 1.9330}},
  };
  for (const Row& row : rows) {
    // q depends on z_c^2: the paper prints it for poses whose C_j lies above the rail, too, which are not feasible.
    const PoseReport report = four_ppa().inspect(nominal(), row.pose, row.mode, no_limits(four_ppa().info()));
    ASSERT_TRUE(report.assembles) << report.reason;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((*report.joints)[i], row.q[i], 5.1e-5) << row.mode << " q" << i + 1;
  }
}

// Table 3: forward kinematics from the printed q (4 digits), so poses agree to the printed digits only.
TEST(FourPpaPaper, TableThree) {
  struct Row {
    AxisVector<double> q;
    std::vector<SchoenfliesPose<double>> poses;
  };
  const Row rows[] = {
      {{0.9355, 1.5645, 0.9355, 1.5645},
       {{0.4, 1.25, -0.2000, 0}, {0.4, 1.25, -1.1219, 0}, {0.4, 1.25, -0.4318, 3.1416}, {0.4, 1.25, -0.8901, 3.1416}}},
      {{0.2131, 1.3869, 0.4154, 1.3846},
       {{0.5501, 0.85, 0.0214, 0.5236},
        {0.2499, 0.85, -0.8000, 0.5236},
        {0.4526, 0.85, -0.1660, 2.6180},
        {0.3475, 0.85, -0.6125, 2.6180}}},
      {{0.9035, 1.9233, 1.2402, 1.9330},
       {{0.5000, 1.5, -0.1500, 1.0471},
        {0.3000, 1.5, -0.9561, 1.0471},
        {0.4576, 1.5, -0.2545, 2.0944},
        {0.3424, 1.5, -0.8516, 2.0944}}},
  };
  for (const Row& row : rows)
    for (const auto& expected : row.poses) {
      double nearest = 1;
      for (const auto& m : four_ppa().forward()->assemblies(nominal(), row.q))
        if (m.usual) nearest = std::min(nearest, distance(schoenflies(m.pose), expected));
      EXPECT_LT(nearest, 1.5e-4) << expected.x << " " << expected.z << " " << expected.angle;
    }
}

}  // namespace
}  // namespace pkm::testing
