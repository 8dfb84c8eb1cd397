// Evaluation of a mechanism file: the programs that are compiled from its formulas, one for each purpose.
#pragma once

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/contracted_box.hpp"
#include "engine/generic/model.hpp"
#include "engine/mechanism/plan.hpp"

namespace pkm::generic {

/// The programs that are compiled from the formulas of a mechanism file. The object is immutable, so that threads can
/// share it.
struct Evaluation {
  explicit Evaluation(Model source);

  Model model;

  // The following programs depend on a pose or a state of motion. Comments name the members of Model that are outputs.

  expression::Program constraints;  ///< outputs: Model::joints, domains, margins, angles
  expression::Program reported;     ///< outputs: ReportedMargin::shown, quantities
  expression::Program joints, closures, links, origin, rods;
  expression::Program frame;   ///< outputs: Model::origin, rotation, rotation_directions
  expression::Program motion;  ///< outputs: joints, domains, equations; the first stage depends on the design only
  std::optional<expression::BatchStage> motion_batch;  ///< the second stage of `motion`, for SIMD batches of states

  // The following programs depend on the design only. If the mechanism file does not define a value, the program of
  // this value has no outputs.

  expression::Program requirements;  ///< outputs: both ends of each joint range, Model::required
  expression::Program tests, masses, size, length, radius;
  /// Outputs: Model::force_scales, then both limits of the tension of every cable.
  expression::Program drive_limits;
  expression::Program total_mass;            ///< output: total mass of all bodies [kg]
  std::vector<expression::Program> derived;  ///< threshold of each limit that the design determines, by limit
  /// Programs of the search box (lower and upper bound), the default value and the reach (lower and upper bound), by
  /// coordinate.
  std::vector<expression::Program> lower, upper, default_values, reach_lower, reach_upper;

  /// Writes the threshold of each limit: the threshold in `limits` if it is given there; otherwise the threshold that
  /// the mechanism derives from the parameters; otherwise a threshold that every pose satisfies.
  template <class S>
  void thresholds(std::span<const S> parameters, const LimitSpec& limits, std::span<S> values) const;
  /// Writes the values of the graph's inputs for a design; those of coordinates and joints are 0.
  /// @param values  must have Inputs::count() elements
  template <class S>
  void fill_inputs(std::span<const S> parameters, const LimitSpec& limits, std::size_t mode, std::span<S> values) const;
  /// Writes the values of the graph's inputs for a workspace analysis, with the fixed coordinates at their values;
  /// integrated coordinates are 0. Throws std::invalid_argument with a message if a fixed coordinate has no value.
  template <class S>
  void fill_inputs(std::span<const S> parameters, const WorkspacePlan& plan, std::size_t mode,
                   std::vector<S>& values) const;
  template <class S>
  std::vector<S> inputs(std::span<const S> parameters, const LimitSpec& limits, std::size_t mode) const {
    std::vector<S> values(model.inputs.count());
    fill_inputs<S>(parameters, limits, mode, values);
    return values;
  }
  /// Value of a program that depends on the design only, in the default working mode; std::nullopt if it has no output.
  template <class S>
  std::optional<S> of_design(const expression::Program& program, std::span<const S> parameters) const;
  /// Range of a coordinate in the search box; std::nullopt if neither the file nor the constraints bound it.
  std::optional<std::array<double, 2>> range(std::span<const double> parameters, const LimitSpec& limits,
                                             std::size_t mode, std::size_t coordinate) const;
  /// Range of a coordinate for a workspace analysis; throws DesignError if it is unknown.
  std::array<double, 2> required_range(std::span<const double> parameters, const WorkspacePlan& plan, std::size_t mode,
                                       std::size_t coordinate) const;
  /// Search box of a workspace analysis, by axis: the box of the plan or, if it has none, the ranges of the swept
  /// coordinates.
  Box search_box(std::span<const double> parameters, const WorkspacePlan& plan, std::size_t mode,
                 const std::vector<int>& swept) const;

 private:
  /// A box that contains all feasible poses, for models with contracted coordinates.
  /// @param plan  plan with the values of the fixed coordinates; null: no coordinate is fixed
  bounds::IntervalBox contract(std::span<const double> parameters, const LimitSpec& limits, std::size_t mode,
                               const WorkspacePlan* plan) const;
};

/// Calls work(scratch) with scratch memory for `count` scalars, which is on the stack if `count` is small.
template <class S, class Work>
auto with_scratch(std::size_t count, const Work& work) {
  constexpr std::size_t kMaxOnStack = 512;
  if (count <= kMaxOnStack) {
    std::array<S, kMaxOnStack> scratch;
    return work(std::span<S>(scratch).first(count));
  }
  std::vector<S> scratch(count);
  return work(std::span<S>(scratch));
}

/// Values of the outputs of a program, in their order, for given values of the graph's inputs.
template <class S>
std::vector<S> outputs_of(const expression::Program& program, const std::vector<S>& inputs) {
  std::vector<S> registers, values;
  program.run_all<S>(inputs, registers);
  for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
  return values;
}

}  // namespace pkm::generic
