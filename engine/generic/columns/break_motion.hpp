// How a break moves with the design at which a section's corners change.
//
// A few of what bounds the section meet there, and their gradients in the section are linearly dependent: two that
// touch, three through one point, a conic that is one point. With factors f of sum f grad P = 0, all P = 0 gives
//
//   dx/dp = - sum f P_p / sum f P_x.
#pragma once

#include <optional>
#include <vector>

#include "engine/generic/columns/section_motion.hpp"

namespace pkm::generic {

/// Where an arc ends.
struct ArcEnd {
  std::uint32_t label;  ///< of the corner
  std::uint32_t surface;
  double v, z;
};

/// Of a section, after measure().
std::vector<ArcEnd> arc_ends(const Section& section, const SectionRoom& room);

/// A break with its derivatives; nothing where it cannot be told what meets there.
/// @param inside, outside  ends of arcs just beside it
/// @param room             of the section inside
/// @param by_design, by_x  motions there while the outer coordinate stays, and by it alone
std::optional<Dual4> moving_break(double at, std::vector<ArcEnd> inside, std::vector<ArcEnd> outside,
                                  const SectionRoom& room, const SectionMotion& by_design, const SectionMotion& by_x);

}  // namespace pkm::generic
