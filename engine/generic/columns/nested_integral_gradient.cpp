// Gradient of a nested integral: adjoints of its nodes, and contributions of the endpoints of intervals.
#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/nested_integral.hpp"

namespace pkm::generic {

void NestedIntegral::add_gradient(std::span<double> by_input, IntegralScratch& scratch) const {
  scratch.adjoints.assign(plan().program.registers(), 0);
  add_gradient(0, 1, scratch);
  backward_sweep(plan().program, 0, scratch.registers, scratch.adjoints);
  for (const auto& input : plan().program.stages()[0].inputs) by_input[input.position] += scratch.adjoints[input.to];
}

/// Adds `factor` times the gradient of the integral over the coordinates from `level` on to the adjoints of the
/// registers. To be called after inside(level). Moves the intervals out of scratch.kept.
void NestedIntegral::add_gradient(std::size_t level, double factor, IntegralScratch& scratch) const {
  if (level == levels()) {
    if (const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_))
      planar_slice->add_gradient(factor, scratch.registers, scratch.adjoints, scratch.planar_slice);
    else
      std::get<Column>(innermost_).add_gradient(factor, scratch.registers, scratch.adjoints, scratch.column);
    return;
  }
  const auto& stage = plan().program.stages()[level + 1];
  for (const SmoothInterval& part : scratch.levels[level].parts) {
    for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
      if (level == 0 && !scratch.kept.empty()) {
        set(level, part.at[i], scratch);
        std::swap(scratch.levels[1].parts, scratch.kept[part.kept + i]);
      } else {
        slice(level, part.at[i], scratch);
      }
      add_gradient(level + 1, factor * part.weight[i], scratch);
      backward_sweep(plan().program, level + 1, scratch.registers, scratch.adjoints);
      for (const auto& input : stage.inputs) scratch.adjoints[input.to] = 0;
    }
    add_side(level, part, false, factor, scratch);
    add_side(level, part, true, factor, scratch);
  }
}

/// Adds `factor` times the contribution of an endpoint of an interval to the gradient: derivative of the endpoint times
/// the measure of the slice there.
void NestedIntegral::add_side(std::size_t level, const SmoothInterval& part, bool upper, double factor,
                              IntegralScratch& scratch) const {
  const IntervalBound closing = upper ? part.upper : part.lower;
  const double at = upper ? part.piece.upper : part.piece.lower, sign = upper ? factor : -factor;
  if (closing == kCriticalValue) {
    if (may_jump(level, part, upper, scratch))
      visit_one_sided(level, part, upper, upper ? -1 : 1, scratch, [&](double weight, double slope) {
        for (std::size_t i = 0; i < scratch.own.size(); ++i)
          scratch.adjoints[i] -= sign * weight / slope * scratch.own[i];
      });
    return;
  }
  const double measure = (upper ? part.above : part.below).measure;
  if (closing == kBox) {
    scratch.adjoints[plan().range[level][upper ? 1 : 0]] += sign * measure;
    return;
  }
  const double slope = slope_of_independent(level, closing, at, scratch);
  if (slope == 0) return;
  for (std::size_t i = 0; i < scratch.own.size(); ++i) scratch.adjoints[i] -= sign * measure / slope * scratch.own[i];
}

/// Derivative, with respect to the coordinate of `level`, of the independent constraint that bounds an interval.
/// scratch.own receives the derivatives of this constraint with respect to the registers.
double NestedIntegral::slope_of_independent(std::size_t level, IntervalBound closing, double at,
                                            IntegralScratch& scratch) const {
  set(level, at, scratch);
  return stage_derivative(plan().program, level + 1, plan().independent[level + 1][closing - 1], scratch.registers,
                          scratch.own);
}

}  // namespace pkm::generic
