#include <limits>

#include "engine/accelerators/four_ppa_two_par/cells.hpp"

namespace pkm::four_ppa_two_par {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The columns of kLanes thetas, with the limits solved for z, so that one evaluation yields all cells of a column.
template <class L>
struct ColumnLimits {
  double l_d2, x_min, x_max, parallel, bottom;  ///< parallel: l_d^2 sin_par_min; bottom: maximum of -z_c
  /// Grid along x and z. per_cell: number of cells per length of z; offset: position of z = -d in cells, relative to
  /// the centre of the first cell.
  double x_step, cells, per_cell, offset;
  L x_0, w;        ///< x_1 of the first column; w = x_1 + x_2, which is the same for all columns at one theta
  L top_1, top_2;  ///< minimum of -z_c of each limb; infinite if no pose is feasible at this theta
  std::int64_t x_begin, x_end;  ///< columns outside this range have no feasible cells at any theta of the batch

  explicit ColumnLimits(const ColumnsAtThetas& at) {
    l_d2 = at.l_d * at.l_d;
    x_min = at.x_min;
    x_max = at.x_max;
    parallel = at.sin_par_min * at.l_d * at.l_d;
    bottom = at.z_low;
    x_step = at.x_step;
    cells = at.z_cells;
    per_cell = 1 / at.z_step;
    offset = (-at.d - at.z_lower) * per_cell - 0.5;

    const L sine = L::load(at.sines), cosine = L::load(at.cosines);
    const L shift = at.a * sine * 0.5, half = at.a * cosine * 0.5;
    const L y_1 = at.y - shift, y_2 = at.y + shift, H_1 = lesser(y_1, at.L0 - y_1), H_2 = lesser(y_2, at.L0 - y_2);
    const auto has_poses =
        (L::load(kIndex) < static_cast<double>(at.thetas)) & (cosine >= at.cos_theta_min) & (H_1 >= 0.0) & (H_2 >= 0.0);
    const auto top = [&](const L& H) {
      const L depth = sqrt_or_zero((at.l_u - H) * (at.l_u + H));
      return select(has_poses, greater(L(at.z_high), depth), L(kInfinity));
    };
    top_1 = top(H_1);
    top_2 = top(H_2);
    x_0 = (at.x_lower + 0.5 * x_step) - half;
    w = at.b - 2.0 * half;

    const double low = reduce_min(select(has_poses, greater(L(x_min), w - x_max) - x_0, L(kInfinity)));
    const double high = reduce_max(select(has_poses, lesser(L(x_max), w - x_min) - x_0, L(-kInfinity)));
    const auto columns = static_cast<double>(at.columns);
    const auto index = [&](double i) { return static_cast<std::int64_t>(i > 0 ? i < columns ? i : columns : 0); };
    x_begin = index(low / x_step - 1);  // use one more column on each side, because of rounding errors
    x_end = index(high / x_step + 2);
  }

  /// The feasible cells along z of the column with index i, for each theta of the batch.
  struct Cells {
    L first, end;
    decltype(L() < L()) exist;
  };
  [[gnu::always_inline]] Cells operator[](std::int64_t i) const {
    const L x_1 = x_0 + static_cast<double>(i) * x_step, x_2 = w - x_1;
    const L sigma_1 = sqrt_or_zero(l_d2 - x_1 * x_1), sigma_2 = sqrt_or_zero(l_d2 - x_2 * x_2);
    // The following heights are positions in units of cells. The feasible cells extend from the first centre at or
    // above the lower end to the last centre at or below the upper end.
    const L low = offset - (bottom + lesser(sigma_1, sigma_2)) * per_cell;
    const L high = offset - greater(top_1 + sigma_1, top_2 + sigma_2) * per_cell;
    const L first = ceil(lesser(greater(low, L(0.0)), L(cells)));
    const L end = floor(lesser(greater(high, L(-1.0)), L(cells - 1))) + 1.0;
    const auto inside =
        (lesser(x_1, x_2) >= x_min) & (greater(x_1, x_2) <= x_max) & (x_1 * sigma_2 + x_2 * sigma_1 >= parallel);
    return {first, end, inside & (end > first)};
  }

 private:
  static constexpr double kIndex[kLanes] = {0, 1, 2, 3, 4, 5, 6, 7};
};

}  // namespace

template <InstructionSet set>
CellTally tally(const ColumnsAtThetas& at, std::int64_t from, std::int64_t to) {
  using L = LanesOf<set>;
  const ColumnLimits<L> limits(at);
  L sum = 0.0, in_first = 0.0, in_last = 0.0, lowest = kInfinity, highest = 0.0;
  const std::int64_t begin = limits.x_begin > from ? limits.x_begin : from, end = limits.x_end < to ? limits.x_end : to;
  for (std::int64_t i = begin; i < end; ++i) {
    const auto column = limits[i];
    const L found = select(column.exist, column.end - column.first, L(0.0));
    sum += found;
    lowest = lesser(lowest, select(column.exist, column.first, L(kInfinity)));
    highest = greater(highest, select(column.exist, column.end, L(0.0)));
    if (i == 0) in_first = found;
    if (i == at.columns - 1) in_last = found;
  }
  CellTally result;
  sum.store(result.cells);
  in_first.store(result.in_first);
  in_last.store(result.in_last);
  result.lowest = reduce_min(lowest) == 0;
  result.highest = reduce_max(highest) == limits.cells;
  return result;
}

template <InstructionSet set>
void fill(const ColumnsAtThetas& at, ColumnBlock& block) {
  using L = LanesOf<set>;
  const ColumnLimits<L> limits(at);
  block.x_begin = limits.x_begin;
  block.x_end = limits.x_end;
  for (std::int64_t i = limits.x_begin; i < limits.x_end; ++i) {
    const auto column = limits[i];
    column.first.store(block.first.data() + i * kLanes);
    select(column.exist, column.end, L(0.0)).store(block.end.data() + i * kLanes);
  }
}

template CellTally tally<PKM_INSTRUCTION_SET>(const ColumnsAtThetas&, std::int64_t, std::int64_t);
template void fill<PKM_INSTRUCTION_SET>(const ColumnsAtThetas&, ColumnBlock&);

}  // namespace pkm::four_ppa_two_par
