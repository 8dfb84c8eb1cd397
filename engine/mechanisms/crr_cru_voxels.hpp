// (3CRR/R)&CRU and Quadrupteron: voxel surveys from rows of bits. Same cells as the plain loop over poses.
//
// A limb's ring couples two coordinates only. So of a plane of cells (outer coordinate fixed) what the rings and
// slides leave of u, of v, and of v over each u are three kinds of bit rows, and a column's feasible cells are the
// bits that two rows share. Rows come from the ends of chords (crr_cru_rings.hpp); the plain test of a cell decides the
// cells next to an end, so that rounding cannot tell the two ways apart.
#pragma once

#include <bit>
#include <cstdint>
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

/// Counts cells. Holds storage; use one per thread.
class VoxelRows {
 public:
  /// Calls visit(outer, u, row) for every outer cell and u cell that has feasible cells, with `words()` words of bits.
  template <class Visit>
  void visit_columns(const Design<double>& d, const Held& held, const VoxelGrid& grid, const Visit& visit) {
    const GridAxes axes = grid_axes(held);
    const Cuts c = cuts(held);
    const double held_at = held_value(d.g, held);
    prepare(grid, axes);
    Frame<double> f;
    if (!c.outer_is_phi) {
      f = frame(d, held_at);
      if (f.singular) return;
      fill_coupled(d, f, c);
    }
    for (std::int64_t k = 0; k < grid.cells[axes.outer]; ++k) {
      const double outer = grid.centre(axes.outer, k);
      if (c.outer_is_phi) {
        f = frame(d, outer);
        if (f.singular) continue;
      }
      if (!fill_plane(d, f, c, c.outer_is_phi ? held_at : outer)) continue;
      if (c.outer_is_phi) fill_coupled(d, f, c);
      for (std::size_t i = 0; i < u_.center.size(); ++i) {
        if (!(plane_u_[i / 64] >> (i % 64) & 1)) continue;
        std::uint64_t any = 0;
        for (std::size_t w = 0; w < words_; ++w) any |= row_[w] = plane_v_[w] & coupled_[i * words_ + w];
        if (any) visit(k, static_cast<std::int64_t>(i), row_);
      }
    }
  }
  std::size_t words() const { return words_; }

 private:
  using Bits = std::vector<std::uint64_t>;
  struct Axis {
    std::vector<double> center;
    double lower, step;
  };

  void prepare(const VoxelGrid& grid, const GridAxes& axes);
  /// What slides and rings that do not couple u and v leave of them on the plane at `at`; false: nothing.
  bool fill_plane(const Design<double>& d, const Frame<double>& f, const Cuts& c, double at);
  /// What the rings that couple u and v leave of v over each u.
  void fill_coupled(const Design<double>& d, const Frame<double>& f, const Cuts& c);
  static RingLines lines_along(const Axis& axis);
  static void cut(const RingCells& cells, std::size_t line, std::size_t size, std::uint64_t* bits);

  Axis u_, v_;
  std::size_t words_ = 0;
  Bits plane_u_, plane_v_, coupled_, row_;
};

}  // namespace pkm::crr_cru
