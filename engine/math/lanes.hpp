// Eight numbers side by side, for kernels: a scalar whose every operation acts on each of them.
//
// W is how many of them the processor takes at once; it changes the speed, never a bit. Only files that are compiled
// for the instruction set of W may use Lanes<W> (core/instruction_set.hpp). There are no branches on lanes: comparisons
// give a mask, select() takes from the first where it is set.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/core/instruction_set.hpp"

namespace pkm {

inline constexpr int kLanes = 8;

template <int W>
struct LaneMask {
  typedef long long Part __attribute__((vector_size(8 * W)));
  Part part[kLanes / W];
};

template <int W>
struct Lanes {
  typedef double Part __attribute__((vector_size(8 * W)));
  Part part[kLanes / W];

  [[gnu::always_inline]] Lanes() {}
  [[gnu::always_inline]] Lanes(double x) {  // not explicit: constants mix with lanes in formulas
    for (Part& p : part) p = Part{} + x;
  }
  [[gnu::always_inline]] static Lanes load(const double* from) {
    Lanes x;
    std::memcpy(x.part, from, sizeof x.part);
    return x;
  }
  [[gnu::always_inline]] void store(double* to) const { std::memcpy(to, part, sizeof part); }
};

/// The lanes of an instruction set.
template <InstructionSet set>
using LanesOf = Lanes<set == InstructionSet::avx512 ? 8
                      : set == InstructionSet::avx2 ? 4
                                                    : 2>;

#define PKM_EACH_PART for (int i = 0; i < kLanes / W; ++i)
#define PKM_LANES  \
  template <int W> \
  [[gnu::always_inline]] inline
#define PKM_OPERATION(Result, symbol)                                                               \
  PKM_LANES Result<W> operator symbol(const Lanes<W>& x, const Lanes<W>& y) {                       \
    Result<W> r;                                                                                    \
    PKM_EACH_PART r.part[i] = x.part[i] symbol y.part[i];                                           \
    return r;                                                                                       \
  }                                                                                                 \
  PKM_LANES Result<W> operator symbol(const Lanes<W>& x, double y) { return x symbol Lanes<W>(y); } \
  PKM_LANES Result<W> operator symbol(double x, const Lanes<W>& y) { return Lanes<W>(x) symbol y; }
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
  PKM_EACH_PART r.part[i] = -x.part[i];
  return r;
}
PKM_LANES Lanes<W>& operator+=(Lanes<W>& x, const Lanes<W>& y) { return x = x + y; }

PKM_LANES LaneMask<W> operator&(const LaneMask<W>& x, const LaneMask<W>& y) {
  LaneMask<W> r;
  PKM_EACH_PART r.part[i] = x.part[i] & y.part[i];
  return r;
}

/// Lanes have no derivatives.
PKM_LANES const Lanes<W>& value_of(const Lanes<W>& x) { return x; }

/// x where the mask is set, y elsewhere.
PKM_LANES Lanes<W> select(const LaneMask<W>& mask, const Lanes<W>& x, const Lanes<W>& y) {
  Lanes<W> r;
  PKM_EACH_PART r.part[i] = mask.part[i] ? x.part[i] : y.part[i];
  return r;
}
PKM_LANES Lanes<W> lesser(const Lanes<W>& x, const Lanes<W>& y) { return select(x < y, x, y); }
PKM_LANES Lanes<W> greater(const Lanes<W>& x, const Lanes<W>& y) { return select(x > y, x, y); }

PKM_LANES Lanes<W> sqrt(const Lanes<W>& x) {
  Lanes<W> r;
  PKM_EACH_PART
  for (int k = 0; k < W; ++k) r.part[i][k] = std::sqrt(x.part[i][k]);
  return r;
}
PKM_LANES Lanes<W> root_or_zero(const Lanes<W>& x) { return sqrt(greater(x, Lanes<W>(0.0))); }

/// The nearest whole numbers below, for |x| < 2^51.
PKM_LANES Lanes<W> floor(const Lanes<W>& x) {
  constexpr double kNoFraction = 0x1.8p52;  // to numbers of this size no fraction can be added: the sum is rounded
  const Lanes<W> nearest = (x + kNoFraction) - kNoFraction;
  return select(nearest > x, nearest - 1.0, nearest);
}
PKM_LANES Lanes<W> ceil(const Lanes<W>& x) { return -floor(-x); }

PKM_LANES bool any(const LaneMask<W>& mask) {
  long long lane[kLanes], bits = 0;
  std::memcpy(lane, mask.part, sizeof lane);
  for (const long long each : lane) bits |= each;
  return bits != 0;
}

/// All lanes, from the first.
PKM_LANES double least(const Lanes<W>& x) {
  double lane[kLanes], r = 0;
  x.store(lane);
  r = lane[0];
  for (int k = 1; k < kLanes; ++k) r = lane[k] < r ? lane[k] : r;
  return r;
}
PKM_LANES double greatest(const Lanes<W>& x) { return -least(-x); }

#undef PKM_EACH_PART
#undef PKM_LANES

}  // namespace pkm
