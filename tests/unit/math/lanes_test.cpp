#include "engine/math/lanes_functions.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "engine/math/portable.hpp"
#include "engine/math/random.hpp"

namespace pkm {
namespace {

using L = Lanes<2>;  // the width of the baseline instruction set, for which this file is compiled
using Eight = std::array<double, kLanes>;

constexpr Eight kX = {-3.7, -1, -0.25, 0, 0.1, 1, 2.5, 1e15 + 0.5};
constexpr Eight kY = {1.3, -1, 7, 0.5, -0.1, 3, 1e-3, 2};

template <class F>
Eight each(const F& f) {
  Eight r{};
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = f(kX[i], kY[i]);
  return r;
}
Eight values(const L& x) {
  Eight r{};
  x.store(r.data());
  return r;
}

TEST(Lanes, EqualDoubleArithmetic) {
  const L x = L::load(kX.data()), y = L::load(kY.data());
  EXPECT_EQ(values(x + y * 2.0), each([](double a, double b) { return a + b * 2.0; }));
  EXPECT_EQ(values(1.0 - x / y), each([](double a, double b) { return 1.0 - a / b; }));
  EXPECT_EQ(values(-x), each([](double a, double) { return -a; }));
  EXPECT_EQ(values(magnitude(x)), each([](double a, double) { return std::fabs(a); }));
  EXPECT_EQ(values(sqrt(y * y)), each([](double, double b) { return std::sqrt(b * b); }));
  EXPECT_EQ(values(sqrt_or_zero(x)), each([](double a, double) { return a > 0 ? std::sqrt(a) : 0; }));
  EXPECT_EQ(values(floor(x)), each([](double a, double) { return std::floor(a); }));
  EXPECT_EQ(values(ceil(x)), each([](double a, double) { return std::ceil(a); }));
}

TEST(Lanes, AreSelectedByMasks) {
  const L x = L::load(kX.data()), y = L::load(kY.data());
  EXPECT_EQ(values(select((x < y) & (x > -2.0), x, y)),
            each([](double a, double b) { return a < b && a > -2.0 ? a : b; }));
  EXPECT_EQ(values(select((x >= 1.0) & (y <= 0.0), L(1.0), L(0.0))),
            each([](double a, double b) { return a >= 1.0 && b <= 0.0 ? 1.0 : 0.0; }));
  EXPECT_EQ(values(lesser(x, y)), each([](double a, double b) { return a < b ? a : b; }));
  EXPECT_EQ(values(greater(x, y)), each([](double a, double b) { return a > b ? a : b; }));
}

TEST(Lanes, ExponentialIsBitIdenticalToPortableExp) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto compare = [](const Eight& x) {
    const Eight found = values(exp(L::load(x.data())));
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[i]), std::bit_cast<std::uint64_t>(portable::exp(x[i]))) << x[i];
  };
  compare({0, -0.0, 1, -1, 709.782712893384, 709.79, kInfinite, std::numeric_limits<double>::quiet_NaN()});
  compare({-708, -708.5, -744.9, -745.1, -745.2, -746, -kInfinite, 5e-324});  // subnormal results among them
  Stream random(1, 0, 0, Stream::Use::start);
  for (int round = 0; round < 2000; ++round) {
    Eight x;
    for (double& each : x) each = (random.u01() - 0.5) * (round % 2 ? 1500 : 4);
    compare(x);
  }
}

TEST(Lanes, MinimumAndMaximumOverTheLanes) {
  EXPECT_EQ(reduce_min(L::load(kX.data())), -3.7);
  EXPECT_EQ(reduce_max(L::load(kY.data())), 7);
}

}  // namespace
}  // namespace pkm
