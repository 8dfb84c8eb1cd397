// Feasibility of a point of a slice as a function of the signs of the constraint surfaces there: one bit each, set if
// the surface is >= 0.
#pragma once

#include <cstdint>
#include <vector>

namespace pkm::generic {

using Signs = std::uint64_t;
inline constexpr std::size_t kMaxSurfaces = 64;

/// The range of a crank (limbs::CrankRange) in terms of the signs of surfaces: each member of type Signs is a set of
/// surfaces, and the term of the same name is >= 0 if all surfaces of the set are.
struct CrankSigns {
  Signs at_min, at_max, after_min, before_max, reach;
  std::uint32_t half_turn;  ///< register of CrankRange::half_turn
  /// true: the smaller of the two crank angles that assemble is the joint coordinate; false: the greater one.
  bool is_first;
};

struct Formula {
  Signs all = 0;           ///< set of the surfaces that all have to be >= 0
  std::vector<Signs> any;  ///< from each of these sets, at least one surface has to be >= 0
  std::vector<CrankSigns> cranks;

  /// @param registers  values of the registers of the program
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
