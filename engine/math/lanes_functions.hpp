// Elementary functions for SIMD lanes, bit-identical to those of scalar.hpp for double.
#pragma once

#include "engine/math/lanes.hpp"

namespace pkm {

template <int W>
[[gnu::always_inline]] inline Lanes<W> magnitude(const Lanes<W>& x) {
  return select(x < 0.0, -x, x);
}

/// 2^k for integers k in [-1022, 1023].
template <int W>
[[gnu::always_inline]] inline Lanes<W> power_of_two(const Lanes<W>& k) {
  // Adding this constant puts k + 1023, the biased exponent of 2^k, into the last bits of the sum. Shifting the bit
  // pattern to the left by 52 moves it into the exponent field and discards the rest.
  const Lanes<W> shifted = k + (0x1.8p52 + 1023);
  Lanes<W> r;
  for (int i = 0; i < kLanes / W; ++i) {
    typename LaneMask<W>::Register bits;
    __builtin_memcpy(&bits, &shifted.part[i], sizeof bits);
    bits <<= 52;
    __builtin_memcpy(&r.part[i], &bits, sizeof bits);
  }
  return r;
}

/// e^x in each lane, bit-identical to portable::exp().
template <int W>
[[gnu::always_inline]] inline Lanes<W> exp(const Lanes<W>& argument) {
  using L = Lanes<W>;
  constexpr double kMin = -745.2, kMax = 709.782712893384, kNoFraction = 0x1.8p52;
  constexpr double ln2_high = 0x1.62e42fee00000p-1, ln2_low = 0x1.a39ef35793c76p-33;
  // a NaN becomes one of the two bounds here; it is restored below
  const L x = lesser(greater(argument, L(kMin)), L(kMax));
  const L k = (x * 1.44269504088896340736 + kNoFraction) - kNoFraction;
  const L r = (x - k * ln2_high) - k * ln2_low;
  L sum = 1.0 / 6227020800.0;
  for (const double inverse : {1.0 / 479001600.0, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                               1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5})
    sum = inverse + r * sum;
  // Scale by 2^k in two factors, because 2^k alone may overflow; only the second multiplication may round.
  const L half = floor(k * 0.5);
  const L y = (1.0 + (r + r * r * sum)) * power_of_two(half) * power_of_two(k - half);
  const L low = select(argument > kMin, y, L(0.0));
  const L high = select(argument > kMax, L(__builtin_inf()), low);
  return select(argument >= argument, high, argument);
}

}  // namespace pkm
