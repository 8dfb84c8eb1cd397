// Feasibility of a point of a slice by the signs of the boundary curves there: the formula of the constraint
// surfaces (surface_signs.hpp), of which some have a constant sign and others are products of two lines.
#pragma once

#include "engine/generic/surface_signs.hpp"

namespace pkm::generic::corner_curves {

inline constexpr std::size_t kMaxCurves = 64;

inline Signs bit(std::size_t i) { return Signs{1} << i; }

struct SliceFormula {
  /// Sets of the surfaces that are >= 0 on one side of a curve h = 0.
  struct Literals {
    Signs outside = 0, inside = 0;  ///< surfaces that are >= 0 where h > 0, and where h < 0
  };
  /// A surface that is >= 0 between two parallel lines (is_inside), i.e. where h > 0 on the first and h < 0 on the
  /// second one, or that is >= 0 everywhere else.
  struct Strip {
    std::size_t first, second;  ///< indices of the curves
    /// Set with the bit of the surface; 0: no point is feasible where the strip's condition is violated.
    Signs surface;
    bool is_inside;
  };

  /// A curve on one side of which no point is feasible, in addition to the formula.
  struct Bound {
    std::size_t curve;
    bool outside;  ///< true: feasible points have h > 0; false: they have h < 0
  };

  Formula formula;
  const double* registers = nullptr;  ///< registers of the program
  Signs constant = 0;                 ///< set of the surfaces that are >= 0 in the whole slice
  std::vector<Literals> literals;     ///< one element per curve
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
