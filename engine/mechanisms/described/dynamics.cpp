#include "engine/mechanisms/described/dynamics.hpp"

#include <stdexcept>

#include "engine/core/unit.hpp"

namespace pkm::described {
namespace {

/// What a program gives, in the order of its outputs.
template <class S>
class Outputs {
 public:
  Outputs(const graph::Program& program, std::span<const S> registers)
      : next_(program.outputs().begin()), registers_(registers) {}
  const S& operator()() { return registers_[*next_++]; }
  template <SmallMatrix M>
  void fill(M& matrix) {
    for (auto& element : matrix) element = (*this)();
  }

 private:
  std::vector<std::uint32_t>::const_iterator next_;
  std::span<const S> registers_;
};

/// @return  whether the pose assembles
template <class S>
bool read(const Inputs& at, std::size_t domains, Outputs<S>& next, PoseDynamics<S>& d) {
  const std::size_t n = at.coordinates, m = at.joints;
  d.q = AxisVector<S>(m);
  next.fill(d.q);
  bool assembles = std::ranges::all_of(d.q, [](const S& q) { return std::isfinite(value_of(q)); });
  for (std::size_t i = 0; i < domains; ++i) assembles = assembles & (value_of(next()) >= 0);
  if (!assembles) return false;
  d.J = AxisMatrix<S>(m, n);
  d.J_rate_X = AxisVector<S>(m);
  d.M_X = AxisMatrix<S>(n, n);
  d.h_X = d.G_X = AxisVector<S>(n);
  d.J_wrench = MatrixUpTo<S, 6, kMostJoints>(6, n);
  next.fill(d.J);
  next.fill(d.J_rate_X);
  next.fill(d.M_X);
  next.fill(d.h_X);
  next.fill(d.G_X);
  next.fill(d.J_wrench);
  return true;
}

}  // namespace

template <class S>
void check_masses(const Evaluation& e, std::span<const S> parameters) {
  const Inputs& at = e.model.inputs;
  with_room<S>(at.count() + e.masses.registers(), [&](std::span<S> room) {
    const std::span<S> inputs = room.first(at.count()), registers = room.subspan(at.count());
    e.fill_inputs<S>(parameters, no_limits(e.model.info), 0, inputs);
    e.masses.template run_all<S>(inputs, registers);
    Outputs<S> next(e.masses, registers);
    for (const MassCheck& check : e.model.masses) {
      const double value = value_of(next());
      if (value > 0 || (check.may_vanish && value == 0)) continue;
      throw std::domain_error(check.name + " is not positive: " + with_unit(value, check.unit));
    }
  });
}

template <class S>
void find_dynamics(const Evaluation& e, std::span<const S> parameters, std::size_t mode,
                   std::span<const MotionState<S>> states, std::span<PoseDynamics<S>> found) {
  check_masses(e, parameters);
  const Inputs& at = e.model.inputs;
  with_room<S>(at.count() + e.motion.registers(), [&](std::span<S> room) {
    const std::span<S> inputs = room.first(at.count()), registers = room.subspan(at.count());
    e.fill_inputs<S>(parameters, no_limits(e.model.info), mode, inputs);
    e.motion.template start<S>(registers);
    e.motion.template run<S>(0, inputs, registers);
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (std::size_t i = 0; i < at.coordinates; ++i) {
        inputs[at.coordinate(i)] = states[k].pose[i];
        inputs[at.rate(i)] = states[k].velocity[i];
      }
      e.motion.template run<S>(1, inputs, registers);
      Outputs<S> next(e.motion, registers);
      found[k].assembles = read(at, e.model.domains.size(), next, found[k]);
    }
  });
}

template void check_masses(const Evaluation&, std::span<const double>);
template void check_masses(const Evaluation&, std::span<const Dual4>);
template void find_dynamics(const Evaluation&, std::span<const double>, std::size_t,
                            std::span<const MotionState<double>>, std::span<PoseDynamics<double>>);
template void find_dynamics(const Evaluation&, std::span<const Dual4>, std::size_t, std::span<const MotionState<Dual4>>,
                            std::span<PoseDynamics<Dual4>>);

}  // namespace pkm::described
