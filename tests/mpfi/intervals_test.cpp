// Interval operations on random arguments against MPFI, which gives the tightest interval with double bounds: the
// result must contain it and may be only slightly wider. The environment variable PKM_INTERVAL_OPERATIONS sets the
// number of trials per operation.
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <mpfi.h>

#include "engine/math/interval.hpp"

namespace pkm {
namespace {

/// RAII wrapper of an MPFI interval with 53 bits, so that its bounds are doubles.
class Reference {
 public:
  explicit Reference(const Interval& x = {}) {
    mpfi_init2(x_, 53);
    mpfi_interv_d(x_, x.lower, x.upper);
  }
  ~Reference() { mpfi_clear(x_); }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  mpfi_ptr get() { return x_; }
  double lower() { return mpfr_get_d(&x_->left, MPFR_RNDD); }
  double upper() { return mpfr_get_d(&x_->right, MPFR_RNDU); }

 private:
  mpfi_t x_;
};

struct Function {
  std::string name;
  std::function<Interval(const Interval&, const Interval&)> tested;
  std::function<void(mpfi_ptr, mpfi_ptr, mpfi_ptr)> reference;
  double from, to;            ///< range of the arguments
  double relative, absolute;  ///< tolerance of each bound
};

std::size_t trials() {
  const char* const given = std::getenv("PKM_INTERVAL_OPERATIONS");
  return given ? std::strtoull(given, nullptr, 10) : 20000;
}

/// A random interval within [from, to]: a single number, or a narrow or wide interval; some endpoints are integers.
Interval random_interval(std::mt19937_64& random, double from, double to) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto number = [&] {
    const double size = std::exp2(-60 * unit(random) * unit(random));
    const double x = unit(random) < 0.1 ? std::nearbyint(from + unit(random) * (to - from))
                                        : (unit(random) < 0.5 ? from * size : to * size);
    return std::clamp(x, from, to);
  };
  const double a = number(), kind = unit(random);
  if (kind < 0.2) return {a};
  if (kind < 0.6) return {a, std::min(to, a + std::fabs(a) * std::exp2(-50 * unit(random)))};
  const double b = number();
  return {std::min(a, b), std::max(a, b)};
}

class IntervalsAgainstMpfi : public testing::TestWithParam<Function> {};

TEST_P(IntervalsAgainstMpfi, ContainTheTightestOnesAndAreSlightlyWider) {
  const Function& f = GetParam();
  std::mt19937_64 random(7);
  for (std::size_t i = 0; i < trials(); ++i) {
    const Interval x = random_interval(random, f.from, f.to), y = random_interval(random, f.from, f.to);
    Reference a(x), b(y), c;
    f.reference(c.get(), a.get(), b.get());
    const double lower = c.lower(), upper = c.upper();
    if (lower != lower || upper != upper || lower > upper) continue;  // undefined for some arguments
    const bool at_branch_cut = f.name == "atan2" && x.holds(0) && y.lower <= 0;
    // The result of MPFI is unspecified for these arguments.
    if ((f.name.starts_with("divide") && y.is_number() && y.lower == 0) || at_branch_cut) continue;
    const Interval found = f.tested(x, y);
    const auto tolerance = [&](double at) { return f.absolute + f.relative * std::fabs(at) + 1e-320; };
    ASSERT_TRUE(found.lower <= lower && found.upper >= upper)
        << i << std::hexfloat << ": [" << x.lower << ", " << x.upper << "], [" << y.lower << ", " << y.upper
        << "] gives [" << found.lower << ", " << found.upper << "], which does not contain [" << lower << ", " << upper
        << "]";
    if (std::isfinite(lower)) {
      ASSERT_GE(found.lower, lower - tolerance(lower)) << i << ' ' << x.lower << ' ' << x.upper << ' ' << y.lower;
    }
    if (std::isfinite(upper)) {
      ASSERT_LE(found.upper, upper + tolerance(upper)) << i << ' ' << x.lower << ' ' << x.upper << ' ' << y.lower;
    }
  }
}

/// Makes a test case from a function of one argument.
Function unary(std::string name, Interval (*tested)(const Interval&), int (*reference)(mpfi_ptr, mpfi_srcptr),
               double from, double to, double relative, double absolute = 0) {
  return {std::move(name),
          [tested](const Interval& x, const Interval&) { return tested(x); },
          [reference](mpfi_ptr c, mpfi_ptr a, mpfi_ptr) { reference(c, a); },
          from,
          to,
          relative,
          absolute};
}
/// Makes a test case from a function of two arguments.
template <class Tested>
Function binary(std::string name, Tested tested, int (*reference)(mpfi_ptr, mpfi_srcptr, mpfi_srcptr), double from,
                double to, double relative, double absolute = 0) {
  return {std::move(name), tested,  [reference](mpfi_ptr c, mpfi_ptr a, mpfi_ptr b) { reference(c, a, b); }, from, to,
          relative,        absolute};
}

using I = const Interval&;
constexpr double kUlp = 0x1p-52;

INSTANTIATE_TEST_SUITE_P(
    EveryFunction, IntervalsAgainstMpfi,
    testing::Values(
        binary(
            "add", [](I x, I y) { return x + y; }, mpfi_add, -1e3, 1e3, 2 * kUlp),
        binary(
            "subtract", [](I x, I y) { return x - y; }, mpfi_sub, -1e3, 1e3, 2 * kUlp),
        binary(
            "multiply", [](I x, I y) { return x * y; }, mpfi_mul, -1e3, 1e3, 2 * kUlp),
        binary(
            "divide", [](I x, I y) { return x / y; }, mpfi_div, -1e3, 1e3, 2 * kUlp),
        binary(
            "divide_positive", [](I x, I y) { return x / y; }, mpfi_div, 0, 1e3, 2 * kUlp),
        binary(
            "multiply_large", [](I x, I y) { return x * y; }, mpfi_mul, -1e200, 1e200, 2 * kUlp),
        binary(
            "multiply_small", [](I x, I y) { return x * y; }, mpfi_mul, -1e-170, 1e-170, 2 * kUlp),
        unary("square", square, mpfi_sqr, -1e3, 1e3, 2 * kUlp), unary("sqrt", sqrt, mpfi_sqrt, 0, 1e3, 2 * kUlp),
        unary("magnitude", magnitude, mpfi_abs, -1e3, 1e3, 0), unary("sin", sin, mpfi_sin, -20, 20, 8 * kUlp, 8 * kUlp),
        unary("cos", cos, mpfi_cos, -20, 20, 0, 8 * kUlp), unary("sin_far", sin, mpfi_sin, -1e5, 1e5, 0, 8 * kUlp),
        unary("cos_far", cos, mpfi_cos, -1e5, 1e5, 0, 8 * kUlp),
        unary("tan", tan, mpfi_tan, -1.5, 1.5, 1e3 * kUlp, 1e3 * kUlp),
        unary("asin", asin, mpfi_asin, -1, 1, 0, 64 * kUlp), unary("acos", acos, mpfi_acos, -1, 1, 0, 64 * kUlp),
        unary("atan", atan, mpfi_atan, -100, 100, 0, 16 * kUlp),
        binary(
            "atan2", [](I y, I x) { return atan2(y, x); }, mpfi_atan2, -10, 10, 0, 64 * kUlp),
        unary("exp", exp, mpfi_exp, -700, 700, 64 * kUlp), unary("exp_small", exp, mpfi_exp, -760, -690, 64 * kUlp),
        unary("log", log, mpfi_log, 1e-300, 1e3, 64 * kUlp, 1e-300),
        unary("log10", log10, mpfi_log10, 1e-6, 1e3, 64 * kUlp, 1e-300),
        unary("sinh", sinh, mpfi_sinh, -20, 20, 64 * kUlp, 64 * kUlp),
        unary("cosh", cosh, mpfi_cosh, -20, 20, 64 * kUlp), unary("tanh", tanh, mpfi_tanh, -10, 10, 0, 64 * kUlp)),
    [](const auto& of) { return of.param.name; });

/// x^y against exp(y log x) in MPFI, and integer powers against repeated multiplication with 400 bits.
TEST(IntervalsAgainstMpfi, PowersContainThoseByLogarithms) {
  std::mt19937_64 random(11);
  for (std::size_t i = 0; i < trials(); ++i) {
    const Interval x = random_interval(random, 1e-3, 30), y = random_interval(random, -5, 5);
    Reference a(x), b(y), c;
    mpfi_log(c.get(), a.get());
    mpfi_mul(c.get(), c.get(), b.get());
    mpfi_exp(c.get(), c.get());
    const Interval found = pow(x, y);
    ASSERT_LE(found.lower, c.lower() * (1 + 64 * kUlp));
    ASSERT_GE(found.upper, c.upper() * (1 - 64 * kUlp));
    if (!y.is_number() || y.lower != std::nearbyint(y.lower)) continue;
    // Integer exponents.
    mpfi_t exact;
    mpfi_init2(exact, 400);
    mpfi_set(exact, a.get());
    for (int n = 1; n < std::fabs(y.lower); ++n) mpfi_mul(exact, exact, a.get());
    if (y.lower < 0) mpfi_inv(exact, exact);
    if (y.lower != 0) {
      EXPECT_LE(found.lower, mpfr_get_d(&exact->left, MPFR_RNDD));
      EXPECT_GE(found.upper, mpfr_get_d(&exact->right, MPFR_RNDU));
    }
    mpfi_clear(exact);
  }
}

}  // namespace
}  // namespace pkm
