// How a section's area changes with its surfaces: by their arcs, and by upright sides that move.
#include <cmath>

#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/corners.hpp"

namespace pkm::generic {

void Section::add_slopes(double factor, std::span<double> registers, std::span<double> adjoints,
                         SectionRoom& room) const {
  std::array<std::array<double, 6>, kMostSurfaces> slopes{};
  Signs used = 0;
  const double measure = factor * room.v[1] * room.z[1];
  const auto add_arc = [&](EndLabel end, const SectionRoom::Piece& piece, double sign) {
    const std::size_t k = end >> 1U;
    used |= bit(k);
    add_slopes_of_area(room.conics[k], {static_cast<int>(end & 1U), piece.from, piece.to}, sign * measure, slopes[k]);
  };
  // A side moves by dt and takes columns of this length along.
  const auto add_side = [&](const SectionRoom::Piece& piece, bool upper) {
    const double t = upper ? piece.to : piece.from, sign = upper ? 1 : -1;
    const std::uint32_t label = corner_of(kMostSurfaces, upper ? piece.to_corner : piece.from_corner, t, room);
    const auto [columns, first, second] = moments(piece, t, room);
    const std::size_t k = label & ~kKind;
    if ((label & kKind) == kSide) {
      adjoints[plan_.range[plan_.range.size() - 2][k]] += sign * factor * room.z[1] * columns;
    } else if ((label & kKind) == kUpright) {
      const Conic& P = room.conics[k];
      const double g = -sign * measure / (P.c[1] + 2 * t * P.c[3]);
      used |= bit(k);
      slopes[k][0] += g * columns;
      slopes[k][1] += g * columns * t;
      slopes[k][3] += g * columns * t * t;
      // its coefficients with s are 0 at this design, but may change with it
      slopes[k][2] += g * first;
      slopes[k][4] += g * first * t;
      slopes[k][5] += g * second;
    } else if ((label & kKind) == kPlain) {
      std::vector<double>& own = room.other_adjoints;
      const double g = -sign * factor * room.z[1] * columns / slope_of_plain(k, t, registers, room, own);
      if (!std::isfinite(g)) return;  // it is undefined or infinite beyond, and has no root there
      for (std::size_t i = 0; i < own.size(); ++i) adjoints[i] += g * own[i];
    }
  };
  for (const auto& piece : room.pieces) {
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
      add_arc(room.spans[i].upper, piece, 1);
      add_arc(room.spans[i].lower, piece, -1);
    }
    add_side(piece, false);
    add_side(piece, true);
  }
  const auto [vm, vh] = room.v;
  const auto [zm, zh] = room.z;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if ((used & bit(k)) == 0) continue;
    const auto& d = slopes[k];
    const double of_v_z[6] = {d[0],
                              vm * d[0] + vh * d[1],
                              zm * d[0] + zh * d[2],
                              vm * vm * d[0] + 2 * vm * vh * d[1] + vh * vh * d[3],
                              vm * zm * d[0] + vh * zm * d[1] + vm * zh * d[2] + vh * zh * d[4],
                              zm * zm * d[0] + 2 * zm * zh * d[2] + zh * zh * d[5]};
    for (std::size_t i = 0; i < 6; ++i) adjoints[plan_.surfaces[k].coefficients[i]] += of_v_z[i];
  }
}

double Section::slope_of_plain(std::size_t k, double t, std::span<double> registers, const SectionRoom& room,
                               std::vector<double>& by) const {
  set_v(t, registers, room);
  return stage_derivative(plan_.program, stage_of_v(), plan_.plain.back()[k], registers, by);
}

}  // namespace pkm::generic
