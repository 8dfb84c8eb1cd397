#include "engine/generic/dynamics.hpp"

#include <cmath>
#include <memory>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::generic {
namespace {

/// Reads the outputs of a program one after the other.
/// @param value_of_register  value_of_register(std::uint32_t): value of the register with this index
template <class ValueOf>
class Outputs {
 public:
  Outputs(const expression::Program& program, ValueOf value_of_register)
      : next_(program.outputs().begin()), value_(value_of_register) {}
  auto operator()() { return value_(*next_++); }
  template <SmallMatrix M>
  void fill(M& matrix) {
    for (auto& element : matrix) element = (*this)();
  }

 private:
  std::vector<std::uint32_t>::const_iterator next_;
  ValueOf value_;
};

/// Fills `d` with the equations of motion from the outputs of the program.
/// @return false if the pose does not assemble; `d` is then incomplete
template <class S, class ValueOf>
bool read(const Inputs& at, std::size_t domains, Outputs<ValueOf> next, PoseDynamics<S>& d) {
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
  d.J_wrench = MatrixUpTo<S, 6, kMaxJoints>(6, n);
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
  with_scratch<S>(at.count() + e.masses.registers(), [&](std::span<S> scratch) {
    const std::span<S> inputs = scratch.first(at.count()), registers = scratch.subspan(at.count());
    e.fill_inputs<S>(parameters, no_limits(e.model.info), 0, inputs);
    e.masses.template run_all<S>(inputs, registers);
    Outputs next(e.masses, [registers](std::uint32_t at_register) { return registers[at_register]; });
    for (const MassCheck& check : e.model.masses) {
      const double value = value_of(next());
      const bool finite = std::isfinite(value);
      if (finite && (value > 0 || (check.may_vanish && value == 0))) continue;
      throw DesignError(check.name + " is not " + (finite ? "positive" : "finite") + ": " +
                        with_unit(value, check.unit));
    }
  });
}

namespace {

/// Evaluates at most kRow states in one SIMD batch.
void find_batch(const Evaluation& e, std::span<const double> registers, std::span<const MotionState<double>> states,
                double* rows, std::span<PoseDynamics<double>> found) {
  const Inputs& at = e.model.inputs;
  const std::size_t count = states.size(), padded = (count + kLanes - 1) / kLanes * kLanes;
  const auto& inputs = e.motion.stages()[1].inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    double* const row = rows + e.motion_batch->inputs()[i] * expression::kRow;
    const std::size_t position = inputs[i].position;
    const bool is_rate = position >= at.rate(0);
    for (std::size_t k = 0; k < padded; ++k) {  // fill the batch with copies of the last state
      const MotionState<double>& state = states[std::min(k, count - 1)];
      row[k] = is_rate ? state.velocity[position - at.rate(0)] : state.pose[position - at.coordinate(0)];
    }
  }
  e.motion_batch->run(registers.data(), rows, padded);
  for (std::size_t k = 0; k < count; ++k) {
    const auto value = [&, k](std::uint32_t at_register) {
      const expression::Operand of = e.motion_batch->operand(at_register);
      return of.row ? rows[of.index * expression::kRow + k] : registers[of.index];
    };
    found[k].assembles = read(at, e.model.domains.size(), Outputs(e.motion, value), found[k]);
  }
}

}  // namespace

template <class S>
void find_dynamics(const Evaluation& e, std::span<const S> parameters, std::size_t mode,
                   std::span<const MotionState<S>> states, std::span<PoseDynamics<S>> found) {
  // Minimum number of states for which a SIMD batch is faster than evaluating the states one by one.
  constexpr std::size_t kMinBatch = 4;
  check_masses(e, parameters);
  const Inputs& at = e.model.inputs;
  with_scratch<S>(at.count() + e.motion.registers(), [&](std::span<S> scratch) {
    const std::span<S> inputs = scratch.first(at.count()), registers = scratch.subspan(at.count());
    e.fill_inputs<S>(parameters, no_limits(e.model.info), mode, inputs);
    e.motion.template start<S>(registers);
    e.motion.template run<S>(0, inputs, registers);
    if constexpr (std::is_same_v<S, double>) {
      if (states.size() >= kMinBatch) {
        const auto rows = std::make_unique_for_overwrite<double[]>(e.motion_batch->slots() * expression::kRow);
        for (std::size_t first = 0; first < states.size(); first += expression::kRow) {
          const std::size_t count = std::min(expression::kRow, states.size() - first);
          find_batch(e, registers, states.subspan(first, count), rows.get(), found.subspan(first, count));
        }
        return;
      }
    }
    for (std::size_t k = 0; k < states.size(); ++k) {
      for (std::size_t i = 0; i < at.coordinates; ++i) {
        inputs[at.coordinate(i)] = states[k].pose[i];
        inputs[at.rate(i)] = states[k].velocity[i];
      }
      e.motion.template run<S>(1, inputs, registers);
      const Outputs next(e.motion, [registers](std::uint32_t at_register) { return registers[at_register]; });
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

DriveLimits drive_limits(const Evaluation& evaluation, std::span<const double> parameters) {
  const Model& model = evaluation.model;
  DriveLimits limits = no_drive_limits(model.inputs.joints);
  limits.sharing = model.sharing;
  const std::vector<double> values =
      outputs_of(evaluation.drive_limits, evaluation.inputs(parameters, no_limits(model.info), 0));
  auto next = values.begin();
  for (std::size_t i = 0; i < model.force_scales.size(); ++i) limits.scale[i] = *next++;
  for (std::size_t i = 0; i < model.tensions.size(); ++i)
    if (model.tensions[i]) {
      limits.upper[i] = -*next++;
      limits.lower[i] = -*next++;
    }
  return limits;
}

template <class S>
S total_mass(const Evaluation& evaluation, std::span<const S> parameters) {
  check_masses(evaluation, parameters);
  return *evaluation.of_design(evaluation.total_mass, parameters);
}

template double total_mass(const Evaluation&, std::span<const double>);
template Dual4 total_mass(const Evaluation&, std::span<const Dual4>);

}  // namespace pkm::generic
