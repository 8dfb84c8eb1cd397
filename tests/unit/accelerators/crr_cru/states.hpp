// States of motion of (3CRR/R)&CRU and the Quadrupteron: the golden ones, and random feasible ones.
#pragma once

#include "engine/accelerators/crr_cru/position_set.hpp"
#include "engine/config/mechanism_draft.hpp"
#include "engine/generic/equations.hpp"
#include "engine/generic/newton_euler.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"
#include "tests/unit/dynamics/square_system.hpp"

namespace pkm::testing::crr {

struct State {
  std::vector<double> parameters;
  WorkingMode mode;
  MotionState<double> motion;
  AxisVector<double> acceleration;
  Wrench<double> wrench;
};

inline State state_of(const nlohmann::json& entry) {
  State s{design_of(entry),
          mode_of(entry["sigma"]),
          {pose_of(entry["X"]), vector_of(entry["Xd"])},
          vector_of(entry["Xdd"]),
          {}};
  for (std::size_t k = 0; k < 3; ++k) {
    s.wrench[k] = entry["F"][k];
    s.wrench[3 + k] = entry["M"][k];
  }
  return s;
}

inline PoseDynamics<double> dynamics_of(const std::string& name, const State& s) {
  PoseDynamics<double> d;
  mechanism(name).dynamics()->equations(std::span<const double>(s.parameters), mode_name(s.mode), {&s.motion, 1},
                                        {&d, 1});
  return d;
}

/// The formulas of the mechanism's file, with its equations of motion.
inline const generic::Evaluation& evaluation_of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<const generic::Evaluation>> known;
  auto& evaluation = known[name];
  if (!evaluation) {
    generic::Model model = read_mechanism_model(mechanism_file_text(name), name + ".toml", {}, "");
    model.equations = generic::equations_of(model);
    evaluation = std::make_unique<const generic::Evaluation>(std::move(model));
  }
  return *evaluation;
}

inline NewtonEuler newton_euler_of(const std::string& name, const State& s) {
  const generic::Evaluation& e = evaluation_of(name);
  const std::size_t mode = mode_index(e.model.info, mode_name(s.mode));
  return generic::newton_euler(e, s.parameters, mode, s.motion, s.acceleration, s.wrench);
}

/// The name of a joint in the paper: "a1" on the slide, "b1" at the elbow, "c1" on the platform, "t1" between the
/// platforms.
inline std::string paper_name(const std::string& joint) {
  static const std::map<char, char> letters = {{'S', 'a'}, {'C', 'b'}, {'B', 'c'}};
  return joint == "t1" ? joint : std::string{letters.at(joint.back()), joint[4]};
}

/// The forces in the joints with those couples of C_1 to C_4 set to zero that leave as many unknowns as equations.
inline Eigen::VectorXd solve_square_system(const NewtonEuler& system) {
  const bool jointed = system.joints.back().name == "t1";
  return pkm::test::solve_square_system(system, [jointed](const Joint& joint, std::size_t couple) {
    using Axes = std::vector<std::size_t>;
    static const std::array<Axes, 4> decoupled = {Axes{}, {2}, {0, 1}, {0}}, quadrupteron = {Axes{1}, {0}, {}, {0}};
    const std::string name = paper_name(joint.name);
    return name[0] == 'c' &&
           std::ranges::any_of((jointed ? decoupled : quadrupteron)[static_cast<std::size_t>(name[1] - '1')],
                               [&](std::size_t axis) { return joint.couples[couple][axis] == 1; });
  });
}

/// Whether a position is in all ranges and all annuli of the set.
inline bool in_position_set(const Design<double>& d, const PositionSet<double>& f, const Vector3<double>& at) {
  if (f.singular) return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (at[k] < f.range[k].lower || at[k] > f.range[k].upper) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const double a = at[kLimbs[i].p] - f.center[i][kLimbs[i].p], b = at[kLimbs[i].q] - f.center[i][kLimbs[i].q];
    const double distance2 = a * a + b * b;
    if (distance2 < d.in2[i] || distance2 > d.out2[i]) return false;
  }
  return true;
}

/// A feasible pose of the design with the document's default margins, rates to 1.5 m/s and 4 rad/s, accelerations to
/// 15 m/s^2 and 40 rad/s^2, a wrench of 20 N and 1 N m.
inline State random_state(Uniform& uniform, const std::string& name, const WorkingMode& mode,
                          const std::vector<double>& design) {
  State s{design, mode, {Pose<double>{}, AxisVector<double>(4)}, AxisVector<double>(4), {}};
  const Design<double> limited = pkm::crr_cru::design(geometry_of(name, design), {.s_min = 0.2, .c_min = 0.1});
  Pose<double> pose;
  do {
    pose = {uniform(0, 0.4), uniform(0, 0.4), uniform(0, 0.4), uniform(-1.4, 1.4)};
  } while (!in_position_set(limited, position_set(limited, pose.angle), {pose.x, pose.y, pose.z}));
  s.motion.pose = pose;
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
  p[kSlideMass] = uniform(0, 0.5);
  p[kPayload] = uniform(0, 0.5);
  p[kPayloadOffset] = uniform(-0.05, 0.1);
  return random_state(uniform, name, mode, p);
}

/// Working mode number 0..15.
inline WorkingMode mode_number(int number) {
  return {number & 8 ? 1 : -1, number & 4 ? 1 : -1, number & 2 ? 1 : -1, number & 1 ? 1 : -1};
}

}  // namespace pkm::testing::crr
