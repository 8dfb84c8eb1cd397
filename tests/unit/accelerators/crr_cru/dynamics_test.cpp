// (3CRR/R)&CRU and Quadrupteron: every golden case of dynamics.
#include <gtest/gtest.h>

#include "engine/dynamics/coupling.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

using Json = nlohmann::json;

double largest(const Json& list) {
  double most = 0;
  for (const Json& entry : list)
    most = std::max(most, entry.is_array() ? largest(entry) : std::fabs(entry.get<double>()));
  return most;
}

Wrench<double> wrench_of(const Json& entry) {
  const Json &F = entry["F"], &M = entry["M"];
  return {{F[0], F[1], F[2], M[0], M[1], M[2]}};
}

void expect_close(const AxisVector<double>& found, const Json& expected, double scale, const char* what) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(found[i], expected[i].get<double>(), kGoldenAccuracy * scale) << what;
}

TEST(CrrCruDynamics, EveryGoldenCase) {
  for (const Json& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const Mechanism& m = mechanism(entry["mechanism"]);
    const pkm::MotionState<double> state{pose_of(entry["X"]), vector_of(entry["Xd"])};
    pkm::PoseDynamics<double> d;
    m.dynamics()->equations(std::span<const double>(design_of(entry)), mode_name(mode_of(entry["sigma"])), {&state, 1},
                            {&d, 1});
    ASSERT_TRUE(d.assembles);
    const JointSpace<double> at_joints = joint_space(d);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(d.M_X(i, j), entry["M_X"][i][j].get<double>(), kGoldenAccuracy * largest(entry["M_X"]));
        EXPECT_NEAR(at_joints.M_q(i, j), entry["M_q"][i][j].get<double>(), kGoldenAccuracy * largest(entry["M_q"]));
      }
    expect_close(d.q, entry["q"], largest(entry["q"]), "q");
    expect_close(d.J * state.velocity, entry["qd"], largest(entry["qd"]), "qd");
    expect_close(coupling_indices(at_joints.M_q), entry["DCI"], 1, "DCI");
    const AxisVector<double> acceleration = vector_of(entry["Xdd"]),
                             tau = drive_forces(d, acceleration, wrench_of(entry));
    const double force = largest(entry["tau"]);
    expect_close(tau, entry["tau"], force, "tau");
    expect_close(at_joints.G_q, entry["gravity_q"], force, "gravity");
    expect_close(at_joints.c_q, entry["velocity_q"], std::max(force, largest(entry["velocity_q"])), "velocity");
    const AxisVector<double> back = pkm::acceleration(d, tau, wrench_of(entry));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(back[i], acceleration[i], 1e-9 * (1 + largest(entry["Xdd"])));
  }
}

}  // namespace
}  // namespace pkm::testing::crr
