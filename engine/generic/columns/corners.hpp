// Labels of a section's corners.
#pragma once

#include "engine/generic/columns/section.hpp"

namespace pkm::generic {

// Kinds of corners, in the order in which one stands for all at its place.
inline constexpr std::uint32_t kSide = 1U << 28, kPlain = 2U << 28, kUpright = 3U << 28, kCrossing = 4U << 28,
                               kExtreme = 5U << 28, kKind = 15U << 28;

/// By t and s.
inline std::array<double, 2> gradient(const Conic& P, double t, double s) {
  return {P.c[1] + 2 * t * P.c[3] + s * P.c[4], P.c[2] + t * P.c[4] + 2 * s * P.c[5]};
}

/// Of the corners at a place, the one that ends arcs of a surface; a condition along v ends all of them.
std::uint32_t corner_of(std::size_t surface, std::size_t first, double t, const SectionRoom& room);

}  // namespace pkm::generic
