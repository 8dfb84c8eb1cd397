// Ends of columns at the roots of any formulas. Intervals tell where a formula has no root, and where it rises or falls
// all along and so has one at most; in between they are halved. None is missed.
#include <bit>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/column.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {

/// Appends them to the flat ones. @param signs  of the curves at the lower end of the range are set
void Column::find_curve_ends(const std::array<double, 2>& range, std::span<double> registers, Signs& signs,
                             ColumnRoom& room) const {
  room.intervals.resize(registers.size());
  for (std::size_t i = 0; i < registers.size(); ++i) room.intervals[i] = Interval(registers[i]);
  set_z<double>(range[0], registers);
  for (Signs rest = curves_; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    if (is_satisfied(registers[plan_.surfaces[k].coefficients[0]])) signs |= bit(k);
  }
  isolate(curves_, range[0], range[1], 1e-12 * (range[1] - range[0]), registers, room);
}

/// @param narrow  where nothing is decided over so much, a change of sign is an end
void Column::isolate(Signs curves, double from, double to, double narrow, std::span<double> registers,
                     ColumnRoom& room) const {
  check_stop();
  if (++room.halvings > room.most_halvings) throw TooManyHalvings();
  set_z<Interval>({from, to}, room.intervals);
  const double middle = 0.5 * (from + to);
  // A range of few units in the last place, or NaN, has no middle.
  const bool is_narrow = to - from <= narrow || !(from < middle && middle < to);
  Signs monotone = 0, undecided = 0;
  for (Signs rest = curves; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    const auto& at = plan_.surfaces[k].coefficients;
    const Interval &f = room.intervals[at[0]], &slope = room.intervals[at[1]];
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
      room.flat.emplace_back(root_between(k, from, to, registers), static_cast<EndLabel>(2 * k + (below ? 1 : 0)));
  }
  if (undecided == 0) return;
  isolate(undecided, from, middle, narrow, registers, room);
  isolate(undecided, middle, to, narrow, registers, room);
}

/// The root of a formula that changes its sign once: Newton's method, kept inside by halving.
double Column::root_between(std::size_t curve, double from, double to, std::span<double> registers) const {
  const auto& at = plan_.surfaces[curve].coefficients;
  set_z<double>(from, registers);
  const bool below = is_satisfied(registers[at[0]]);
  double z = 0.5 * (from + to);
  for (int step = 0; step < 100; ++step) {
    set_z<double>(z, registers);
    const double f = registers[at[0]];
    (is_satisfied(f) == below ? from : to) = z;
    double next = z - f / registers[at[1]];
    if (!(next > from && next < to)) next = 0.5 * (from + to);
    if (next == z || std::fabs(next - z) <= 1e-16 * (std::fabs(from) + std::fabs(to))) return next;
    z = next;
  }
  return z;
}

void Column::add_slopes_of_curve(const Surface& surface, double z, double factor, std::span<double> registers,
                                 std::span<double> adjoints) const {
  const expression::Program& program = plan_.program;
  const std::size_t stage = program.stages().size() - 1;
  set_z<double>(z, registers);
  adjoints[surface.coefficients[0]] += factor / registers[surface.coefficients[1]];
  backward_sweep(program, stage, registers, adjoints);
  for (const auto& input : program.stages()[stage].inputs) adjoints[input.to] = 0;
}

}  // namespace pkm::generic
