#include "engine/math/hash.hpp"

#include <gtest/gtest.h>

#include <set>

namespace pkm {
namespace {

std::uint64_t pair(std::uint64_t first, std::uint64_t second) {
  Fnv1a hash;
  hash.add(first);
  hash.add(second);
  return hash.value();
}

/// The sum of the hashes of (1, a) and (2, b) differs from that of (1, b) and (2, a).
TEST(Hash, SumsOfHashesOfPairsDiffer) {
  std::set<std::uint64_t> sums;
  constexpr std::uint64_t kLabels = 40, kHigh = std::uint64_t{4} << 28U;
  for (std::uint64_t a = 0; a < kLabels; ++a)
    for (std::uint64_t b = 0; b < kLabels; ++b) sums.insert(pair(1, kHigh | a) + pair(2, kHigh | b));
  EXPECT_EQ(sums.size(), kLabels * kLabels);
}

}  // namespace
}  // namespace pkm
