// (3CRR/R)&CRU and Quadrupteron: forms of the equations of motion that must agree, and laws that they must obey, in all
// working modes of random designs whose slides and payload have masses.
#include <gtest/gtest.h>

#include "engine/core/catalogue.hpp"
#include "engine/dynamics/coupling.hpp"
#include "tests/unit/accelerators/crr_cru/states.hpp"
#include "tests/unit/dynamics/coriolis.hpp"

namespace pkm::testing::crr {
namespace {

constexpr double kAgreement = 1e-11;   // of the largest term of what is compared
constexpr int kStates = 500;           // per mechanism and working mode
constexpr int kNewtonEulerShare = 20;  // the equations of all bodies are solved in one state of so many

template <SmallMatrix M>
double largest(const M& a) {
  double most = 0;
  for (const double entry : a) most = std::max(most, std::fabs(entry));
  return most;
}

template <SmallMatrix A, SmallMatrix B>
double distance(const A& a, const B& b) {
  return largest(a - b);
}

/// J^-T times each term of the equations of motion: what tau is the sum of. Rounding is measured against these.
double largest_term(const PoseDynamics<double>& d, const State& s) {
  double most = 0;
  for (const AxisVector<double>& term : {d.M_X * s.acceleration, d.h_X, d.G_X, transpose(d.J_wrench) * s.wrench})
    most = std::max(most, largest(at_joints(d, term)));
  return most;
}

struct Worst {
  double joint_space = 0, square = 0, min_norm_solution = 0;
};

Worst compare_forms(const std::string& name) {
  Worst worst;
  Uniform uniform(11);
  for (int number = 0; number < 16; ++number)
    for (int k = 0; k < kStates; ++k) {
      const State s = random_state(uniform, name, mode_number(number));
      const PoseDynamics<double> d = dynamics_of(name, s);
      const AxisVector<double> tau = drive_forces(d, s.acceleration, s.wrench);
      const double scale = largest_term(d, s);

      const JointSpace<double> q = joint_space(d);
      const AxisVector<double> q_acceleration = d.J * s.acceleration + d.J_rate_X;
      const AxisVector<double> by_joints =
          q.M_q * q_acceleration + q.c_q + q.G_q - at_joints(d, transpose(d.J_wrench) * s.wrench);
      const double joint_scale = std::max(scale, largest(q.M_q) * largest(q_acceleration));
      worst.joint_space = std::max(worst.joint_space, distance(by_joints, tau) / joint_scale);

      if (k % kNewtonEulerShare) continue;
      const NewtonEuler system = newton_euler_of(name, s);
      worst.square = std::max(worst.square, distance(drive_forces(system, solve_square_system(system)), tau) / scale);
      const MinNormSolution least = min_norm_solution(system);
      EXPECT_EQ(least.rank, name == "3crr-r-cru" ? 60 : 54);
      worst.min_norm_solution = std::max(worst.min_norm_solution, distance(drive_forces(system, least.x), tau) / scale);
    }
  return worst;
}

void expect_equal_forms(const std::string& name) {
  const Worst worst = compare_forms(name);
  EXPECT_LE(worst.joint_space, kAgreement);
  EXPECT_LE(worst.square, kAgreement);
  EXPECT_LE(worst.min_norm_solution, kAgreement);
  ::testing::Test::RecordProperty("joint_space", std::to_string(worst.joint_space * 1e15) + "e-15");
  ::testing::Test::RecordProperty("solve_square_system", std::to_string(worst.square * 1e15) + "e-15");
  ::testing::Test::RecordProperty("min_norm_solution", std::to_string(worst.min_norm_solution * 1e15) + "e-15");
}

TEST(CrrCruEquations, VirtualWorkIsNewtonEulerIsJointSpaceDecoupled) { expect_equal_forms("3crr-r-cru"); }
TEST(CrrCruEquations, VirtualWorkIsNewtonEulerIsJointSpaceQuadrupteron) { expect_equal_forms("quadrupteron"); }

/// Calls `check(name, state)` for `count` random states of each mechanism, spread over the working modes.
template <class Check>
void for_random_states(int count, const Check& check) {
  Uniform uniform(12);
  for (const std::string& name : both())
    for (int k = 0; k < count; ++k) check(name, random_state(uniform, name, mode_number(k % 16)));
}

TEST(CrrCruEquations, BodiesMoveAsTheGoldenOnes) {
  for (const auto& entry : golden()["cases"]) {
    SCOPED_TRACE(entry["id"].dump());
    const NewtonEuler system = newton_euler_of(entry["mechanism"], state_of(entry));
    double largest = 0;
    for (const auto& a : entry["rod_acc"])
      for (const double component : a) largest = std::max(largest, std::fabs(component));
    double turning = 0;
    for (const double epsilon : entry["rod_eps"]) turning = std::max(turning, std::fabs(epsilon));
    for (std::size_t rod = 0; rod < 8; ++rod) {
      const RigidBody* const body = find_named(
          system.bodies, (rod % 2 == 0 ? "first_link of limb" : "second_link of limb") + std::to_string(rod / 2 + 1));
      ASSERT_TRUE(body) << rod;
      const std::size_t e = kLimbs[rod / 2].e;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(body->a[k], entry["rod_acc"][rod][k].get<double>(), 1e-11 * largest);
        const bool about = k == e;
        EXPECT_NEAR(body->omega[k], about ? entry["rod_omega"][rod].get<double>() : 0.0, 1e-11 * turning);
        EXPECT_NEAR(body->epsilon[k], about ? entry["rod_eps"][rod].get<double>() : 0.0, 1e-11 * turning);
      }
    }
  }
}

PoseDynamics<Dual4> dual_dynamics(const std::string& name, const State& s, const MotionState<Dual4>& at) {
  const std::vector<Dual4> p(s.parameters.begin(), s.parameters.end());
  PoseDynamics<Dual4> d;
  mechanism(name).dynamics()->equations(std::span<const Dual4>(p), mode_name(s.mode), {&at, 1}, {&d, 1});
  return d;
}

TEST(CrrCruEquations, KineticEnergyGrowsByThePowerOfAllForces) {
  for_random_states(800, [](const std::string& name, const State& s) {
    const PoseDynamics<double> d = dynamics_of(name, s);
    const AxisVector<double> v = s.motion.velocity, tau = drive_forces(d, s.acceleration, s.wrench);
    const double drives = dot(tau, d.J * v), outside = dot(s.wrench, d.J_wrench * v), weight = -dot(d.G_X, v);
    // everything as a function of time, which is the one variable of these derivatives
    MotionState<Dual4> at{pkm::Pose<Dual4>(4), AxisVector<Dual4>(4)};
    for (std::size_t k = 0; k < 4; ++k) {
      at.pose[k] = Dual4(s.motion.pose[k], {{v[k]}});
      at.velocity[k] = Dual4(v[k], {{s.acceleration[k]}});
    }
    const Dual4 energy = kinetic_energy(dual_dynamics(name, s, at), at.velocity);
    const double scale =
        std::fabs(drives) + std::fabs(outside) + std::fabs(weight) + largest(transpose(d.J) * tau) * largest(v);
    EXPECT_NEAR(energy.v[0], drives + outside + weight, kAgreement * scale) << name;
  });
}

TEST(CrrCruEquations, CoriolisMatricesGiveTheForcesAndSkewRates) {
  for_random_states(800, [](const std::string& name, const State& s) {
    const PoseDynamics<Dual4> d = dual_dynamics(name, s, pose_variables(s.motion));
    const PoseDynamics<double> plain = dynamics_of(name, s);
    const AxisVector<double>& v = s.motion.velocity;
    const auto expect_skew = [&](const AxisMatrix<double>& a, double scale) {
      EXPECT_LE(largest(a + transpose(a)), kAgreement * scale) << name;
    };
    const AxisMatrix<double> C_X = coriolis_matrix(d.M_X, v), M_rate = rate(d.M_X, v);
    EXPECT_LE(distance(C_X * v, plain.h_X), kAgreement * largest(C_X) * largest(v)) << name;
    expect_skew(M_rate - C_X * 2.0, largest(C_X) + largest(M_rate));

    const AxisMatrix<double> C_q = joint_coriolis_matrix(d, v), Mq_rate = rate(joint_inertia(d), v);
    const AxisVector<double> qd = plain.J * v;
    EXPECT_LE(distance(C_q * qd, joint_space(plain).c_q), kAgreement * largest(C_q) * largest(qd)) << name;
    expect_skew(Mq_rate - C_q * 2.0, largest(C_q) + largest(Mq_rate));
  });
}

TEST(CrrCruEquations, JacobianRateIsTheOneOfTheDerivatives) {
  for_random_states(200, [](const std::string& name, const State& s) {
    const AxisVector<double>& v = s.motion.velocity;
    const PoseDynamics<Dual4> d = dual_dynamics(name, s, pose_variables(s.motion));
    EXPECT_LE(distance(rate(d.J, v) * v, dynamics_of(name, s).J_rate_X), 1e-13) << name;
  });
}

/// All lengths times `length`, all masses times `mass`; angles stay.
State scaled(State s, const std::vector<Parameter>& parameters, double length, double mass) {
  const std::map<std::string, double> factors = {
      {"m", length}, {"kg", mass}, {"kg m^2", mass * length * length}, {"rad", 1}};
  for (std::size_t k = 0; k < parameters.size(); ++k) s.parameters[k] *= factors.at(parameters[k].unit);
  for (std::size_t k = 0; k < 3; ++k) {
    s.motion.pose[k] *= length;
    s.motion.velocity[k] *= length;
    s.acceleration[k] *= length;
    s.wrench[k] *= mass * length;
    s.wrench[3 + k] *= mass * length * length;
  }
  return s;
}

TEST(CrrCruEquations, ScaleWithLengthsAndMasses) {
  for_random_states(200, [](const std::string& name, const State& s) {
    const double length = 1.7, mass = 0.6;
    const State big = scaled(s, mechanism(name).info().parameters, length, mass);
    const PoseDynamics<double> d = dynamics_of(name, s), D = dynamics_of(name, big);
    const JointSpace<double> q = joint_space(d), Q = joint_space(D);
    // The inertia that joints feel grows with masses alone, and coupling indices with neither.
    EXPECT_LE(distance(Q.M_q, q.M_q * mass), 1e-12 * largest(Q.M_q)) << name;
    EXPECT_LE(distance(coupling_indices(Q.M_q), coupling_indices(q.M_q)), 1e-12) << name;
    // At the same angular rates forces grow with mass times length; weight does with mass.
    EXPECT_LE(distance(Q.c_q, q.c_q * (mass * length)), 1e-11 * largest(Q.c_q)) << name;
    EXPECT_LE(distance(Q.G_q, q.G_q * mass), 1e-12 * largest(Q.G_q)) << name;
    const auto inertial = [](const PoseDynamics<double>& at, const State& state) {
      return drive_forces(at, state.acceleration, state.wrench) - at_joints(at, at.G_X);
    };
    EXPECT_LE(distance(inertial(D, big), inertial(d, s) * (mass * length)), 1e-11 * largest_term(D, big)) << name;
  });
}

TEST(CrrCruEquations, ReversedMotionNeedsTheSameForces) {
  // Forces depend on squares of rates.
  for_random_states(100, [](const std::string& name, State s) {
    const AxisVector<double> forth = drive_forces(dynamics_of(name, s), s.acceleration, s.wrench);
    for (std::size_t k = 0; k < 4; ++k) s.motion.velocity[k] *= -1;
    EXPECT_TRUE(drive_forces(dynamics_of(name, s), s.acceleration, s.wrench) == forth) << name;
  });
}

}  // namespace
}  // namespace pkm::testing::crr
