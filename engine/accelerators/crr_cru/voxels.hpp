// (3CRR/R)&CRU and Quadrupteron: voxel surveys from rows of bits (README.md). Same cells as the plain loop over poses:
// rows come from the ends of chords (rings.hpp), and the plain test of a cell decides the cells next to an end.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/accelerators/crr_cru/frame.hpp"
#include "engine/accelerators/crr_cru/rings.hpp"
#include "engine/mechanism/survey.hpp"
#include "engine/workspace/cell_runs.hpp"

namespace pkm::crr_cru {

/// Order of a grid's axes: u and v as in Cuts, and the outer coordinate.
struct GridAxes {
  std::size_t outer, u, v;
};
inline GridAxes grid_axes(const Held& held) { return held.coordinate == 3 ? GridAxes{0, 1, 2} : GridAxes{2, 0, 1}; }

/// Holds every feasible pose: positions by the slides' ranges, phi by kappa_p >= 0. Order of axes as the sweep's.
Box default_box(const Design<double>& d, const Held& held);

/// Of every cell along one coordinate, the feasible cells along another: a row of bits in whole words. Behind the last
/// row, empty ones up to whole lanes.
struct BitTable {
  std::size_t words = 0;
  std::vector<std::uint64_t> bits;

  std::span<const std::uint64_t> row(std::size_t i) const { return {bits.data() + i * words, words}; }
};

/// The cells of every section at one phi. Filled, workers may share it.
class SectionCells {
 public:
  /// Fills the tables. @return  whether they leave anything
  bool fill(const Design<double>& d, const Held& held, const VoxelGrid& grid, double phi);

  /// Calls visit(u) for every column with feasible cells.
  /// @param n    the plane's number, 0 where the coordinate normal to it is held
  /// @param row  set to the column's words of bits
  template <class Visit>
  void visit_columns(std::size_t n, std::vector<std::uint64_t>& row, const Visit& visit) const {
    const auto of_u = u_at_n_.row(n), of_v = v_at_n_.row(n);
    row.resize(of_v.size());
    for_each_bit(of_u, [&](std::size_t u) {
      const auto at_u = v_at_u_.row(u);
      std::uint64_t any = 0;
      for (std::size_t i = 0; i < of_v.size(); ++i) any |= row[i] = of_v[i] & at_u[i];
      if (any) visit(static_cast<std::int64_t>(u));
    });
  }
  PlaneTally count(std::size_t n) const;

 private:
  /// A coordinate's cells, and storage beyond them up to whole lanes.
  struct Axis {
    std::vector<double> center;
    double lower = 0, step = 0;
    std::size_t cells = 0;
  };
  static void lay(Axis& axis, const VoxelGrid& grid, std::size_t which);

  /// What slides and the rings that couple the coordinates a and b leave of b at each a; false: nothing.
  bool fill(const Design<double>& d, const Frame<double>& f, std::size_t a, const Axis& across, std::size_t b,
            const Axis& along, BitTable& table);

  Axis n_, u_, v_;
  BitTable u_at_n_, v_at_n_, v_at_u_;
};

}  // namespace pkm::crr_cru
