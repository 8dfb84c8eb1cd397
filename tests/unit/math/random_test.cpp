#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/math/random.hpp"

namespace pkm {
namespace {

TEST(Random, PhiloxKnownAnswers) {  // from Random123's known-answer file
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}), (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, StreamIsPhiloxWithItsKeyAndCounter) {
  Stream stream(0x0000000700000005, 11, 13, Stream::Use::variation);
  for (std::uint32_t block = 0; block < 6; ++block) {
    const auto words = philox({block, static_cast<std::uint32_t>(Stream::Use::variation), 13, 11}, {5, 7});
    for (const std::uint32_t word : words) EXPECT_EQ(stream.bits(), word);
  }
}

TEST(Random, StreamsOfDifferentKeysDiffer) {
  std::set<double> firsts;
  for (const std::uint64_t seed : {1ull, 2ull, 1ull << 32})
    for (const std::uint32_t generation : {0u, 1u})
      for (const std::uint32_t individual : {0u, 1u})
        for (const auto use : {Stream::Use::start, Stream::Use::selection, Stream::Use::variation, Stream::Use::retry})
          firsts.insert(Stream(seed, generation, individual, use).u01());
  EXPECT_EQ(firsts.size(), 3u * 2 * 2 * 4);
}

TEST(Random, UniformNumbersHaveTheRightMoments) {
  Stream stream(1, 0, 0, Stream::Use::start);
  const int n = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double u = stream.u01();
    ASSERT_TRUE(u >= 0 && u < 1);
    EXPECT_EQ(std::ldexp(u, 53), std::floor(std::ldexp(u, 53)));
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
}

TEST(Random, NormalNumbersHaveTheRightMoments) {
  Stream stream(1, 0, 0, Stream::Use::variation);
  const int n = 200000;
  double m1 = 0, m2 = 0, m4 = 0;
  int beyond = 0;
  for (int i = 0; i < n; ++i) {
    const double z = stream.normal();
    m1 += z / n;
    m2 += z * z / n;
    m4 += z * z * z * z / n;
    beyond += std::fabs(z) > 1.959963985;
  }
  EXPECT_NEAR(m1, 0, 5 * std::sqrt(1.0 / n));
  EXPECT_NEAR(m2, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m4, 3, 5 * std::sqrt(96.0 / n));
  EXPECT_NEAR(beyond / static_cast<double>(n), 0.05, 5 * std::sqrt(0.05 * 0.95 / n));
}

TEST(Random, BelowIsUniform) {
  Stream stream(1, 0, 0, Stream::Use::selection);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70000; ++i) ++counts.at(stream.below(7));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * std::sqrt(70000 * 6.0 / 49));
  EXPECT_EQ(stream.below(1), 0u);
}

TEST(Random, ChanceHasTheGivenProbability) {
  Stream stream(1, 0, 0, Stream::Use::selection);
  int hits = 0;
  for (int i = 0; i < 10000; ++i) {
    EXPECT_FALSE(stream.chance(0));
    EXPECT_TRUE(stream.chance(1));
    hits += stream.chance(0.3);
  }
  EXPECT_NEAR(hits, 3000, 5 * std::sqrt(10000 * 0.21));
}

}  // namespace
}  // namespace pkm
