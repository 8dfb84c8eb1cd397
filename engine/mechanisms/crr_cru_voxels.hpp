// (3CRR/R)&CRU and Quadrupteron: voxel surveys from rows of bits. Same cells as the plain loop over poses.
//
// At given phi a limb's ring and a slide's range couple two coordinates at most. So what is feasible of a section's
// plane n, its coordinates u and v are three tables of bits: of u at each n, of v at each n, and of v at each u; the
// feasible cells of a column along v are the bits that its two rows share. Rows come from the ends of chords
// (crr_cru_rings.hpp); the plain test of a cell decides the cells next to an end, so that rounding cannot tell the two
// ways apart.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/mechanisms/crr_cru_frame.hpp"
#include "engine/mechanisms/crr_cru_rings.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm::crr_cru {

/// Order of a grid's axes: u and v as in Cuts, and the outer coordinate.
struct GridAxes {
  std::size_t outer, u, v;
};
inline GridAxes grid_axes(const Held& held) { return held.coordinate == 3 ? GridAxes{0, 1, 2} : GridAxes{2, 0, 1}; }

/// Holds every feasible pose: positions by the slides' ranges, phi by kappa_p >= 0. Order of axes as the sweep's.
Box default_box(const Design<double>& d, const Held& held);

/// Of every cell along one coordinate, the feasible cells along another: a row of bits in whole words.
struct BitTable {
  std::size_t words = 0;
  std::vector<std::uint64_t> bits;

  std::span<const std::uint64_t> row(std::size_t i) const { return {bits.data() + i * words, words}; }
};

/// Counts cells. Holds storage; use one per thread.
class VoxelRows {
 public:
  /// Calls visit(outer, u, row) for every outer cell and u cell that has feasible cells, with the row's words of bits.
  template <class Visit>
  void visit_columns(const Design<double>& d, const Held& held, const VoxelGrid& grid, const Visit& visit) {
    visit_planes(d, held, grid, [&](std::int64_t outer, std::size_t n) {
      visit_plane(n, [&](std::size_t u) { visit(outer, static_cast<std::int64_t>(u), row_); });
    });
  }
  /// Calls visit(outer, tally) for outer cells, all those with feasible cells among them.
  template <class Visit>
  void count_planes(const Design<double>& d, const Held& held, const VoxelGrid& grid, const Visit& visit) {
    visit_planes(d, held, grid, [&](std::int64_t outer, std::size_t n) {
      const PlaneRows rows{u_at_n_.row(n).data(), v_at_n_.row(n).data(), v_at_u_.bits.data(), u_.cells, v_.cells,
                           v_at_u_.words};
      visit(outer, with_instruction_set([&]<InstructionSet set>() { return tally<set>(rows); }));
    });
  }

 private:
  /// A coordinate's cells, and storage beyond them up to whole lanes.
  struct Axis {
    std::vector<double> center;
    double lower, step;
    std::size_t cells;
  };

  void prepare(const Design<double>& d, const Held& held, const VoxelGrid& grid, const GridAxes& axes);
  /// All tables at one phi; any_ is false where they leave nothing.
  void fill_tables(const Design<double>& d, const Frame<double>& f, const Cuts& c);
  /// What slides and the rings that couple the coordinates a and b leave of b at each a; false: nothing.
  bool fill(const Design<double>& d, const Frame<double>& f, std::size_t a, const Axis& across, std::size_t b,
            const Axis& along, BitTable& table);

  /// Calls visit(outer, n) where the tables, filled, leave something; n: their row of the plane.
  template <class Visit>
  void visit_planes(const Design<double>& d, const Held& held, const VoxelGrid& grid, const Visit& visit) {
    const GridAxes axes = grid_axes(held);
    const Cuts c = cuts(held);
    prepare(d, held, grid, axes);
    if (!c.outer_is_phi) fill_tables(d, frame(d, held_value(d.g, held)), c);
    for (std::int64_t k = 0; k < grid.cells[axes.outer]; ++k) {
      if (c.outer_is_phi) fill_tables(d, frame(d, grid.centre(axes.outer, k)), c);
      if (any_) visit(k, c.outer_is_phi ? 0 : static_cast<std::size_t>(k));
    }
  }
  template <class Visit>
  void visit_plane(std::size_t n, const Visit& visit) {
    const auto of_u = u_at_n_.row(n), of_v = v_at_n_.row(n);
    for (std::size_t w = 0; w < of_u.size(); ++w)
      for (std::uint64_t bits = of_u[w]; bits != 0; bits &= bits - 1) {
        const std::size_t u = 64 * w + static_cast<std::size_t>(std::countr_zero(bits));
        const auto at_u = v_at_u_.row(u);
        std::uint64_t any = 0;
        for (std::size_t i = 0; i < of_v.size(); ++i) any |= row_[i] = of_v[i] & at_u[i];
        if (any) visit(u);
      }
  }

  Axis n_, u_, v_;
  BitTable u_at_n_, v_at_n_, v_at_u_;
  std::vector<std::uint64_t> row_, range_;
  RingCells cells_;
  bool any_ = false;
};

}  // namespace pkm::crr_cru
