#include "engine/accelerators/hybrid/cells.hpp"

namespace pkm::hybrid {
namespace {

template <class L>
[[gnu::always_inline]] inline L square(const Product<double>& e, const L& z) {
  return (e.a + e.a_z * z) * (e.b + e.b_z * z);
}

}  // namespace

template <InstructionSet set>
CellTally fill(const ColumnsAtBeta& at, CellRuns& runs) {
  using L = LanesOf<set>;
  const double per_cell = 1 / at.x_step, offset = -at.x_lower * per_cell - 0.5;
  // The following functions return positions in units of cells: the first centre that is not below x, and the centre
  // after the last one that is not above x.
  const auto ceiling = [&](const L& x) { return ceil(lesser(greater(x * per_cell + offset, L(0.0)), L(at.cells))); };
  const auto floor_and_one = [&](const L& x) {
    return floor(lesser(greater(x * per_cell + offset, L(-1.0)), L(at.cells - 1))) + 1.0;
  };
  L sum = 0.0, lowest = at.cells, highest = 0.0;
  for (std::size_t j = at.first_z; j < at.end_z; j += kLanes) {
    const L z = L::load(at.z + j), n3 = at.sign * sqrt_or_zero(square(at.C, z));
    const L chain = sqrt_or_zero(lesser(lesser(square(at.Q, z), square(at.P, z)), square(at.L, z)));
    const L first = ceiling(greater(greater(L::load(at.left + j), at.lo_C + n3), -chain));
    const L last = floor_and_one(lesser(lesser(L::load(at.right + j), at.hi_C + n3), chain));
    const L end = select(z <= at.z_high, greater(first, last), first);
    L hole = end, after = end;
    if (at.z[j] < at.hole_end) {  // true if at least one z of the batch is below the end of the hole
      const L half = sqrt_or_zero(square(at.H, z));
      const L from = greater(floor_and_one(-half), first), to = lesser(ceiling(half), end);
      const auto there = (z < at.hole_end) & (from < to);
      hole = select(there, from, end);
      after = select(there, to, end);
    }
    first.store(&runs.first[j]);
    hole.store(&runs.hole[j]);
    after.store(&runs.after[j]);
    end.store(&runs.end[j]);
    const L before = hole - first, behind = end - after;
    sum += before + behind;
    lowest = lesser(lowest, select(before > 0.0, first, select(behind > 0.0, after, L(at.cells))));
    highest = greater(highest, select(behind > 0.0, end, select(before > 0.0, hole, L(0.0))));
  }
  double lane[kLanes], cells = 0;
  sum.store(lane);
  for (const double in_lane : lane) cells += in_lane;
  return {cells, reduce_min(lowest) == 0 || reduce_max(highest) == at.cells};
}

template CellTally fill<PKM_INSTRUCTION_SET>(const ColumnsAtBeta&, CellRuns&);

}  // namespace pkm::hybrid
