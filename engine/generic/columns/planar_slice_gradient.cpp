// Gradient of the area of a planar slice: integrals along the arcs of its surfaces, and contributions of vertical
// sides.
#include <cmath>

#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/vertices.hpp"

namespace pkm::generic {

void PlanarSlice::add_gradient(double factor, std::span<double> registers, std::span<double> adjoints,
                               PlanarSliceScratch& scratch) const {
  std::array<std::array<double, 6>, kMaxSurfaces> gradient{};
  Signs used = 0;
  const double measure = factor * scratch.v[1] * scratch.z[1];
  const auto add_arc = [&](EndLabel end, const PlanarSliceScratch::Piece& piece, double sign) {
    const std::size_t k = end >> 1U;
    used |= bit(k);
    add_gradient_of_area(scratch.conics[k], {static_cast<int>(end & 1U), piece.from, piece.to}, sign * measure,
                         gradient[k]);
  };
  // Adds the contribution of a vertical side of a piece to the gradient: per unit of displacement of the side in t, the
  // area changes by the total length of the columns there.
  const auto add_side = [&](const PlanarSliceScratch::Piece& piece, bool upper) {
    const double t = upper ? piece.to : piece.from, sign = upper ? 1 : -1;
    const std::uint32_t label = vertex_of(kMaxSurfaces, upper ? piece.to_vertex : piece.from_vertex, t, scratch);
    const auto [columns, first, second] = moments(piece, t, scratch);
    const std::size_t k = label & ~kKind;
    if ((label & kKind) == kSide) {
      adjoints[plan_.range[plan_.range.size() - 2][k]] += sign * factor * scratch.z[1] * columns;
    } else if ((label & kKind) == kVertical) {
      const Conic& P = scratch.conics[k];
      const double g = -sign * measure / (P.c[1] + 2 * t * P.c[3]);
      used |= bit(k);
      gradient[k][0] += g * columns;
      gradient[k][1] += g * columns * t;
      gradient[k][3] += g * columns * t * t;
      // The conic is a vertical line: the coefficients of its terms with s are 0 for this design, but may differ from 0
      // for neighbouring designs.
      gradient[k][2] += g * first;
      gradient[k][4] += g * first * t;
      gradient[k][5] += g * second;
    } else if ((label & kKind) == kIndependent) {
      std::vector<double>& own = scratch.other_adjoints;
      const double g = -sign * factor * scratch.z[1] * columns / slope_of_independent(k, t, registers, scratch, own);
      // The constraint has no root here, but is undefined or infinite beyond the vertical side, so that the side counts
      // as fixed.
      if (!std::isfinite(g)) return;
      for (std::size_t i = 0; i < own.size(); ++i) adjoints[i] += g * own[i];
    }
  };
  for (const auto& piece : scratch.pieces) {
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
      add_arc(scratch.spans[i].upper, piece, 1);
      add_arc(scratch.spans[i].lower, piece, -1);
    }
    add_side(piece, false);
    add_side(piece, true);
  }
  const auto [vm, vh] = scratch.v;
  const auto [zm, zh] = scratch.z;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if ((used & bit(k)) == 0) continue;
    const auto& d = gradient[k];
    const double of_v_z[6] = {d[0],
                              vm * d[0] + vh * d[1],
                              zm * d[0] + zh * d[2],
                              vm * vm * d[0] + 2 * vm * vh * d[1] + vh * vh * d[3],
                              vm * zm * d[0] + vh * zm * d[1] + vm * zh * d[2] + vh * zh * d[4],
                              zm * zm * d[0] + 2 * zm * zh * d[2] + zh * zh * d[5]};
    for (std::size_t i = 0; i < 6; ++i) adjoints[plan_.surfaces[k].coefficients[i]] += of_v_z[i];
  }
}

double PlanarSlice::slope_of_independent(std::size_t k, double t, std::span<double> registers,
                                         const PlanarSliceScratch& scratch, std::vector<double>& by) const {
  evaluate_stage_of_v(t, registers, scratch);
  return stage_derivative(plan_.program, stage_of_v(), plan_.independent.back()[k], registers, by);
}

}  // namespace pkm::generic
