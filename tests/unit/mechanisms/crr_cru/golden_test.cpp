// (3CRR/R)&CRU and Quadrupteron: every golden case of kinematics, reach and feasible voxels, the check values of the
// model's document, and its errata in numbers.
#include "tests/unit/mechanisms/crr_cru/golden.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "engine/mechanisms/crr_cru/yaw.hpp"

namespace pkm::testing::crr {
namespace {

using crr_cru::Influence;

TEST(CrrCruGolden, PosesOfEveryCase) {
  for (const auto& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto p = design_of(entry);
    const std::string name = entry["mechanism"];
    const WorkingMode mode = mode_of(entry["sigma"]);
    const PoseReport r = mechanism(name).inspect(p, pose_of(entry["X"]), mode_name(mode), limit_spec(0, 0));
    ASSERT_TRUE(r.assembles) << r.reason;
    std::map<std::string, double> angles(r.angles.begin(), r.angles.end());
    std::map<std::string, double> indices(r.indices.begin(), r.indices.end());
    for (int i = 0; i < 4; ++i) {
      const std::string n = std::to_string(i + 1);
      EXPECT_NEAR((*r.joints)[static_cast<std::size_t>(i)], entry["q"][i].get<double>(), kRoundoff);
      EXPECT_NEAR(angles["theta_" + n + "1"], entry["theta1"][i].get<double>(), kRoundoff);
      EXPECT_NEAR(angles["theta_" + n + "2"], entry["theta2"][i].get<double>(), kRoundoff);
      for (int j = 0; j < 4; ++j) EXPECT_NEAR((*r.J)(i, j), entry["J"][i][j].get<double>(), kRoundoff);
    }
    EXPECT_NEAR(indices["det_J"], entry["det_J"].get<double>(), kRoundoff);
    EXPECT_NEAR(indices["kappa_p"], entry["parallel_index"].get<double>(), kRoundoff);

    const Limbs<double> limbs = inverse(geometry_of(name, p), pose_of(entry["X"]), mode);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(limbs.limb[i].B[k], entry["B"][i][k].get<double>(), kRoundoff);
        EXPECT_NEAR(limbs.limb[i].C[k], entry["C"][i][k].get<double>(), kRoundoff);
      }
  }
}

TEST(CrrCruGolden, RatesOfEveryCase) {
  for (const auto& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto g = geometry_of(entry["mechanism"], design_of(entry));
    const Limbs<double> limbs = inverse(g, pose_of(entry["X"]), mode_of(entry["sigma"]));
    const auto &V = entry["Xd"], &W = entry["Xdd"];
    const Vector<double, 4> v{{V[0], V[1], V[2], V[3]}}, w{{W[0], W[1], W[2], W[3]}};
    const Influence<double> q = influence(limbs.arm);
    const Vector<double, 4> speed = q.G * v, acceleration = accelerations(q, v, w);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t limb = i;
      EXPECT_NEAR(speed[i], entry["qd"][i].get<double>(), kRoundoff * 10);
      EXPECT_NEAR(acceleration[i], entry["qdd"][i].get<double>(), kRoundoff * 100);
      const auto& arm = limbs.arm[limb];
      const double turn = arm.turns ? v[3] : 0, spin = arm.turns ? w[3] : 0, x = arm.to_joint[0], y = arm.to_joint[1];
      const RodRates<double> rates =
          rod_rates(g, limb, limbs.limb[limb], {v[0] - turn * y, v[1] + turn * x, v[2]},
                    {w[0] - spin * y - turn * turn * x, w[1] + spin * x - turn * turn * y, w[2]});
      for (std::size_t rod = 0; rod < 2; ++rod) {
        const double omega = entry["rod_omega"][2 * limb + rod], eps = entry["rod_eps"][2 * limb + rod];
        EXPECT_NEAR(kLimbs[limb].sense * rates.velocity[rod], omega, kRoundoff * (1 + std::fabs(omega)));
        EXPECT_NEAR(kLimbs[limb].sense * rates.acceleration[rod], eps, 10 * kRoundoff * (1 + std::fabs(eps)));
      }
    }
  }
}

TEST(CrrCruGolden, ReachAndFeasibilityOfEveryCase) {
  int feasible_ones = 0;
  for (const auto& entry : golden()["feasibility"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto p = design_of(entry);
    const Mechanism& m = mechanism(entry["mechanism"]);
    const PoseReport r = m.inspect(p, pose_of(entry["X"]), "-,-,+,-", limit_spec(0.2, 0.1));
    std::map<std::string, double> margins(r.margins.begin(), r.margins.end());
    std::map<std::string, double> indices(r.indices.begin(), r.indices.end());
    const Limbs<double> limbs = inverse(geometry_of(entry["mechanism"], p), pose_of(entry["X"]), {-1, -1, 1, -1});
    for (int i = 0; i < 4; ++i) {
      const std::string n = std::to_string(i + 1);
      const auto& d = limbs.limb[static_cast<std::size_t>(i)].d;
      EXPECT_NEAR(std::hypot(d[0], d[1]), entry["distance"][i].get<double>(), kRoundoff);
      EXPECT_EQ(margins["reach_" + n] >= 0, entry["reach_ok"][i].get<bool>());
      EXPECT_EQ(margins["stroke_" + n] >= 0, entry["slide_ok"][i].get<bool>());
      if (!entry["reach_ok"][i].get<bool>()) continue;
      EXPECT_NEAR(std::fabs(limbs.limb[static_cast<std::size_t>(i)].sin_2), entry["abs_sin_theta2"][i].get<double>(),
                  1e-11);
    }
    EXPECT_NEAR(indices["kappa_p"], entry["parallel_index"].get<double>(), kRoundoff);
    EXPECT_EQ(r.feasible, entry["feasible_s02_c01"].get<bool>());
    feasible_ones += r.feasible;
  }
  EXPECT_GT(feasible_ones, 0);
}

TEST(CrrCruGolden, BothBranchesOfEveryForwardCase) {
  for (const auto& entry : golden()["forward"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto& q = entry["q"];
    const auto modes = mechanism(entry["mechanism"]).forward()->assemblies(design_of(entry), {q[0], q[1], q[2], q[3]});
    ASSERT_EQ(modes.size(), entry["solutions"].size());
    for (std::size_t i = 0; i < modes.size(); ++i) {
      const Pose<double> expected = pose_of(entry["solutions"][i]);
      EXPECT_EQ(modes[i].mode, i == 0 ? "+" : "-");
      const Pose<double> found = schoenflies(modes[i].pose);
      EXPECT_NEAR(found.x, expected.x, kRoundoff);
      EXPECT_NEAR(found.y, expected.y, kRoundoff);
      EXPECT_NEAR(found.z, expected.z, kRoundoff);
      EXPECT_NEAR(found.angle, expected.angle, kRoundoff);
    }
  }
}

TEST(CrrCruGolden, FeasibleVoxelsOfEveryRegion) {
  for (const auto& entry : golden()["dci_stats"]) {
    VoxelOptions grid{.box = Box{}};
    for (std::size_t k = 0; k < 3; ++k) {
      grid.cells[k] = entry["n"][k];
      (*grid.box)[k] = {entry["lo"][k], entry["hi"][k]};
    }
    const SurveyPlan p = plan(grid, 3, entry["phi"], limit_spec(entry["smin"], entry["cmin"]));
    EXPECT_EQ(survey(entry["mechanism"], design_of(entry), p).feasible_cells, entry["feasible"].get<std::int64_t>());
  }
}

// The table of check values at X = (0.2, 0.17, 0.22, 0.3), and the nominal reaches in mm.
TEST(CrrCruDocument, CheckValues) {
  const std::map<std::string, std::array<double, 4>> q = {
      {"3crr-r-cru", {0.22, 0.17, 0.2, 0.189799853846}},
      {"quadrupteron", {0.208869609530, 0.158179191734, 0.2, 0.189799853846}}};
  for (const auto& [name, expected] : q) {
    const PoseReport r = mechanism(name).inspect(nominal(), {0.2, 0.17, 0.22, 0.3}, "-,-,+,-", limit_spec(0.2, 0.1));
    EXPECT_TRUE(r.feasible) << r.reason;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((*r.joints)[i], expected[i], 5e-13) << name << i;
  }
  const double reach[4][2] = {{55, 395}, {29, 445}, {44, 402}, {57, 389}};
  const auto g = geometry_of("3crr-r-cru", nominal());
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::fabs(g.l_1[i] - g.l_2[i]), reach[i][0] * 1e-3, kRoundoff);
    EXPECT_NEAR(g.l_1[i] + g.l_2[i], reach[i][1] * 1e-3, kRoundoff);
  }
}

// Errata 1 and 3: the printed beta_3 of limb 1 puts C_1 onto C_3's side of the circle, the printed rho_4 is off by
// 34.6 mm.
TEST(CrrCruDocument, ErrataOfThePublishedFormulas) {
  const auto p = nominal();
  const auto g = geometry_of("3crr-r-cru", p);
  const Limbs<double> limbs = inverse(g, {0.2, 0.17, 0.22, 0.3}, {-1, -1, 1, -1});
  EXPECT_NEAR(limbs.limb[0].C[1] - limbs.limb[2].C[1], 2 * g.r * std::sqrt(0.75), kRoundoff);
  EXPECT_NEAR(limbs.limb[0].C[0], limbs.limb[2].C[0], kRoundoff);
  const double printed = limbs.limb[1].rho + g.r * g.sin_beta[0] + g.l * std::sin(0.3);
  EXPECT_NEAR(printed - limbs.limb[3].rho, 34.6e-3, 5e-5);
}

// Erratum 5: the tangent half-angle is undefined where N + K = 0; the pose is an ordinary one.
TEST(CrrCruDocument, NoPoseIsLostToTheHalfAngleFormula) {
  auto p = nominal();
  const auto g = geometry_of("3crr-r-cru", p);
  // Limb 3, d = (d1, d2): N + K = 2 l1 d1 + |d|^2 + l1^2 - l2^2 = |d + (l1, 0)|^2 - l2^2 = 0 at theta_1 = pi
  const double l1 = g.l_1[2], l2 = g.l_2[2], turn = 1.1;
  const double x = -l1 + l2 * std::cos(turn), y = l2 * std::sin(turn);
  const auto limb = limb_at(g, 2, {x, y, 0.1}, turn > 0 ? -1 : 1);
  EXPECT_NEAR(std::fabs(atan2(limb.u1[1], limb.u1[0])), kPi, 1e-12);
  EXPECT_NEAR(limb.u2[0], std::cos(turn), 1e-12);
  EXPECT_NEAR(limb.u2[1], std::sin(turn), 1e-12);
}

}  // namespace
}  // namespace pkm::testing::crr
