// (3CRR/R)&CRU and Quadrupteron: feasible voxels of a slice from three tables of bits (README.md). The result is the
// same as that of testing every pose: rows are determined from the endpoints of chords (bit_rows.hpp), and the cells
// next to an endpoint are decided by the test itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/accelerators/crr_cru/bit_rows.hpp"
#include "engine/accelerators/crr_cru/position_set.hpp"
#include "engine/mechanism/workspace_result.hpp"
#include "engine/workspace/cell_runs.hpp"

namespace pkm::crr_cru {

/// Axes of the grid that correspond to the outer coordinate and to the axes u and v of SliceAxes.
struct GridAxes {
  std::size_t outer, u, v;
};
inline GridAxes grid_axes(const FixedCoordinate& fixed) {
  return fixed.coordinate == 3 ? GridAxes{0, 1, 2} : GridAxes{2, 0, 1};
}

/// A box that contains every feasible pose, from the ranges of the slides and kappa_p >= 0.
Box default_box(const Design<double>& d, const FixedCoordinate& fixed);

/// Rows of bits that mark feasible cells along one coordinate, one row for every cell along another coordinate. Rows
/// are padded to whole words; empty rows are added up to a multiple of kLanes.
struct BitTable {
  std::size_t words = 0;  ///< number of words per row
  std::vector<std::uint64_t> bits;

  std::span<const std::uint64_t> row(std::size_t i) const { return {bits.data() + i * words, words}; }
};

/// The feasible cells at one phi, in planes normal to one coordinate, n. Several threads can use a filled object.
class SliceCells {
 public:
  /// Finds the feasible cells.
  /// @return false if a table is empty, so that no cell is feasible
  bool fill(const Design<double>& d, const FixedCoordinate& fixed, const VoxelGrid& grid, double phi);

  /// Calls visit(u) for every u at which a column along v has feasible cells.
  /// @param n    number of the plane along its normal; 0 if the coordinate normal to the plane is fixed
  /// @param row  receives the bits of the column before each call
  template <class Visit>
  void visit_columns(std::size_t n, std::vector<std::uint64_t>& row, const Visit& visit) const {
    const auto u_row = u_at_n_.row(n), v_row = v_at_n_.row(n);
    row.resize(v_row.size());
    for_each_bit(u_row, [&](std::size_t u) {
      const auto v_at_u = v_at_u_.row(u);
      std::uint64_t any = 0;
      for (std::size_t i = 0; i < v_row.size(); ++i) any |= row[i] = v_row[i] & v_at_u[i];
      if (any) visit(static_cast<std::int64_t>(u));
    });
  }
  PlaneTally count(std::size_t n) const;

 private:
  /// The cells along one coordinate; the list of their centres is padded to a multiple of kLanes.
  struct Axis {
    std::vector<double> center;
    double lower = 0, step = 0;
    std::size_t cells = 0;
  };
  static void fill_axis(Axis& axis, const VoxelGrid& grid, std::size_t which);

  /// Fills a table: for each cell of coordinate a, the row of feasible cells of coordinate b, from the ranges of both
  /// coordinates and from the annuli in their plane.
  /// @return false if the table is empty
  bool fill_table(const Design<double>& d, const PositionSet<double>& set, std::size_t a, const Axis& across,
                  std::size_t b, const Axis& along, BitTable& table);

  Axis n_, u_, v_;
  BitTable u_at_n_, v_at_n_, v_at_u_;
};

}  // namespace pkm::crr_cru
