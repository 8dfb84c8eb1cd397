// Roots of transcendental constraints along a column, by interval branch and prune: an interval is discarded if the
// constraint has no root in it, accepted if the constraint is monotonic in it, and otherwise bisected. No root is
// missed.
#include <bit>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/column.hpp"
#include "engine/math/roots.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {

/// Appends the roots to the quadratic ones. @param signs  receives those of transcendental constraints at the lower end
void Column::find_transcendental_roots(const std::array<double, 2>& range, std::span<double> registers, Signs& signs,
                                       ColumnScratch& scratch) const {
  scratch.intervals.resize(registers.size());
  for (std::size_t i = 0; i < registers.size(); ++i) scratch.intervals[i] = Interval(registers[i]);
  set_z<double>(range[0], registers);
  for (Signs rest = transcendental_; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    if (is_satisfied(registers[plan_.surfaces[k].coefficients[0]])) signs |= bit(k);
  }
  isolate(transcendental_, range[0], range[1], 1e-12 * (range[1] - range[0]), registers, scratch);
}

/// @param narrow  width below which an undecided sign change is accepted as a root
void Column::isolate(Signs curves, double from, double to, double narrow, std::span<double> registers,
                     ColumnScratch& scratch) const {
  check_stop();
  if (++scratch.bisections > scratch.max_bisections) throw TooManyBisections();
  set_z<Interval>({from, to}, scratch.intervals);
  const double middle = 0.5 * (from + to);
  // An interval of a few ulp, or NaN, has no midpoint.
  const bool is_narrow = to - from <= narrow || !(from < middle && middle < to);
  Signs monotone = 0, undecided = 0;
  for (Signs rest = curves; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    const auto& at = plan_.surfaces[k].coefficients;
    const Interval &f = scratch.intervals[at[0]], &slope = scratch.intervals[at[1]];
    if (f.is_certified_satisfied() || f.is_certified_violated()) continue;
    const bool has_one =
        f.is_defined() && f.is_continuous() && slope.is_defined() && (slope.lower > 0 || slope.upper < 0);
    (has_one || is_narrow ? monotone : undecided) |= bit(k);
  }
  for (; monotone != 0; monotone &= monotone - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(monotone));
    const std::uint32_t f = plan_.surfaces[k].coefficients[0];
    set_z<double>(from, registers);
    const bool below = is_satisfied(registers[f]);
    set_z<double>(to, registers);
    if (below != is_satisfied(registers[f]))
      scratch.quadratic.emplace_back(bracketed_root_of(k, from, to, below, registers),
                                     static_cast<EndLabel>(2 * k + (below ? 1 : 0)));
  }
  if (undecided == 0) return;
  isolate(undecided, from, middle, narrow, registers, scratch);
  isolate(undecided, middle, to, narrow, registers, scratch);
}

/// Root of a constraint with a single sign change between two z. @param satisfied_at_from  whether it is satisfied
/// there
double Column::bracketed_root_of(std::size_t curve, double from, double to, bool satisfied_at_from,
                                 std::span<double> registers) const {
  const auto& at = plan_.surfaces[curve].coefficients;
  const auto value_at = [&](double z) {
    set_z<double>(z, registers);
    return ValueAndDerivative{registers[at[0]], registers[at[1]]};
  };
  const double tolerance = 1e-16 * (std::fabs(from) + std::fabs(to));
  return refine_root_newton(
      value_at, from, to, satisfied_at_from, 0.5 * (from + to),
      [&](const ValueAndDerivative&, double z, double next) { return std::fabs(next - z) <= tolerance; });
}

void Column::add_gradient_of_transcendental(const Surface& surface, double z, double factor,
                                            std::span<double> registers, std::span<double> adjoints) const {
  const expression::Program& program = plan_.program;
  const std::size_t stage = program.stages().size() - 1;
  set_z<double>(z, registers);
  adjoints[surface.coefficients[0]] += factor / registers[surface.coefficients[1]];
  backward_sweep(program, stage, registers, adjoints);
  for (const auto& input : program.stages()[stage].inputs) adjoints[input.to] = 0;
}

}  // namespace pkm::generic
