// Counter-based random number generator Philox4x32-10 (Salmon, Moraes, Dror and Shaw 2011), implemented by the library
// Random123.
//
// A stream is identified by (seed, generation, individual, use): the key of the generator is the seed, its counter is
// (block, use, individual, generation). Therefore every individual of every generation draws the same numbers for any
// number of threads, and a resumed run reproduces them without stored state. No result depends on libm or on the
// distributions of the standard library, which differ between machines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pkm {

/// One block of Philox4x32-10: four 32-bit words. Declared here so that it can be tested with published values.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// A reproducible stream of random numbers.
class Stream {
 public:
  /// Purpose of the numbers; streams of different purposes are independent.
  enum class Use : std::uint32_t { start, selection, variation, retry, tolerance };

  Stream(std::uint64_t seed, std::uint32_t generation, std::uint32_t individual, Use use)
      : seed_(seed), generation_(generation), individual_(individual), use_(use) {}

  /// 32 random bits. The period of a stream is 2^34 words.
  std::uint32_t bits() {
    if (next_ == words_.size()) refill();
    return words_[next_++];
  }

  /// Uniformly distributed in [0, 1), a multiple of 2^-53.
  double u01() {
    const std::uint64_t high = bits();
    return static_cast<double>((high << 32 | bits()) >> 11) * 0x1p-53;
  }

  /// Uniformly distributed in {0, ..., n - 1}, n < 2^32 (0 for n = 0); the relative bias is less than n 2^-32.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(std::uint64_t{bits()} * n >> 32); }

  /// true with probability p, which is rounded to a multiple of 2^-32.
  bool chance(double p) { return static_cast<double>(bits()) * 0x1p-32 < p; }

  /// Standard normal deviate, by the Box-Muller transform with the functions of portable.hpp.
  double normal();

 private:
  void refill();

  std::uint64_t seed_;
  std::uint32_t generation_, individual_;
  Use use_;
  std::uint32_t block_ = 0;
  std::array<std::uint32_t, 12> words_;  // three Philox blocks; an offspring with four variables needs about 20 words
  std::size_t next_ = 12;
  double second_normal_ = 0;
  bool has_second_normal_ = false;
};

}  // namespace pkm
