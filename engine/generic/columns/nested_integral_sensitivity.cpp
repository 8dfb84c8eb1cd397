// Sensitivities of the intervals on which the nodes of an integral are placed: the nodes are functions of the design.
#include "engine/generic/columns/nested_integral.hpp"

namespace pkm::generic {

void NestedIntegral::start_dual(std::span<const Dual4> inputs, IntegralScratch& scratch) const {
  const expression::Program& program = plan().program;
  scratch.dual_registers.resize(program.registers());
  program.start<Dual4>(scratch.dual_registers);
  program.run<Dual4>(0, inputs, scratch.dual_registers);
}

void NestedIntegral::set_dual(std::size_t level, const Dual4& at, IntegralScratch& scratch) const {
  for (const auto& input : plan().program.stages()[level + 1].inputs) scratch.dual_registers[input.to] = at;
  plan().program.run<Dual4>(level + 1, std::span<Dual4>(scratch.dual_registers));
}

std::vector<SmoothInterval> NestedIntegral::merged_intervals(std::size_t level, const IntegralScratch& scratch) {
  std::vector<SmoothInterval> whole;
  for (const SmoothInterval& part : scratch.levels[level].parts) {
    SmoothInterval* const last = whole.empty() ? nullptr : &whole.back();
    if (!last || last->piece.upper != part.piece.lower || last->above.hash != part.below.hash) {
      whole.push_back(part);
      continue;
    }
    last->piece.upper = part.piece.upper;
    last->piece.sqrt_at_upper = part.piece.sqrt_at_upper;
    last->above = part.above;
    last->upper = part.upper;
    last->beyond_upper = part.beyond_upper;
  }
  return whole;
}

Subinterval<Dual4> NestedIntegral::differentiable_piece(std::size_t level, const SmoothInterval& part,
                                                        const Dual4* below, IntegralScratch& scratch) const {
  const bool continues = below && part.lower == kCriticalValue && below->a == part.piece.lower;
  return {continues ? *below : differentiable_end(level, part, false, scratch),
          differentiable_end(level, part, true, scratch), part.piece.sqrt_at_lower, part.piece.sqrt_at_upper};
}

/// An endpoint of an interval with its derivatives with respect to the design. Critical values of outer levels, and
/// those of slices that are lines, count as constant: the measure is continuous there, so that the derivative of the
/// sum over the nodes is that of the integral up to the error of the quadrature rule. At a discontinuity, the critical
/// value moves with the constraint that is violated beyond it.
Dual4 NestedIntegral::differentiable_end(std::size_t level, const SmoothInterval& part, bool upper,
                                         IntegralScratch& scratch) const {
  const expression::Program& program = plan().program;
  const IntervalBound closing = upper ? part.upper : part.lower;
  const double at = upper ? part.piece.upper : part.piece.lower;
  const auto [from, to] = plan().range[level];
  if (closing == kBox) return {at, scratch.dual_registers[upper ? to : from].v};
  if (closing != kCriticalValue) {
    const double slope = slope_of_independent(level, closing, at, scratch);
    return differentiable_root(at, tangent(scratch.own, scratch.dual_registers), slope);
  }
  // The derivatives of a critical value at a discontinuity are the mean over the points that become feasible or
  // infeasible at the critical value.
  if (may_jump(level, part, upper, scratch)) {
    Components<4> motion;
    double all = 0;
    for (const double side : {-1.0, 1.0})
      visit_one_sided(level, part, upper, side, scratch, [&](double weight, double slope) {
        motion = motion + tangent(scratch.own, scratch.dual_registers) * (-weight / slope);
        all += weight;
      });
    if (all > 0) return {at, motion * (1 / all)};
  }
  const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_);
  if (level + 1 < levels() || !planar_slice) return at;
  set_dual(level, at, scratch);
  scratch.along.assign(scratch.registers.begin(), scratch.registers.end());
  for (const auto& input : program.stages()[level + 1].inputs) scratch.along[input.to] = Dual4::variable(at, 0);
  program.run<Dual4>(level + 1, std::span<Dual4>(scratch.along));
  const auto ends_at = [&](double place) {
    return slice(level, place, scratch).hash == 0 ? std::vector<ArcEnd>()
                                                  : arc_ends(*planar_slice, scratch.planar_slice);
  };
  // Use slices next to the critical value, or slices farther away as long as the type depends on rounding errors.
  for (double share = kClearDistance; share < 1e-3; share *= 1e3) {
    const double beside = (upper ? -share : share) * (scratch.registers[to] - scratch.registers[from]);
    const std::vector<ArcEnd> outside = ends_at(at - beside), inside = ends_at(at + beside);
    const auto motion = differentiable_critical_value(
        at, inside, outside, scratch.planar_slice,
        PlanarSliceSensitivity(*planar_slice, scratch.planar_slice, scratch.dual_registers, scratch.registers),
        PlanarSliceSensitivity(*planar_slice, scratch.planar_slice, scratch.along, scratch.registers));
    if (motion) return *motion;
  }
  return at;
}

}  // namespace pkm::generic
