// Labels of the vertices of a planar slice.
#pragma once

#include "engine/generic/columns/planar_slice.hpp"

namespace pkm::generic {

// What a vertex is, in the upper four bits of its label. If several vertices coincide, the one that comes first in this
// order represents the others.
inline constexpr std::uint32_t kSide = 1U << 28, kIndependent = 2U << 28, kVertical = 3U << 28, kCrossing = 4U << 28,
                               kTurningPoint = 5U << 28, kKind = 15U << 28;

/// Gradient of the polynomial P of a conic with respect to t and s, at a point (t, s).
inline std::array<double, 2> gradient(const Conic& P, double t, double s) {
  return {P.c[1] + 2 * t * P.c[3] + s * P.c[4], P.c[2] + t * P.c[4] + 2 * s * P.c[5]};
}

/// Of the vertices with the same t, selects the one at which arcs of a surface end, and returns its label. Vertices of
/// independent constraints end the arcs of all surfaces.
/// @param first  index of the first vertex with this t
std::uint32_t vertex_of(std::size_t surface, std::size_t first, double t, const PlanarSliceScratch& scratch);

}  // namespace pkm::generic
