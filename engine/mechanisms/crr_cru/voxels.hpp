// (3CRR/R)&CRU and Quadrupteron: voxel surveys from rows of bits. Same cells as the plain loop over poses.
//
// At given phi a limb's ring and a slide's range couple two coordinates at most. So what is feasible of a section's
// plane n, its coordinates u and v are three tables of bits: of u at each n, of v at each n, and of v at each u; the
// feasible cells of a column along v are the bits that its two rows share. Rows come from the ends of chords
// (rings.hpp); the plain test of a cell decides the cells next to an end, so that rounding cannot tell the two
// ways apart.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/mechanism/survey.hpp"
#include "engine/mechanisms/crr_cru/frame.hpp"
#include "engine/mechanisms/crr_cru/rings.hpp"
#include "engine/survey/share_samples.hpp"
#include "engine/survey/voxel_grid.hpp"

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

/// The cells of every section at one phi. Filled, threads may share it.
class SectionCells {
 public:
  /// Fills the tables. @return  whether they leave anything
  bool fill(const Design<double>& d, const Held& held, const VoxelGrid& grid, double phi);

  /// Calls visit(u, row) for every column with feasible cells, with the row's words of bits.
  /// @param n    the plane's number, 0 where the coordinate normal to it is held
  /// @param row  storage
  template <class Visit>
  void visit_columns(std::size_t n, std::vector<std::uint64_t>& row, const Visit& visit) const {
    const auto of_u = u_at_n_.row(n), of_v = v_at_n_.row(n);
    row.resize(of_v.size());
    for (std::size_t w = 0; w < of_u.size(); ++w)
      for (std::uint64_t bits = of_u[w]; bits != 0; bits &= bits - 1) {
        const std::size_t u = 64 * w + static_cast<std::size_t>(std::countr_zero(bits));
        const auto at_u = v_at_u_.row(u);
        std::uint64_t any = 0;
        for (std::size_t i = 0; i < of_v.size(); ++i) any |= row[i] = of_v[i] & at_u[i];
        if (any) visit(static_cast<std::int64_t>(u), row);
      }
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

/// Calls visit(k, cells, n, survey) for every outer cell k whose section may have cells, among the team lent to this
/// thread if there is one, as share_samples() does; n: the plane of `cells`.
template <class Visit>
void share_sections(const Design<double>& d, const Held& held, const VoxelGrid& grid, Survey<double>& survey,
                    const Visit& visit) {
  // By a function, because a variable of this one would begin to exist on the calling thread only.
  const auto own = []() -> SectionCells& {
    thread_local SectionCells cells;
    return cells;
  };
  SectionCells& common = own();
  const std::size_t outer = grid_axes(held).outer;
  const bool over_phi = cuts(held).outer_is_phi;
  if (!over_phi && !common.fill(d, held, grid, held_value(d.g, held))) return;
  share_samples(static_cast<std::size_t>(grid.cells[outer]), survey,
                [&](std::size_t piece, Survey<double>& part, std::size_t) {
                  const auto k = static_cast<std::int64_t>(piece);
                  if (!over_phi)
                    visit(k, common, piece, part);
                  else if (SectionCells& cells = own(); cells.fill(d, held, grid, grid.centre(outer, k)))
                    visit(k, cells, std::size_t{0}, part);
                });
}

}  // namespace pkm::crr_cru
