// Random numbers as a function of where they are used, not of who asked first.
//
// A stream is keyed by (seed, generation, individual, use), so every individual of every generation draws the same
// numbers whatever the number of threads, and a resumed run draws them again without any stored state. The generator
// is Philox4x32-10 of Random123: the key is the seed, the counter is (block, use, individual, generation). Nothing
// here depends on libm or on the standard library's distributions, whose results differ between machines.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace pkm {

/// Four 32-bit words of Philox4x32-10, for its known-answer test.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

class Stream {
 public:
  /// What a stream's numbers are for: two uses never share numbers.
  enum class Use : std::uint32_t { start, selection, variation, retry };

  Stream(std::uint64_t seed, std::uint32_t generation, std::uint32_t individual, Use use)
      : seed_(seed), generation_(generation), individual_(individual), use_(use) {}

  /// 32 random bits. A stream holds 2^34 of these words.
  std::uint32_t bits() {
    if (next_ == words_.size()) refill();
    return words_[next_++];
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double u01() {
    const std::uint64_t high = bits();
    return static_cast<double>((high << 32 | bits()) >> 11) * 0x1p-53;
  }

  /// Uniform in {0, ..., n - 1}, n < 2^32 (0 for n = 0); uneven by less than n 2^-32.
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(std::uint64_t{bits()} * n >> 32); }

  /// True with probability p, in steps of 2^-32.
  bool chance(double p) { return static_cast<double>(bits()) * 0x1p-32 < p; }

  /// Standard normal deviate (Box and Muller, on portable functions).
  double normal();

 private:
  void refill();

  std::uint64_t seed_;
  std::uint32_t generation_, individual_;
  Use use_;
  std::uint32_t block_ = 0;
  std::array<std::uint32_t, 12> words_;  // three Philox blocks: a child of four variables takes some 20 words
  std::size_t next_ = 12;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace pkm
