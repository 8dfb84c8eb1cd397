// Feasibility of a point of a slice by the signs of the boundary curves there: the formula of the constraint
// surfaces (surface_signs.hpp), of which some have a constant sign and others are products of two lines.
#pragma once

#include "engine/generic/surface_signs.hpp"

namespace pkm::generic::corner_curves {

inline constexpr std::size_t kMaxCurves = 64;

inline Signs bit(std::size_t i) { return Signs{1} << i; }

struct SliceFormula {
  /// For one boundary curve with the equation h = 0: the surfaces that are >= 0 on one side of it, as sets.
  struct Literals {
    /// Sets of the surfaces that are >= 0 where the function h of the curve is > 0, and where it is < 0.
    Signs outside = 0, inside = 0;
  };
  /// A surface whose sign depends on two parallel lines. Between them, h > 0 for the first line and h < 0 for the
  /// second one. is_inside: the surface is >= 0 between the lines; otherwise it is >= 0 everywhere else.
  struct Strip {
    std::size_t first, second;  ///< indices of the two lines
    /// Set that contains only the surface. 0: a condition without a surface; where it is violated, no point is
    /// feasible.
    Signs surface;
    bool is_inside;
  };

  /// A curve on one side of which no point is feasible, independently of the formula.
  struct Bound {
    std::size_t curve;
    bool outside;  ///< true: the function h of the curve is > 0 at feasible points; false: it is < 0
  };

  Formula formula;
  const double* registers = nullptr;  ///< values of the program's registers
  Signs constant = 0;                 ///< set of the surfaces that are >= 0 in the whole slice
  std::vector<Literals> literals;     ///< for each boundary curve, the surfaces that change their sign at it
  std::vector<Strip> strips;
  std::vector<Bound> bounds;

  /// @param outside  set of the curves with h > 0 at the point
  bool holds(Signs outside) const {
    for (const Bound& bound : bounds)
      if (((outside & bit(bound.curve)) != 0) != bound.outside) return false;
    Signs surfaces = constant;
    for (std::size_t i = 0; i < literals.size(); ++i)
      surfaces |= (outside >> i & 1U) != 0 ? literals[i].outside : literals[i].inside;
    for (const Strip& strip : strips) {
      const bool between = (outside & bit(strip.first)) != 0 && (outside & bit(strip.second)) == 0;
      if (between == strip.is_inside)
        surfaces |= strip.surface;
      else if (strip.surface == 0)
        return false;
    }
    return formula.holds(surfaces, registers);
  }
};

}  // namespace pkm::generic::corner_curves
