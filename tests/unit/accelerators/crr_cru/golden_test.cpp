// (3CRR/R)&CRU and Quadrupteron: every golden case of kinematics, reach and feasible voxels, the check values of the
// model's document, and its errata in numbers.
#include "tests/unit/accelerators/crr_cru/golden.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace pkm::testing::crr {
namespace {

std::string numbered(const std::string& before, std::size_t limb, const std::string& after = "") {
  return before + std::to_string(limb + 1) + after;
}

TEST(CrrCruGolden, PosesOfEveryCase) {
  for (const auto& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto p = design_of(entry);
    const std::string name = entry["mechanism"], mode = mode_name(mode_of(entry["sigma"]));
    const PoseReport r = mechanism(name).inspect(p, pose_of(entry["X"]), mode, limit_spec(0, 0));
    ASSERT_TRUE(r.assembles) << r.reason;
    const auto angles = by_name(r.angles), indices = by_name(r.indices);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR((*r.joints)[i], entry["q"][i].get<double>(), kRoundoff);
      EXPECT_NEAR(angles.at(numbered("theta_", i, "1")), entry["theta1"][i].get<double>(), kRoundoff);
      EXPECT_NEAR(angles.at(numbered("theta_", i, "2")), entry["theta2"][i].get<double>(), kRoundoff);
      for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR((*r.J)(i, j), entry["J"][i][j].get<double>(), kRoundoff);
    }
    EXPECT_NEAR(angles.at("det_J"), entry["det_J"].get<double>(), kRoundoff);
    EXPECT_NEAR(indices.at("kappa_p"), entry["parallel_index"].get<double>(), kRoundoff);

    const auto link = links(name, p, pose_of(entry["X"]), mode);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(link.at(numbered("rod ", i, "1")).axis.to[k], entry["B"][i][k].get<double>(), kRoundoff);
        EXPECT_NEAR(link.at(numbered("rod ", i, "2")).axis.to[k], entry["C"][i][k].get<double>(), kRoundoff);
      }
  }
}

// Those of the rods are compared with the equations of motion (CrrCruEquations.BodiesMoveAsTheGoldenOnes).
TEST(CrrCruGolden, RatesOfEveryCase) {
  for (const auto& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto q = mechanism(entry["mechanism"])
                       .velocities()
                       ->influence(design_of(entry), pose_of(entry["X"]), mode_name(mode_of(entry["sigma"])));
    ASSERT_TRUE(q);
    const AxisVector<double> v = vector_of(entry["Xd"]), speed = q->G * v,
                             acceleration = accelerations(*q, v, vector_of(entry["Xdd"]));
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(speed[i], entry["qd"][i].get<double>(), kRoundoff * 10);
      EXPECT_NEAR(acceleration[i], entry["qdd"][i].get<double>(), kRoundoff * 100);
    }
  }
}

TEST(CrrCruGolden, ReachAndFeasibilityOfEveryCase) {
  int feasible_ones = 0;
  for (const auto& entry : golden()["feasibility"]) {
    SCOPED_TRACE(entry["id"].dump());
    const auto p = design_of(entry);
    const std::string name = entry["mechanism"], mode = "-,-,+,-";
    const PoseReport r = mechanism(name).inspect(p, pose_of(entry["X"]), mode, limit_spec(0.2, 0.1));
    const auto margins = by_name(r.margins), values = quantities(name, p, pose_of(entry["X"]), mode);
    const auto g = geometry_of(name, p);
    for (std::size_t i = 0; i < 4; ++i) {
      const double reaches = margins.at(numbered("limb", i, " reaches")),
                   unfolds = margins.at(numbered("limb", i, " unfolds"));
      EXPECT_NEAR(g.l_1[i] + g.l_2[i] - reaches, entry["distance"][i].get<double>(), kRoundoff);
      EXPECT_NEAR(std::fabs(g.l_1[i] - g.l_2[i]) + unfolds, entry["distance"][i].get<double>(), kRoundoff);
      EXPECT_EQ(reaches >= 0 && unfolds >= 0, entry["reach_ok"][i].get<bool>());
      EXPECT_EQ(margins.at(numbered("rho", i, " min")) >= 0 && margins.at(numbered("rho", i, " max")) >= 0,
                entry["slide_ok"][i].get<bool>());
      if (!entry["reach_ok"][i].get<bool>()) continue;
      EXPECT_NEAR(std::fabs(values.at(numbered("sin_theta_", i, "2"))), entry["abs_sin_theta2"][i].get<double>(),
                  1e-11);
    }
    EXPECT_NEAR(values.at("kappa_p"), entry["parallel_index"].get<double>(), kRoundoff);
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
    const WorkspacePlan p = plan(grid, 3, entry["phi"], limit_spec(entry["smin"], entry["cmin"]));
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
  const Pose<double> pose = {0.2, 0.17, 0.22, 0.3};
  const auto link = links("3crr-r-cru", p, pose, "-,-,+,-");
  const Point3<double> C_1 = link.at("rod 12").axis.to, C_3 = link.at("rod 32").axis.to;
  EXPECT_NEAR(C_1[1] - C_3[1], 2 * p[kR] * std::sqrt(0.75), kRoundoff);
  EXPECT_NEAR(C_1[0], C_3[0], kRoundoff);
  const AxisVector<double> rho = *mechanism("3crr-r-cru").inspect(p, pose, "-,-,+,-", limit_spec(0, 0)).joints;
  const double printed = rho[1] + p[kR] * std::sin(p[kBeta1]) + p[kL] * std::sin(0.3);
  EXPECT_NEAR(printed - rho[3], 34.6e-3, 5e-5);
}

// Erratum 5: the tangent half-angle is undefined where N + K = 0; the pose is an ordinary one.
TEST(CrrCruDocument, NoPoseIsLostToTheHalfAngleFormula) {
  const auto p = nominal();
  // Limb 3, d = (d1, d2): N + K = 2 l1 d1 + |d|^2 + l1^2 - l2^2 = |d + (l1, 0)|^2 - l2^2 = 0 at theta_1 = pi
  const double l1 = p[kL31], l2 = p[kL32], turn = 1.1;
  const double x = -l1 + l2 * std::cos(turn), y = l2 * std::sin(turn);
  const auto limb = limb_at(geometry_of("3crr-r-cru", p), 2, {x, y, 0.1}, turn > 0 ? -1 : 1);
  EXPECT_NEAR(std::fabs(atan2(limb.u1[1], limb.u1[0])), kPi, 1e-12);
  EXPECT_NEAR(limb.u2[0], std::cos(turn), 1e-12);
  EXPECT_NEAR(limb.u2[1], std::sin(turn), 1e-12);
  const Pose<double> pose = {x - p[kR] * std::cos(p[kBeta3]), y - p[kR] * std::sin(p[kBeta3]), 0.1, 0};
  const auto values = quantities("3crr-r-cru", p, pose, "-,-,-,-");
  EXPECT_NEAR(std::fabs(values.at("theta_31")), kPi, 1e-12);
  EXPECT_NEAR(std::remainder(values.at("theta_31") + values.at("theta_32") - turn, 2 * kPi), 0, 1e-12);
}

}  // namespace
}  // namespace pkm::testing::crr
