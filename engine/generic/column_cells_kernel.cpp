#include "engine/generic/column_cells.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::generic {

template <InstructionSet set>
bool contract(const ColumnConstraint& constraint, const double* registers, const double* rows, const ColumnGrid& grid,
              std::size_t count, CellRanges& ranges) {
  using L = LanesOf<set>;
  const auto& [shape, c, has_alternative, alternative] = constraint;
  // If the alternative constraint has one value for all columns and is satisfied, the ranges of cells remain unchanged.
  if (has_alternative && !alternative.row && registers[alternative.index] >= 0) return false;
  const bool may_have_holes = shape == Shape::convex || shape == Shape::any;
  const L none(0.0), all(grid.cells);
  const double per_step = 1 / grid.step;
  const auto load = [&](const expression::Operand& operand, std::size_t k) __attribute__((always_inline)) {
    return operand.row ? L::load(rows + operand.index * expression::kRow + k) : L(registers[operand.index]);
  };
  // Converts a coordinate z to a fractional cell index, clamped to [-1, number of cells].
  const auto cell_at = [&](const L& z) __attribute__((always_inline)) {
    return lesser(greater((z - grid.first) * per_step, L(-1.0)), all);
  };
  const auto first_from = [&](const L& t) __attribute__((always_inline)) { return ceil(greater(t, none)); };
  const auto end_after = [&](const L& t) __attribute__((always_inline)) { return floor(lesser(t, all - 1.0)) + 1.0; };
  const double leading = shape == Shape::any || shape == Shape::linear ? 0 : registers[c[2].index];
  bool has_holes = false;
  for (std::size_t k = 0; k < count; k += kLanes) {
    const L previous_from = L::load(&ranges.from[k]), previous_to = L::load(&ranges.to[k]);
    if (may_have_holes) {
      none.store(&ranges.hole_from[k]);
      none.store(&ranges.hole_to[k]);
    }
    if (!any(previous_from < previous_to)) continue;
    const L c0 = load(c[0], k), b = load(c[1], k);
    L from = none, to = all, hole_from = none, hole_to = none;
    if (shape == Shape::linear) {
      const L end = cell_at(-c0 / b);
      from = select(b > 0.0, first_from(end), none);
      to = select(b < 0.0, end_after(end), all);
      const auto is_constant = (b <= 0.0) & (b >= 0.0);
      to = select(is_constant, select(c0 >= 0.0, all, none), to);
      const L sum = c0 + b;
      to = select(sum >= sum, to, none);  // if the sum is NaN, the constraint is undefined: no cell is feasible
    } else if (shape != Shape::any) {
      const L discriminant = b * b - (4.0 * leading) * c0, root = sqrt_or_zero(discriminant);
      const double half = 0.5 / (leading < 0 ? -leading : leading);
      const L centre = b * (-0.5 / leading), reach = root * half;
      const L low = cell_at(centre - reach), high = cell_at(centre + reach);
      if (shape == Shape::concave) {
        from = first_from(low);
        to = select(discriminant >= 0.0, end_after(high), none);
      } else {
        const auto has_roots = discriminant > 0.0;
        hole_from = select(has_roots, greater(floor(low) + 1.0, none), none);
        hole_to = select(has_roots, ceil(high), none);
        to = select(discriminant >= discriminant, to, none);
      }
    } else {
      // Compute the roots of a z^2 + b z + c0 without cancellation as q / a and c0 / q, with q as defined below. The
      // root q / a is infinite if a = 0.
      const L a = load(c[2], k) + 0.0;
      const L discriminant = b * b - 4.0 * (a * c0), root = sqrt_or_zero(discriminant);
      const L q = (b + select(b < 0.0, -root, root)) * -0.5;
      const L r1 = q / a, r2 = c0 / q;
      const L low = cell_at(lesser(r1, r2)), high = cell_at(greater(r1, r2));
      const auto concave = a<0.0, has_roots = discriminant> 0.0;
      from = select(concave, first_from(low), none);
      to = select(concave, select(discriminant >= 0.0, end_after(high), none), all);
      hole_from = select(has_roots, select(concave, none, greater(floor(low) + 1.0, none)), none);
      hole_to = select(has_roots, select(concave, none, ceil(high)), none);
      const auto is_constant = (a <= 0.0) & (a >= 0.0) & (b <= 0.0) & (b >= 0.0);
      to = select(is_constant, select(c0 >= 0.0, all, none), to);
      to = select(discriminant >= discriminant, to, none);
    }
    if (has_alternative) {
      const auto always = load(alternative, k) >= 0.0;
      from = select(always, none, from);
      to = select(always, all, to);
      hole_to = select(always, none, hole_to);
    }
    from = greater(previous_from, from);
    to = lesser(previous_to, to);
    if (may_have_holes) {  // if a hole extends over an end of the range, shorten the range instead
      const auto has_hole = hole_from < hole_to;
      from = select(has_hole & (hole_from <= from), greater(from, hole_to), from);
      to = select(has_hole & (hole_to >= to), lesser(to, hole_from), to);
      const auto inside = has_hole & (from < hole_from) & (hole_to < to);
      hole_from = select(inside, hole_from, none);
      hole_to = select(inside, hole_to, none);
      hole_from.store(&ranges.hole_from[k]);
      hole_to.store(&ranges.hole_to[k]);
      has_holes = has_holes || any(inside);
    }
    from.store(&ranges.from[k]);
    to.store(&ranges.to[k]);
  }
  return has_holes;
}

template bool contract<PKM_INSTRUCTION_SET>(const ColumnConstraint&, const double*, const double*, const ColumnGrid&,
                                            std::size_t, CellRanges&);

}  // namespace pkm::generic
