#include "engine/math/lanes.hpp"
#include "engine/mechanisms/described/column_cells.hpp"

namespace pkm::described {

template <InstructionSet set>
void narrow(Shape shape, const std::array<graph::Operand, 3>& c, const double* registers, const double* rows,
            const ColumnGrid& grid, std::size_t count, CellRanges& ranges) {
  using L = LanesOf<set>;
  const L none(0.0), all(grid.cells);
  const double per_step = 1 / grid.step;
  const auto load = [&](const graph::Operand& operand, std::size_t k) __attribute__((always_inline)) {
    return operand.row ? L::load(rows + operand.index * graph::kRow + k) : L(registers[operand.index]);
  };
  // in cells, beyond the column's ends by one at most
  const auto place = [&](const L& z) __attribute__((always_inline)) {
    return lesser(greater((z - grid.first) * per_step, L(-1.0)), all);
  };
  const auto first_at = [&](const L& t) __attribute__((always_inline)) { return ceil(greater(t, none)); };
  const auto end_at = [&](const L& t) __attribute__((always_inline)) { return floor(lesser(t, all - 1.0)) + 1.0; };
  for (std::size_t k = 0; k < count; k += kLanes) {
    const L c0 = load(c[0], k), b = load(c[1], k);
    L from = none, to = all;
    if (shape == Shape::line) {
      const L end = place(-c0 / b);
      from = select(b > 0.0, first_at(end), none);
      to = select(b < 0.0, end_at(end), all);
      const auto flat = (b <= 0.0) & (b >= 0.0);
      to = select(flat, select(c0 >= 0.0, all, none), to);
      const L number = c0 + b;
      to = select(number >= number, to, none);
    } else {
      // The roots q / a and c0 / q lose no digits; of a line, a = 0, the first is infinite.
      const L a = load(c[2], k) + 0.0;
      const L discriminant = b * b - 4.0 * (a * c0), root = root_or_zero(discriminant);
      const L q = (b + select(b < 0.0, -root, root)) * -0.5;
      const L r1 = q / a, r2 = c0 / q;
      const L low = place(lesser(r1, r2)), high = place(greater(r1, r2));
      const auto concave = a < 0.0;
      from = select(concave, first_at(low), none);
      to = select(concave, select(discriminant >= 0.0, end_at(high), none), all);
      if (shape == Shape::any) {
        const auto flat = (a <= 0.0) & (a >= 0.0) & (b <= 0.0) & (b >= 0.0);
        to = select(flat, select(c0 >= 0.0, all, none), to);
        const auto open = discriminant > 0.0;
        select(open, select(concave, none, greater(floor(low) + 1.0, none)), none).store(&ranges.drop_from[k]);
        select(open, select(concave, none, ceil(high)), none).store(&ranges.drop_to[k]);
      }
      to = select(discriminant >= discriminant, to, none);
    }
    greater(L::load(&ranges.from[k]), from).store(&ranges.from[k]);
    lesser(L::load(&ranges.to[k]), to).store(&ranges.to[k]);
  }
}

template void narrow<PKM_INSTRUCTION_SET>(Shape, const std::array<graph::Operand, 3>&, const double*, const double*,
                                          const ColumnGrid&, std::size_t, CellRanges&);

}  // namespace pkm::described
