#include "engine/expression/operation.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "engine/core/catalogue.hpp"

namespace pkm::expression {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_constant(double) { return true; }
template <int N>
bool is_constant(const Dual<N>& x) {
  for (int i = 0; i < N; ++i)
    if (x.v[i] != 0) return false;
  return true;
}
bool is_constant(const Taylor& x) { return x.d == 0 && x.dd == 0; }

/// Sine and cosine; NaN beyond 1e5 rad, the largest angle for which the portable range reduction is accurate.
template <class S>
SinCosOf<S> sine_and_cosine(const S& angle) {
  if (!(std::fabs(value_of(angle)) <= 1e5)) return {S(kNaN), S(kNaN)};
  return sincos(angle);
}

template <class S>
S tangent(const S& angle) {
  const auto [sine, cosine] = sine_and_cosine(angle);
  return sine / cosine;
}

/// x^n by repeated squaring (binary exponentiation).
template <class S>
S integer_power(S x, int n) {
  if (n < 0) return 1.0 / integer_power(x, -n);
  S result(1.0);
  for (bool first = true; n > 0; n /= 2, x = x * x)
    if (n % 2) {
      result = first ? x : result * x;
      first = false;
    }
  return result;
}

template <class S>
S power(const S& x, const S& y) {
  const double base = value_of(x), exponent = value_of(y);
  if (exponent == std::nearbyint(exponent) && std::fabs(exponent) <= 1024) {
    S result = integer_power(x, static_cast<int>(exponent));
    // If the exponent is a variable, multiply by exp((y - y_0) log(x)) = 1: this adds the derivative with respect to
    // the exponent and leaves the value unchanged.
    if (!is_constant(y) && base > 0) result = result * exp(S((y - exponent) * log(x)));
    return result;
  }
  if (base > 0) return exp(S(y * log(x)));
  if (base == 0 && exponent > 0) return S(0.0);
  if (base == 0 && exponent < 0) return S(std::numeric_limits<double>::infinity());
  return S(kNaN);
}

template <class S>
S hyperbolic_sine(const S& x) {
  if (std::fabs(value_of(x)) > 0.5) {
    const S e = exp(x);
    return (e - 1.0 / e) * 0.5;
  }
  // If |x| <= 0.5, use the Taylor series of sinh, x + x^3/3! + ... + x^13/13!, because e^x - e^-x would suffer from
  // cancellation.
  const S q = x * x;
  S sum = q * (1.0 / 156) + 1.0;
  for (const double inverse : {1.0 / 110, 1.0 / 72, 1.0 / 42, 1.0 / 20, 1.0 / 6}) sum = q * inverse * sum + 1.0;
  return x * sum;
}

template <class S>
S hyperbolic_cosine(const S& x) {
  const S e = exp(x);
  return (e + 1.0 / e) * 0.5;
}

template <class S>
S hyperbolic_tangent(const S& x) {
  if (std::fabs(value_of(x)) <= 0.5) return hyperbolic_sine(x) / hyperbolic_cosine(x);
  if (value_of(x) < 0) return -hyperbolic_tangent(S(-x));
  return 1.0 - 2.0 / (exp(S(x * 2.0)) + 1.0);
}

/// Minimum for Less = std::less, maximum for Less = std::greater; NaN if an argument is NaN.
template <class Less, class S>
S min_or_max(std::span<const S> x) {
  S best = x[0];
  for (const S& each : x.subspan(1)) {
    const double next = value_of(each);
    if (Less()(next, value_of(best)) || next != next) best = each;
    if (next != next) break;
  }
  return best;
}

template <class F>
Interval left_fold(std::span<const Interval> x, const F& f) {
  Interval result = x[0];
  for (const Interval& each : x.subspan(1)) result = f(result, each);
  return result;
}

/// Evaluates the function object F as an entry of Operation::rules. If all arguments are constants, all derivatives of
/// the result are 0, even where the operation is not differentiable (sqrt at 0).
template <std::size_t arguments, class F, class S>
S rule(const S* x, std::size_t count) {
  if constexpr (Derivative<S> && arguments <= 2)
    if (count <= 2 && is_constant(x[0]) && is_constant(x[count - 1])) {
      const double values[2] = {value_of(x[0]), value_of(x[count - 1])};
      return S(rule<arguments, F>(values, count));
    }
  if constexpr (arguments == 0) return F()(std::span<const S>(x, count));
  if constexpr (arguments == 1) return F()(x[0]);
  if constexpr (arguments == 2) return F()(x[0], x[1]);
  if constexpr (arguments == 3) return F()(x[0], x[1], x[2]);
}

/// Makes an operation from two implementations: F for double and the differentiation scalars, Bounds for intervals.
template <std::size_t arguments, class F, class Bounds>
Operation make(std::string name, F, Bounds, int rank = 0, Code code = Code::other) {
  return {std::move(name),
          arguments,
          {rule<arguments, F, double>, rule<arguments, F, Dual4>, rule<arguments, F, Taylor>,
           rule<arguments, Bounds, Interval>},
          rank,
          code};
}
/// Makes an operation from one generic implementation F, which serves all scalars, intervals included.
template <std::size_t arguments, class F>
Operation make(std::string name, F f, int rank = 0, Code code = Code::other) {
  return make<arguments>(std::move(name), f, f, rank, code);
}

/// Makes a comparison or a logical operator: its value is 1 if F holds, otherwise 0; NaN if an argument is NaN.
template <class F, class Bounds>
Operation predicate(std::string name, F, Bounds bounds, int rank) {
  const auto truth = [](const auto& x, const auto& y) {
    const double a = value_of(x), b = value_of(y);
    return a == a && b == b ? (F()(a, b) ? 1.0 : 0.0) : kNaN;
  };
  return make<2>(std::move(name), truth, bounds, rank);
}

using I = const Interval&;

}  // namespace

const std::vector<Operation>& functions() {
  static const std::vector<Operation> list = {
      make<1>(
          "sin", [](const auto& x) { return sine_and_cosine(x).sin; }, [](I x) { return sin(x); }),
      make<1>(
          "cos", [](const auto& x) { return sine_and_cosine(x).cos; }, [](I x) { return cos(x); }),
      make<1>(
          "tan", [](const auto& x) { return tangent(x); }, [](I x) { return tan(x); }),
      make<1>("asin", [](const auto& x) { return asin(x); }),
      make<1>("acos", [](const auto& x) { return acos(x); }),
      make<1>(
          "atan", []<class S>(const S& x) { return atan2(x, S(1.0)); }, [](I x) { return atan(x); }),
      make<2>("atan2", [](const auto& y, const auto& x) { return atan2(y, x); }),
      make<1>(
          "sinh", [](const auto& x) { return hyperbolic_sine(x); }, [](I x) { return sinh(x); }),
      make<1>(
          "cosh", [](const auto& x) { return hyperbolic_cosine(x); }, [](I x) { return cosh(x); }),
      make<1>(
          "tanh", [](const auto& x) { return hyperbolic_tangent(x); }, [](I x) { return tanh(x); }),
      make<1>("exp", [](const auto& x) { return exp(x); }),
      make<1>("log", [](const auto& x) { return log(x); }),
      make<1>(
          "log10", [](const auto& x) { return log(x) / 2.302585092994045684; }, [](I x) { return log10(x); }),
      make<1>(
          "sqrt", [](const auto& x) { return sqrt(x); }, 0, Code::sqrt),
      make<1>(
          "abs", [](const auto& x) { return magnitude(x); }, 0, Code::abs),
      make<1>(
          "sign",
          [](const auto& x) {
            const double a = value_of(x);
            return a > 0 ? 1.0 : a < 0 ? -1.0 : a;
          },
          [](I x) { return sign(x); }),
      make<0>(
          "min", [](const auto& x) { return min_or_max<std::less<>>(x); },
          [](std::span<const Interval> x) { return left_fold(x, [](I a, I b) { return min(a, b); }); }, 0, Code::min),
      make<0>(
          "max", [](const auto& x) { return min_or_max<std::greater<>>(x); },
          [](std::span<const Interval> x) { return left_fold(x, [](I a, I b) { return max(a, b); }); }, 0, Code::max),
  };
  return list;
}

const std::vector<Operation>& operators() {
  static const std::vector<Operation> list = {
      predicate(
          "||", [](double a, double b) { return a != 0 || b != 0; }, [](I x, I y) { return max(truth(x), truth(y)); },
          1),
      predicate(
          "&&", [](double a, double b) { return a != 0 && b != 0; }, [](I x, I y) { return min(truth(x), truth(y)); },
          2),
      predicate(
          "<", std::less<>(), [](I x, I y) { return less(x, y); }, 4),
      predicate(
          "<=", std::less_equal<>(), [](I x, I y) { return less_or_equal(x, y); }, 4),
      predicate(
          ">", std::greater<>(), [](I x, I y) { return less(y, x); }, 4),
      predicate(
          ">=", std::greater_equal<>(), [](I x, I y) { return less_or_equal(y, x); }, 4),
      predicate(
          "==", std::equal_to<>(), [](I x, I y) { return equal(x, y); }, 4),
      predicate(
          "!=", std::not_equal_to<>(), [](I x, I y) { return Interval(1.0) - equal(x, y); }, 4),
      make<2>("+", std::plus<>(), 5, Code::add),
      make<2>("-", std::minus<>(), 5, Code::subtract),
      make<2>("*", std::multiplies<>(), 6, Code::multiply),
      make<2>("/", std::divides<>(), 6, Code::divide),
      make<2>(
          "^", [](const auto& x, const auto& y) { return power(x, y); }, [](I x, I y) { return pow(x, y); }, 7),
  };
  return list;
}

const Operation& negation() {
  static const Operation negation = make<1>("-", std::negate<>(), 6, Code::negate);
  return negation;
}

const Operation& choice() {
  static const Operation choice = make<3>(
      "?",
      []<class S>(const S& condition, const S& x, const S& y) {
        const double value = value_of(condition);
        return value != value ? S(kNaN) : value != 0 ? x : y;
      },
      [](I condition, I x, I y) { return choose(condition, x, y); });
  return choice;
}

const Operation& angle_wrapping() {
  static const Operation wrapping = make<1>("turn", [](const auto& x) { return wrapped(x); });
  return wrapping;
}

const Operation& solving() {
  static const Operation solving{.name = "solve", .arguments = 0, .rules = {}, .code = Code::solve};
  return solving;
}

const Operation& unknown() {
  static const Operation unknown{.name = "unknown", .arguments = 1, .rules = {}};
  return unknown;
}

const Operation& operation(const std::string& name) {
  for (const auto* const list : {&functions(), &operators()})
    if (const Operation* const found = find_named(*list, name)) return *found;
  throw std::logic_error("there is no operation '" + name + "'");
}

}  // namespace pkm::expression
