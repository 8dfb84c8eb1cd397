#include "engine/workspace/solid_on_grid.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

/// The proportions that are tried, as lists with one dimension per ball. They are the given ratio or, if the
/// proportions are free, ratios 1, 1/4, 1/2, 2 and 4 of each dimension to the first one.
std::vector<std::vector<double>> proportions(const SolidSpec& spec) {
  if (!spec.ratio.empty()) return {spec.ratio};
  std::vector<std::vector<double>> all = {{1}};
  for (std::size_t ball = 1; ball < spec.shape.balls(); ++ball) {
    std::vector<std::vector<double>> more;
    for (const std::vector<double>& each : all)
      for (const double ratio : {1.0, 0.25, 0.5, 2.0, 4.0}) {
        more.push_back(each);
        more.back().push_back(ratio);
      }
    all = std::move(more);
  }
  return all;
}

/// A row of cells along the last axis, relative to the central cell of a solid: offsets i and j along the first two
/// axes, and all offsets from -half to half along the last one.
struct RowOfCells {
  std::int64_t i, j, half;
};

class GridSearch {
 public:
  GridSearch(const VoxelGrid& grid, const std::vector<std::uint8_t>& good, const SolidSpec& spec)
      : grid_(grid), good_(good), spec_(spec), bad_before_(good.size() + 1) {
    for (std::size_t cell = 0; cell < good.size(); ++cell)
      bad_before_[cell + 1] = bad_before_[cell] + (good[cell] ? 0 : 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      range_[axis] = {0, grid.cells[axis]};
      if (!spec.centre[axis]) continue;
      const auto layer = std::floor((*spec.centre[axis] - grid.lower[axis]) / grid.step[axis]);
      const auto k = static_cast<std::int64_t>(std::clamp(layer, 0.0, static_cast<double>(grid.cells[axis] - 1)));
      range_[axis] = {k, k + 1};
    }
  }

  std::optional<Solid> run() {
    std::optional<Solid> best;
    double best_volume = 0;
    for (const std::vector<double>& ratio : proportions(spec_)) {
      // The scale factor of the solid is increased in steps, each of which extends one dimension by two cells.
      double step = std::numeric_limits<double>::infinity();
      for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis)
        step = std::min(step, 2 * grid_.step[axis] / ratio[spec_.shape.ball_of(axis)]);
      const auto scaled = [&](std::int64_t k) {
        std::vector<double> dimensions = ratio;
        for (double& dimension : dimensions) dimension *= (static_cast<double>(k) + 0.5) * step;
        return dimensions;
      };
      std::int64_t next = 0;
      while (spec_.shape.volume(scaled(next)) <= best_volume) ++next;
      const std::int64_t first = next;
      set_rows(scaled(next));
      for_each_centre([&](const Cell& cell) {
        while (fits(cell)) set_rows(scaled(++next));
      });
      if (next == first) continue;
      best = Solid{{}, scaled(next - 1)};
      best_volume = spec_.shape.volume(best->dimensions);
    }
    if (best) best->centre = central_position(best->dimensions);
    return best;
  }

 private:
  /// Calls visit(cell) for each good cell (a cell that may be in the solid) for which the current solid, centred at it,
  /// does not extend beyond the grid.
  template <class Visit>
  void for_each_centre(const Visit& visit) const {
    std::array<std::int64_t, 3> first{}, end{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      first[axis] = std::max(range_[axis][0], half_[axis]);
      end[axis] = std::min(range_[axis][1], grid_.cells[axis] - half_[axis]);
    }
    Cell cell;
    for (cell[0] = first[0]; cell[0] < end[0]; ++cell[0])
      for (cell[1] = first[1]; cell[1] < end[1]; ++cell[1])
        for (cell[2] = first[2]; cell[2] < end[2]; ++cell[2])
          if (good_[grid_.index(cell)]) visit(cell);
  }

  /// Computes the rows of cells that a solid with these dimensions covers. The outermost rows come first, because their
  /// cells are most likely to be bad, i.e. not allowed in the solid.
  void set_rows(const std::vector<double>& dimensions) {
    rows_.clear();
    const std::size_t axes = spec_.shape.axes();
    for (std::size_t axis = 0; axis < axes; ++axis)
      half_[axis] = static_cast<std::int64_t>(dimensions[spec_.shape.ball_of(axis)] / 2 / grid_.step[axis]);
    for (std::int64_t i = -half_[0]; i <= half_[0]; ++i)
      for (std::int64_t j = -half_[1]; j <= half_[1]; ++j) {
        const std::array<std::int64_t, 2> offset = {i, j};
        // For each ball: squared distance of the row from the ball's centre, relative to its squared radius.
        std::array<double, 3> squares{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const std::size_t ball = spec_.shape.ball_of(axis);
          squares[ball] += std::pow(static_cast<double>(offset[axis]) * grid_.step[axis] * 2 / dimensions[ball], 2);
        }
        if (std::ranges::max(squares) > 1) continue;
        const double rest = axes == 3 ? std::sqrt(1 - squares[spec_.shape.ball_of(2)]) : 0;
        const double length = axes == 3 ? dimensions[spec_.shape.ball_of(2)] / 2 / grid_.step[2] : 0;
        rows_.push_back({i, j, static_cast<std::int64_t>(rest * length)});
      }
    std::ranges::stable_sort(rows_, std::greater(),
                             [](const RowOfCells& row) { return row.i * row.i + row.j * row.j; });
  }

  /// True if all cells of the current solid, centred at this cell, exist and are good.
  bool fits(const Cell& cell) const {
    return std::ranges::all_of(rows_, [&](const RowOfCells& row) {
      const Cell first = {cell[0] + row.i, cell[1] + row.j, cell[2] - row.half};
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (first[axis] < 0 || first[axis] >= grid_.cells[axis]) return false;
      if (cell[2] + row.half >= grid_.cells[2]) return false;
      const std::size_t at = grid_.index(first);
      return bad_before_[at + static_cast<std::size_t>(2 * row.half + 1)] == bad_before_[at];
    });
  }

  std::array<double, 3> central_position(const std::vector<double>& dimensions) {
    set_rows(dimensions);
    std::vector<Cell> positions;
    for_each_centre([&](const Cell& cell) {
      if (fits(cell)) positions.push_back(cell);
    });
    std::array<double, 3> mean{};
    for (const Cell& at : positions)
      for (std::size_t axis = 0; axis < 3; ++axis)
        mean[axis] += grid_.centre(axis, at[axis]) / static_cast<double>(positions.size());
    const auto square_distance = [&](const Cell& at) {
      double square = 0;
      for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis)
        square += std::pow(grid_.centre(axis, at[axis]) - mean[axis], 2);
      return square;
    };
    const Cell& nearest = *std::ranges::min_element(positions, {}, square_distance);
    std::array<double, 3> centre{};
    for (std::size_t axis = 0; axis < spec_.shape.axes(); ++axis)
      centre[axis] = spec_.centre[axis].value_or(grid_.centre(axis, nearest[axis]));
    return centre;
  }

  const VoxelGrid& grid_;
  const std::vector<std::uint8_t>& good_;
  const SolidSpec& spec_;
  std::vector<std::uint32_t> bad_before_;  ///< bad_before_[k]: number of bad cells (not good) with an index < k
  /// For each axis, the range of indices that the central cell can have: first, end (excluded).
  std::array<std::array<std::int64_t, 2>, 3> range_{};
  std::vector<RowOfCells> rows_;
  /// For each axis, the largest distance, in cells, of a cell of the solid from the central cell.
  std::array<std::int64_t, 3> half_{};
};

}  // namespace

std::optional<Solid> largest_solid_on_grid(const VoxelGrid& grid, const std::vector<std::uint8_t>& good,
                                           const SolidSpec& spec) {
  return GridSearch(grid, good, spec).run();
}

}  // namespace pkm
