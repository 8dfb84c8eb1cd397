#include "engine/dynamics/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

constexpr std::size_t kStages = 3;
constexpr double kRoot = 3.872983346207417;  // sqrt(15)
constexpr double kNode[kStages] = {0.5 - kRoot / 10, 0.5, 0.5 + kRoot / 10};
constexpr double kWeight[kStages] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
constexpr double kInner[kStages][kStages] = {{5.0 / 36, 2.0 / 9 - kRoot / 15, 5.0 / 36 - kRoot / 30},
                                             {5.0 / 36 + kRoot / 24, 2.0 / 9, 5.0 / 36 - kRoot / 24},
                                             {5.0 / 36 + kRoot / 30, 2.0 / 9 + kRoot / 15, 5.0 / 36}};
constexpr int kMostIterations = 60;

const char* const kLeavesReach = "the mechanism leaves its reach";
std::string odd_or_long(const SimulationSetup& setup) {
  return std::string(": the mechanism is near a singularity, or the step is too long") +
         (setup.friction ? " for friction, which turns round within `slow_speed`" : "");
}
std::string at(double time) { return "at t = " + with_unit(time, "s") + " "; }

double largest(const AxisVector<double>& x) {
  double most = 0;
  for (const double value : x) most = std::isfinite(value) ? std::fmax(most, std::fabs(value)) : INFINITY;
  return most;
}

/// One state of a step on its way, and the powers there [W].
struct Stage {
  AxisVector<double> velocity, acceleration;
  double drives = 0, friction = 0, weight = 0, wrench = 0;
};

class Integrator {
 public:
  explicit Integrator(const SimulationSetup& setup) : setup_(setup) {}

  /// "" or why there is no step.
  std::string step(const SimulationState& from, double end, SimulationState& to) const {
    const double h = end - from.time;
    std::array<Stage, kStages> stages;
    for (Stage& stage : stages) stage = {from.velocity, from.acceleration};
    if (const std::string reason = solve_stages(from, h, stages); !reason.empty()) return reason;
    to = from;
    to.time = end;
    for (std::size_t i = 0; i < kStages; ++i) {
      const double weight = h * kWeight[i];
      to.pose += stages[i].velocity * weight;
      to.velocity += stages[i].acceleration * weight;
      to.work_of_drives += weight * stages[i].drives;
      to.work_of_friction += weight * stages[i].friction;
      to.work_of_weight += weight * stages[i].weight;
      to.work_of_wrench += weight * stages[i].wrench;
    }
    return complete(to);
  }

  /// Acceleration and kinetic energy of a state. "" or why there are none, or a limit that it breaks.
  std::string complete(SimulationState& state) const {
    const PoseDynamics<double> d = setup_.dynamics({state.pose, state.velocity});
    if (!d.assembles) return at(state.time) + kLeavesReach;
    if (is_singular(d.J)) return at(state.time) + "the mechanism is in a singularity";
    state.acceleration = acceleration(d, at_joints(d, state.time, state.velocity).first, setup_.wrench);
    state.kinetic_energy = kinetic_energy(d, state.velocity);
    if (!std::isfinite(largest(state.acceleration))) return at(state.time) + "the mechanism has no finite acceleration";
    const std::string refused = setup_.refuse ? setup_.refuse(state.pose) : std::string();
    return refused.empty() ? refused : at(state.time) + refused;
  }

 private:
  /// By repetition: each turn takes the accelerations where those of the turn before lead.
  std::string solve_stages(const SimulationState& from, double h, std::array<Stage, kStages>& stages) const {
    double before = INFINITY;
    for (int turn = 0; turn < kMostIterations; ++turn) {
      std::array<AxisVector<double>, kStages> pose, velocity;
      for (std::size_t i = 0; i < kStages; ++i) {
        pose[i] = from.pose;
        velocity[i] = from.velocity;
        for (std::size_t j = 0; j < kStages; ++j) velocity[i] += stages[j].acceleration * (h * kInner[i][j]);
      }
      for (std::size_t i = 0; i < kStages; ++i)
        for (std::size_t j = 0; j < kStages; ++j) pose[i] += velocity[j] * (h * kInner[i][j]);
      double change = 0, scale = 0;
      for (std::size_t i = 0; i < kStages; ++i) {
        const double time = from.time + h * kNode[i];
        Stage now;
        if (!evaluate(time, pose[i], velocity[i], now)) return at(time) + kLeavesReach;
        change = std::fmax(change, largest(now.acceleration - stages[i].acceleration));
        scale = std::fmax(scale, largest(now.acceleration));
        stages[i] = now;
      }
      if (!std::isfinite(scale)) break;
      const bool settled =
          change <= 1e-12 * std::fmax(scale, kGravity);  // and then until rounding stops it from falling
      if (change == 0 || (settled && change >= before)) return {};
      before = change;
    }
    return at(from.time) + "the accelerations do not settle" + odd_or_long(setup_);
  }

  /// What is left of the actuators' forces, and friction.
  std::pair<AxisVector<double>, AxisVector<double>> at_joints(const PoseDynamics<double>& d, double time,
                                                              const AxisVector<double>& velocity) const {
    const AxisVector<double> tau = setup_.forces(time);
    const AxisVector<double> friction = setup_.friction ? setup_.friction(d.J * velocity) : tau * 0.0;
    return {tau - friction, friction};
  }
  bool evaluate(double time, const AxisVector<double>& pose, const AxisVector<double>& velocity, Stage& stage) const {
    const PoseDynamics<double> d = setup_.dynamics({pose, velocity});
    if (!d.assembles) return false;
    const auto [forces, friction] = at_joints(d, time, velocity);
    const AxisVector<double> speeds = d.J * velocity;
    stage.velocity = velocity;
    stage.acceleration = acceleration(d, forces, setup_.wrench);
    stage.friction = -dot(friction, speeds);
    stage.drives = dot(forces + friction, speeds);
    stage.weight = -dot(d.G_X, velocity);
    stage.wrench = dot(transpose(d.J_wrench) * setup_.wrench, velocity);
    return true;
  }

  const SimulationSetup& setup_;
};

}  // namespace

Simulation simulate(const SimulationSetup& setup, const AxisVector<double>& pose, const AxisVector<double>& velocity) {
  PKM_EXPECTS(setup.duration > 0 && setup.step > 0);
  const Integrator integrator(setup);
  Simulation result;
  SimulationState state;
  state.pose = pose;
  state.velocity = velocity;
  result.stopped = integrator.complete(state);
  if (!result.stopped.empty()) return result;
  result.states.push_back(state);
  const double at_first = state.kinetic_energy;
  const auto steps = static_cast<std::size_t>(std::ceil(setup.duration / setup.step * (1 - 1e-12)));
  result.turned_over = at_first;
  for (std::size_t k = 1; k <= steps; ++k) {
    const double end = k == steps ? setup.duration : static_cast<double>(k) * setup.step;
    SimulationState next;
    result.stopped = integrator.step(state, end, next);
    if (!result.stopped.empty()) return result;
    result.turned_over += std::fabs(next.work_of_drives - state.work_of_drives) +
                          std::fabs(next.work_of_friction - state.work_of_friction) +
                          std::fabs(next.work_of_weight - state.work_of_weight) +
                          std::fabs(next.work_of_wrench - state.work_of_wrench);
    const double work = next.work_of_drives + next.work_of_friction + next.work_of_weight + next.work_of_wrench;
    const double imbalance = std::fabs(next.kinetic_energy - at_first - work);
    if (!(imbalance <= setup.tolerance * result.turned_over)) {
      result.stopped = at(end) + "the energy is no longer conserved" + odd_or_long(setup);
      return result;
    }
    result.imbalance = std::fmax(result.imbalance, imbalance);
    state = next;
    result.states.push_back(state);
  }
  return result;
}

}  // namespace pkm
