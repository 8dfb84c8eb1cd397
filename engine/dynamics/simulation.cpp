#include "engine/dynamics/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

// Butcher tableau of the Gauss method: nodes c, weights b, and coefficients A.
constexpr std::size_t kStages = 3;
constexpr double kSqrt15 = 3.872983346207417;
constexpr double kNode[kStages] = {0.5 - kSqrt15 / 10, 0.5, 0.5 + kSqrt15 / 10};
constexpr double kWeight[kStages] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
constexpr double kInner[kStages][kStages] = {{5.0 / 36, 2.0 / 9 - kSqrt15 / 15, 5.0 / 36 - kSqrt15 / 30},
                                             {5.0 / 36 + kSqrt15 / 24, 2.0 / 9, 5.0 / 36 - kSqrt15 / 24},
                                             {5.0 / 36 + kSqrt15 / 30, 2.0 / 9 + kSqrt15 / 15, 5.0 / 36}};
constexpr int kMaxIterations = 60;

const char* const kOutOfReach = "the pose is out of reach";
std::string likely_cause(const SimulationSetup& setup) {
  return std::string(": the mechanism is near a singularity, or the time step is too long") +
         (setup.friction ? " for friction, which changes sign within `slow_speed`" : "");
}
std::string at(double time) { return "at t = " + with_unit(time, "s") + " "; }

/// Maximum norm; infinity if an element is not finite.
double max_norm(const AxisVector<double>& x) {
  double max = 0;
  for (const double value : x) max = std::isfinite(value) ? std::fmax(max, std::fabs(value)) : INFINITY;
  return max;
}

/// One Runge-Kutta stage of a time step: velocity, acceleration, and the powers of the forces [W].
struct Stage {
  AxisVector<double> velocity, acceleration;
  double drives = 0, friction = 0, weight = 0, wrench = 0;
};

class Integrator {
 public:
  explicit Integrator(const SimulationSetup& setup) : setup_(setup) {}

  /// Integrates one time step.
  /// @return "" if successful, otherwise the reason why the step failed
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

  /// Computes the acceleration and the kinetic energy of a state.
  /// @return "" if successful, otherwise the reason why they do not exist, or the limit that is violated
  std::string complete(SimulationState& state) const {
    const PoseDynamics<double> d = setup_.dynamics({state.pose, state.velocity});
    if (!d.assembles) return at(state.time) + kOutOfReach;
    if (d.J.rows() >= d.J.cols() && is_rank_deficient(d.J)) return at(state.time) + "the mechanism is at a singularity";
    state.acceleration = acceleration(d, joint_forces(d, state.time, state.velocity).first, setup_.wrench);
    state.kinetic_energy = kinetic_energy(d, state.velocity);
    if (!std::isfinite(max_norm(state.acceleration))) return at(state.time) + "the acceleration is not finite";
    const std::string refused = setup_.refuse ? setup_.refuse(state.pose) : std::string();
    return refused.empty() ? refused : at(state.time) + refused;
  }

 private:
  /// Solves the implicit stage equations by fixed-point iteration on the accelerations.
  /// @return "" if successful, otherwise the reason why it failed
  std::string solve_stages(const SimulationState& from, double h, std::array<Stage, kStages>& stages) const {
    double previous_change = INFINITY;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
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
        if (!evaluate(time, pose[i], velocity[i], now)) return at(time) + kOutOfReach;
        change = std::fmax(change, max_norm(now.acceleration - stages[i].acceleration));
        scale = std::fmax(scale, max_norm(now.acceleration));
        stages[i] = now;
      }
      if (!std::isfinite(scale)) break;
      // After convergence, the iteration continues until rounding errors stop the decrease.
      const bool converged = change <= 1e-12 * std::fmax(scale, kGravity);
      if (change == 0 || (converged && change >= previous_change)) return {};
      previous_change = change;
    }
    return at(from.time) + "the iteration for the accelerations does not converge" + likely_cause(setup_);
  }

  /// Returns two vectors: the actuator forces minus friction, and the friction forces.
  std::pair<AxisVector<double>, AxisVector<double>> joint_forces(const PoseDynamics<double>& d, double time,
                                                                 const AxisVector<double>& velocity) const {
    const AxisVector<double> tau = setup_.forces(time);
    const AxisVector<double> friction = setup_.friction ? setup_.friction(d.J * velocity) : tau * 0.0;
    return {tau - friction, friction};
  }
  /// Evaluates the equations of motion at a stage.
  /// @return false if the mechanism cannot be assembled at the pose
  bool evaluate(double time, const AxisVector<double>& pose, const AxisVector<double>& velocity, Stage& stage) const {
    const PoseDynamics<double> d = setup_.dynamics({pose, velocity});
    if (!d.assembles) return false;
    const auto [forces, friction] = joint_forces(d, time, velocity);
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
  const double initial_energy = state.kinetic_energy;
  const auto steps = static_cast<std::size_t>(std::ceil(setup.duration / setup.step * (1 - 1e-12)));
  result.turned_over = initial_energy;
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
    const double imbalance = std::fabs(next.kinetic_energy - initial_energy - work);
    if (!(imbalance <= setup.tolerance * result.turned_over)) {
      result.stopped = at(end) + "the energy balance exceeds the tolerance" + likely_cause(setup);
      return result;
    }
    result.imbalance = std::fmax(result.imbalance, imbalance);
    state = next;
    result.states.push_back(state);
  }
  return result;
}

}  // namespace pkm
