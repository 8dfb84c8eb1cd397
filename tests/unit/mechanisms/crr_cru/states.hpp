// States of motion of (3CRR/R)&CRU and the Quadrupteron: the golden ones, and random feasible ones.
#pragma once

#include "engine/mechanisms/crr_cru/bodies.hpp"
#include "engine/mechanisms/crr_cru/dynamics.hpp"
#include "engine/mechanisms/crr_cru/margins.hpp"
#include "tests/unit/dynamics/square_closure.hpp"
#include "tests/unit/mechanisms/crr_cru/golden.hpp"

namespace pkm::testing::crr {

// of four coordinates, not of any number
using crr_cru::MotionState, crr_cru::PlacedBody, crr_cru::PoseDynamics;

struct State {
  std::vector<double> parameters;
  WorkingMode mode;
  MotionState<double> motion;
  Vector<double, 4> acceleration;
  Wrench<double> wrench;
};

inline State state_of(const nlohmann::json& entry) {
  State s{design_of(entry), mode_of(entry["sigma"]), {pose_of(entry["X"]), {}}, {}, {}};
  for (std::size_t k = 0; k < 4; ++k) {
    s.motion.velocity[k] = entry["Xd"][k];
    s.acceleration[k] = entry["Xdd"][k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    s.wrench[k] = entry["F"][k];
    s.wrench[3 + k] = entry["M"][k];
  }
  return s;
}

/// Everything that the equations of a state are made of.
struct Model {
  Geometry<double> g;
  Masses<double> b;
  Limbs<double> limbs;
};
inline Model model_of(const std::string& name, const State& s) {
  const Geometry<double> g = geometry_of(name, s.parameters);
  return {g, masses(MassModel::table, std::span<const double>(s.parameters)), inverse(g, s.motion.pose, s.mode)};
}

inline NewtonEuler newton_euler_of(const std::string& name, const State& s) {
  const Model m = model_of(name, s);
  return newton_euler(m.g, m.b, m.limbs, s.motion, s.acceleration, s.wrench);
}

/// The forces in the joints with those couples of C_1 to C_4 set to zero that leave as many unknowns as equations.
inline Eigen::VectorXd square_closure(const NewtonEuler& system) {
  const bool jointed = system.joints.back().name == "t1";
  return pkm::test::square_closure(system, [jointed](const Joint& joint, std::size_t couple) {
    using Axes = std::vector<std::size_t>;
    static const std::array<Axes, 4> decoupled = {Axes{}, {2}, {0, 1}, {0}}, quadrupteron = {Axes{1}, {0}, {}, {0}};
    return joint.name[0] == 'c' &&
           std::ranges::any_of((jointed ? decoupled : quadrupteron)[static_cast<std::size_t>(joint.name[1] - '1')],
                               [&](std::size_t axis) { return joint.couples[couple][axis] == 1; });
  });
}

inline PoseDynamics<double> dynamics_of(const std::string& name, const State& s) {
  const Model m = model_of(name, s);
  return pose_dynamics(m.g, m.b, s.motion, s.mode);
}

/// The plain test of one pose, but for clearance.
inline bool keeps_limits(const Design<double>& d, const Pose<double>& pose) {
  bool keeps = true;
  state_margins(d, pose, [&keeps](std::size_t, double margin) { keeps = keeps && margin >= 0; });
  return keeps;
}

/// A pose of the design with the document's default margins, rates to 1.5 m/s and 4 rad/s, accelerations to 15 m/s^2
/// and 40 rad/s^2, a wrench of 20 N and 1 N m.
inline State random_state(Uniform& uniform, const std::string& name, const WorkingMode& mode,
                          const std::vector<double>& design) {
  State s{design, mode, {}, {}, {}};
  const Design<double> limited = pkm::crr_cru::design(geometry_of(name, design), {.s_min = 0.2, .c_min = 0.1});
  do {
    s.motion.pose = {uniform(0, 0.4), uniform(0, 0.4), uniform(0, 0.4), uniform(-1.4, 1.4)};
  } while (!keeps_limits(limited, s.motion.pose));
  for (std::size_t k = 0; k < 4; ++k) {
    const double v = k < 3 ? 1.5 : 4, a = k < 3 ? 15 : 40;
    s.motion.velocity[k] = uniform(-v, v);
    s.acceleration[k] = uniform(-a, a);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const double most = k < 3 ? 20 : 1;
    s.wrench[k] = uniform(-most, most);
  }
  return s;
}

/// The same of a random design up to 15 % off the nominal one, whose slides and payload have masses.
inline State random_state(Uniform& uniform, const std::string& name, const WorkingMode& mode) {
  std::vector<double> p = random_design(uniform, 0.15);
  p[kTableExtras] = uniform(0, 0.5);
  p[kTableExtras + 1] = uniform(0, 0.5);
  p[kTableExtras + 2] = uniform(-0.05, 0.1);
  return random_state(uniform, name, mode, p);
}

/// Working mode number 0..15.
inline WorkingMode mode_number(int number) {
  return {number & 8 ? 1 : -1, number & 4 ? 1 : -1, number & 2 ? 1 : -1, number & 1 ? 1 : -1};
}

}  // namespace pkm::testing::crr
