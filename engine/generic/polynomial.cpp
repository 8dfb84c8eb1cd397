#include "engine/generic/polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/roots.hpp"

namespace pkm::generic {
namespace {

double value(std::span<const double> c, double x) {
  double sum = 0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

/// Root of a monotonic polynomial between endpoints of different signs; 0 counts as positive.
double bracketed_root_of(std::span<const double> c, double low, double high, double at_low) {
  const auto horner = [c](double x) {
    ValueAndDerivative f{0, 0};
    for (std::size_t i = c.size(); i-- > 0;) {
      f.derivative = f.derivative * x + f.value;
      f.value = f.value * x + c[i];
    }
    return f;
  };
  return refine_root_newton(
      horner, low, high, at_low >= 0, 0.5 * (low + high),
      [](const ValueAndDerivative&, double x, double next) { return std::fabs(next - x) <= 2e-16; });
}

/// Whether all Bernstein coefficients on [-1, 1] have one sign. If so, there is no root.
bool has_one_sign(std::span<const double> c) {
  // The coefficient of (1 - x)^(n-k) (1 + x)^k is, up to a positive factor, the sum over j of c_j times the sum over i
  // of (-1)^(j-i) C(k, i) C(n-k, j-i).
  static constexpr int kBinomial[5][5] = {
      {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};
  static const auto table = [] {
    // b[n][k][j]: contribution of x^j to the Bernstein coefficient with index k of a polynomial of degree n
    std::array<std::array<std::array<double, 5>, 5>, 5> b{};
    for (int n = 0; n < 5; ++n)
      for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j) {
          double sum = 0;  // polar form of x^j for k arguments 1 and n - k arguments -1, multiplied by C(n, j)
          for (int i = 0; i <= j; ++i)
            if (i <= k && j - i <= n - k) sum += kBinomial[k][i] * kBinomial[n - k][j - i] * ((j - i) % 2 ? -1 : 1);
          b[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
              sum / kBinomial[n][j];
        }
    return b;
  }();
  const std::size_t n = c.size() - 1;
  bool positive = true, negative = true;
  for (std::size_t k = 0; k <= n; ++k) {
    double b = 0;
    for (std::size_t j = 0; j <= n; ++j) b += table[n][k][j] * c[j];
    positive = positive && b > 0;
    negative = negative && b < 0;
  }
  return positive || negative;
}

/// Returns the coefficients without leading ones that are negligible.
std::span<const double> trimmed(std::span<const double> c) {
  double scale = 0;
  for (const double each : c) scale = std::fabs(each) > scale ? std::fabs(each) : scale;
  while (!c.empty() && std::fabs(c.back()) <= kNegligibleCoefficient * scale) c = c.first(c.size() - 1);
  return c;
}

/// Finds the roots in [-1, 1] and, if requested, points that are nearly double roots.
std::size_t find_roots(std::span<const double> coefficients, bool touches, std::array<double, 8>& roots) {
  double scale = 0;
  for (const double c : coefficients) scale = std::fabs(c) > scale ? std::fabs(c) : scale;
  coefficients = trimmed(coefficients);
  const std::size_t degree = coefficients.empty() ? 0 : coefficients.size() - 1;
  std::size_t count = 0;
  const auto keep = [&](double x) {
    if (std::fabs(x) <= 1 && count < roots.size()) roots[count++] = x;
  };
  if (degree == 0 || has_one_sign(coefficients)) return 0;
  if (degree == 1) {
    keep(-coefficients[0] / coefficients[1]);
    return count;
  }
  if (degree == 2) {
    const Roots found = roots_of({coefficients[0], coefficients[1], coefficients[2]});
    for (int i = 0; i < found.count; ++i) keep(found.s[static_cast<std::size_t>(i)]);
    if (found.count == 0 && touches) {  // no root was found, but there may be a double root
      const double x = -0.5 * coefficients[1] / coefficients[2];
      if (std::fabs(value(coefficients, x)) <= 1e-13 * scale) keep(x);
    }
    return count;
  }
  std::array<double, 4> slope{};
  for (std::size_t i = 1; i <= degree; ++i) slope[i - 1] = static_cast<double>(i) * coefficients[i];
  std::array<double, 8> turns{};
  const std::size_t turn_count = find_roots(std::span(slope).first(degree), touches, turns);
  double low = -1, at_low = value(coefficients, low);
  if (touches && at_low == 0) keep(low);
  for (std::size_t i = 0; i <= turn_count; ++i) {
    const double high = i < turn_count ? turns[i] : 1, at_high = value(coefficients, high);
    if ((at_low < 0) != (at_high < 0))
      keep(bracketed_root_of(coefficients, low, high, at_low));
    else if (touches && i < turn_count && std::fabs(at_high) <= 1e-13 * scale)
      keep(high);
    low = high;
    at_low = at_high;
  }
  return count;
}

}  // namespace

Roots roots_of(const std::array<double, 3>& c) {
  const auto [c0, b, a] = c;
  if (a == 0) {
    if (b == 0) return {};
    return {{-c0 / b, 0}, 1};
  }
  const double discriminant = b * b - 4 * a * c0;
  if (!(discriminant >= 0)) return {};
  const double q = -0.5 * (b + (b < 0 ? -1 : 1) * std::sqrt(discriminant));
  const double r1 = q / a, r2 = q == 0 ? r1 : c0 / q;
  return {{r1 < r2 ? r1 : r2, r1 < r2 ? r2 : r1}, 2};
}

std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots) {
  return find_roots(coefficients, true, roots);
}

std::size_t sign_changes(std::span<const double> coefficients, std::array<double, 8>& places) {
  const std::size_t count = find_roots(coefficients, false, places);
  const auto end = std::remove_if(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count),
                                  [](double x) { return std::fabs(x) == 1; });
  return static_cast<std::size_t>(end - places.begin());
}

}  // namespace pkm::generic
