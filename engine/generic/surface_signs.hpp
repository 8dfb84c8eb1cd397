// Feasibility of a point of a slice as a function of the signs of the constraint surfaces there: one bit each, set if
// the surface is >= 0.
#pragma once

#include <cstdint>
#include <vector>

namespace pkm::generic {

using Signs = std::uint64_t;
inline constexpr std::size_t kMaxSurfaces = 64;

/// limbs::CrankRange in terms of the bits of surfaces.
struct CrankSigns {
  Signs at_min, at_max, after_min, before_max, reach;
  std::uint32_t half_turn;  ///< register
  bool is_first;            ///< the joint is the first of the two angles that assemble
};

struct Formula {
  Signs all = 0;           ///< all of these bits have to be set
  std::vector<Signs> any;  ///< at least one bit of each of these has to be set
  std::vector<CrankSigns> cranks;

  /// @param registers  registers of the program
  bool holds(Signs signs, const double* registers) const {
    if ((signs & all) != all) return false;
    for (const Signs one_of : any)
      if ((signs & one_of) == 0) return false;
    for (const CrankSigns& crank : cranks)
      if (!holds(crank, signs, registers)) return false;
    return true;
  }

 private:
  static bool holds(const CrankSigns& crank, Signs signs, const double* registers) {
    const auto is = [&](Signs bits) { return (signs & bits) == bits; };
    const bool f1 = is(crank.at_min), f2 = is(crank.at_max), p1 = is(crank.after_min), p2 = is(crank.before_max);
    if (f1 != f2) return crank.is_first ? f1 : f2;
    if (!is(crank.reach)) return false;
    const bool half = registers[crank.half_turn] >= 0;
    return f1 ? (half ? p1 && p2 : p1 || p2) : (half ? !p1 && !p2 : !p1 || !p2);
  }
};

}  // namespace pkm::generic
