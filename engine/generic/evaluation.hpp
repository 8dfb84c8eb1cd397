// A description's formulas as programs, by what is asked for.
#pragma once

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/model.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm::generic {

/// Immutable, shared by threads.
struct Evaluation {
  explicit Evaluation(Model described);

  Model model;
  expression::Program conditions;  ///< of a pose: joints, domains, margins, angles
  expression::Program reported;    ///< of a pose: shown margins, then quantities
  expression::Program joints, closures, links, tests;
  expression::Program requirements;    ///< of a design: both ends of each range, then what is required
  expression::Program origin;          ///< Model::origin
  expression::Program frame;           ///< Model::origin, turn, and turn_axes by coordinate
  expression::Program rods;            ///< C and B of each
  expression::Program motion, masses;  ///< joints, domains and EquationNodes of a state, after the design; MassCheck
  std::optional<expression::BatchStage> motions;  ///< `motion` of many states
  expression::Program size, length, radius;       ///< of a design; without outputs: it is not described
  std::vector<expression::Program> derived, lower, upper, middle, reach_lower,
      reach_upper;  ///< by limit; the others by coordinate

  /// Thresholds in force: given, derived from the parameters, or inactive.
  template <class S>
  void thresholds(std::span<const S> parameters, const LimitSpec& limits, std::span<S> values) const;
  /// The graph's inputs for a design; coordinates and joints are 0.
  /// @param values  as many as the graph has inputs
  template <class S>
  void fill_inputs(std::span<const S> parameters, const LimitSpec& limits, std::size_t mode, std::span<S> values) const;
  template <class S>
  std::vector<S> inputs(std::span<const S> parameters, const LimitSpec& limits, std::size_t mode) const {
    std::vector<S> values(model.inputs.count());
    fill_inputs<S>(parameters, limits, mode, values);
    return values;
  }
  /// What a program of the design alone gives in the default working mode; none where it has no output.
  template <class S>
  std::optional<S> of_design(const expression::Program& program, std::span<const S> parameters) const;
  /// Range of a coordinate that holds the workspace under limits, in a working mode.
  std::optional<std::array<double, 2>> range(std::span<const double> parameters, const LimitSpec& limits,
                                             std::size_t mode, std::size_t coordinate) const;
  /// The same; throws std::invalid_argument with a sentence where there is none.
  std::array<double, 2> needed_range(std::span<const double> parameters, const LimitSpec& limits, std::size_t mode,
                                     std::size_t coordinate) const;
  /// Where a survey looks, by its axes: in the box that is given, else in the ranges of the swept coordinates.
  Box search_box(std::span<const double> parameters, const WorkspacePlan& plan, std::size_t mode,
                 const std::vector<int>& swept) const;
};

/// Calls work(room) with `count` numbers, on the stack where they are not many: for what is computed per design or
/// pose.
template <class S, class Work>
auto with_scratch(std::size_t count, const Work& work) {
  constexpr std::size_t kMost = 512;
  if (count <= kMost) {
    std::array<S, kMost> room;
    return work(std::span<S>(room).first(count));
  }
  std::vector<S> room(count);
  return work(std::span<S>(room));
}

/// A program's outputs.
template <class S>
std::vector<S> outputs_of(const expression::Program& program, const std::vector<S>& inputs) {
  std::vector<S> registers, values;
  program.run_all<S>(inputs, registers);
  for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
  return values;
}

}  // namespace pkm::generic
