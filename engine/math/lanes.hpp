// SIMD scalar type for kernels: a batch of eight numbers (lanes) on which all operations act element by element.
//
// W is the number of doubles in a vector register; it affects the speed, but no bit of the results. Only files compiled
// for the instruction set of W may use Lanes<W> (core/instruction_set.hpp). Lanes cannot branch individually:
// comparisons return a mask, and select() chooses between two values lane by lane.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/core/instruction_set.hpp"

namespace pkm {

inline constexpr int kLanes = 8;

/// Result of a comparison: in each lane, all bits are set (true) or clear (false).
template <int W>
struct LaneMask {
  typedef long long Register __attribute__((vector_size(8 * W)));
  Register part[kLanes / W];
};

/// Eight doubles in kLanes / W vector registers.
template <int W>
struct Lanes {
  typedef double Register __attribute__((vector_size(8 * W)));
  Register part[kLanes / W];

  [[gnu::always_inline]] Lanes() {}
  [[gnu::always_inline]] Lanes(double x) {  // not explicit, because formulas combine constants and lanes
    for (Register& p : part) p = Register{} + x;
  }
  // A register at a time, because GCC 12 copies more than that by way of the stack.
  [[gnu::always_inline]] static Lanes load(const double* from) {
    Lanes x;
    for (int i = 0; i < kLanes / W; ++i) std::memcpy(&x.part[i], from + i * W, sizeof x.part[i]);
    return x;
  }
  [[gnu::always_inline]] void store(double* to) const {
    for (int i = 0; i < kLanes / W; ++i) std::memcpy(to + i * W, &part[i], sizeof part[i]);
  }
};

/// The type Lanes for an instruction set.
template <InstructionSet set>
using LanesOf = Lanes<set == InstructionSet::avx512 ? 8
                      : set == InstructionSet::avx2 ? 4
                                                    : 2>;

#define PKM_EACH_REGISTER for (int i = 0; i < kLanes / W; ++i)
#define PKM_LANES  \
  template <int W> \
  [[gnu::always_inline]] inline
#define PKM_OPERATION(Result, operation)                                                                  \
  PKM_LANES Result<W> operator operation(const Lanes<W>& x, const Lanes<W>& y) {                          \
    Result<W> r;                                                                                          \
    PKM_EACH_REGISTER r.part[i] = x.part[i] operation y.part[i];                                          \
    return r;                                                                                             \
  }                                                                                                       \
  PKM_LANES Result<W> operator operation(const Lanes<W>& x, double y) { return x operation Lanes<W>(y); } \
  PKM_LANES Result<W> operator operation(double x, const Lanes<W>& y) { return Lanes<W>(x) operation y; }
PKM_OPERATION(Lanes, +)
PKM_OPERATION(Lanes, -)
PKM_OPERATION(Lanes, *)
PKM_OPERATION(Lanes, /)
PKM_OPERATION(LaneMask, <)
PKM_OPERATION(LaneMask, <=)
PKM_OPERATION(LaneMask, >)
PKM_OPERATION(LaneMask, >=)
#undef PKM_OPERATION

PKM_LANES Lanes<W> operator-(const Lanes<W>& x) {
  Lanes<W> r;
  PKM_EACH_REGISTER r.part[i] = -x.part[i];
  return r;
}
PKM_LANES Lanes<W>& operator+=(Lanes<W>& x, const Lanes<W>& y) { return x = x + y; }

PKM_LANES LaneMask<W> operator&(const LaneMask<W>& x, const LaneMask<W>& y) {
  LaneMask<W> r;
  PKM_EACH_REGISTER r.part[i] = x.part[i] & y.part[i];
  return r;
}

/// The lanes themselves, because they have no derivatives; for templates that also accept dual numbers.
PKM_LANES const Lanes<W>& value_of(const Lanes<W>& x) { return x; }

/// x in the lanes where the mask is set, y in the others.
PKM_LANES Lanes<W> select(const LaneMask<W>& mask, const Lanes<W>& x, const Lanes<W>& y) {
  Lanes<W> r;
  PKM_EACH_REGISTER r.part[i] = mask.part[i] ? x.part[i] : y.part[i];
  return r;
}
/// Minimum and maximum, lane by lane.
PKM_LANES Lanes<W> lesser(const Lanes<W>& x, const Lanes<W>& y) { return select(x < y, x, y); }
PKM_LANES Lanes<W> greater(const Lanes<W>& x, const Lanes<W>& y) { return select(x > y, x, y); }

PKM_LANES Lanes<W> sqrt(const Lanes<W>& x) {
  Lanes<W> r;
  PKM_EACH_REGISTER
  for (int k = 0; k < W; ++k) r.part[i][k] = std::sqrt(x.part[i][k]);
  return r;
}
PKM_LANES Lanes<W> sqrt_or_zero(const Lanes<W>& x) { return sqrt(greater(x, Lanes<W>(0.0))); }

/// Largest integers <= x, for |x| < 2^51.
PKM_LANES Lanes<W> floor(const Lanes<W>& x) {
  constexpr double kNoFraction = 0x1.8p52;  // doubles of this size are integers, so adding it rounds to an integer
  const Lanes<W> nearest = (x + kNoFraction) - kNoFraction;
  return select(nearest > x, nearest - 1.0, nearest);
}
PKM_LANES Lanes<W> ceil(const Lanes<W>& x) { return -floor(-x); }

/// Whether the mask is set in any lane.
PKM_LANES bool any(const LaneMask<W>& mask) {
  long long lane[kLanes], bits = 0;
  std::memcpy(lane, mask.part, sizeof lane);
  for (const long long each : lane) bits |= each;
  return bits != 0;
}

/// Minimum over the lanes.
PKM_LANES double reduce_min(const Lanes<W>& x) {
  double lane[kLanes], r = 0;
  x.store(lane);
  r = lane[0];
  for (int k = 1; k < kLanes; ++k) r = lane[k] < r ? lane[k] : r;
  return r;
}
/// Maximum over the lanes.
PKM_LANES double reduce_max(const Lanes<W>& x) { return -reduce_min(-x); }

#undef PKM_EACH_REGISTER
#undef PKM_LANES

}  // namespace pkm
