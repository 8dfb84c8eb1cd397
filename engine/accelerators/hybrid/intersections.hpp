// Hybrid robot: the heights where two edges of a section meet.
#pragma once

#include <limits>

#include "engine/accelerators/hybrid/strips.hpp"

namespace pkm::hybrid {

inline constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

/// Both belong to the chain, on one side: they differ as Q, P, lw_max cos(phi_max), lw_min cos(phi_max) do, which are
/// linear in z.
inline bool of_chain(const Edge& first, const Edge& second) {
  return first.curve >= kCurveQ && second.curve >= kCurveQ && first.side == second.side;
}

/// Where two edges that have changed places between p and q meet: in closed form, or by Newton's method, kept between
/// them by bisection. The chain's meet at the same height on either side, to the last bit.
double meeting(const Section<double>& s, const Edge& first, const Edge& second, double p, double q);

/// Where two edges meet near z; kNowhere: not that near.
double meeting_near(const Section<double>& s, const Edge& first, const Edge& second, double z);

}  // namespace pkm::hybrid
