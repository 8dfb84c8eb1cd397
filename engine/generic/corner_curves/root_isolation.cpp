#include "engine/generic/corner_curves/root_isolation.hpp"

#include <algorithm>

#include "engine/math/roots.hpp"

namespace pkm::generic::corner_curves {
namespace {

constexpr int kMaxDepth = 44;

struct SeriesInterval {
  double low, high;
  /// Bounds of the errors of the series and of its derivative with respect to the variable in [-1, 1] of the
  /// subinterval.
  double error, derivative_error;
  std::size_t terms;
  int depth;
  Samples c;
};

/// Markov's bound of the derivative on [-1, 1] of a polynomial with `terms` coefficients, relative to the maximum of
/// the polynomial.
double markov(std::size_t terms) { return static_cast<double>((terms - 1) * (terms - 1)); }

/// Upper bound of the sum of |c[k]| for k from `from` to terms - 1, including its rounding error.
double sum_of_magnitudes(const double* c, std::size_t from, std::size_t terms) {
  double sum = 0;
  for (std::size_t k = from; k < terms; ++k) sum += std::fabs(c[k]);
  return sum * (1 + 2 * kUnitRoundoff * static_cast<double>(kNodes));
}

/// Value of the series at the lower or upper end of its interval.
double end_value(const SeriesInterval& interval, bool upper) {
  double sum = 0;
  for (std::size_t k = interval.terms; k-- > 0;) sum += upper || k % 2 == 0 ? interval.c[k] : -interval.c[k];
  return sum;
}

}  // namespace

void isolate_roots(const Samples& coefficients, double error, std::vector<Root>& roots) {
  if (std::fabs(coefficients[0]) > sum_of_magnitudes(coefficients.data(), 1, kNodes) + error) return;
  std::array<SeriesInterval, kMaxDepth + 2> stack;
  Samples halved;
  std::size_t size = 1;
  stack[0] = {-1, 1, error, markov(kNodes) * error, kNodes, 0, coefficients};
  // If an undecided interval touches the previous root, both are replaced by one undecided interval.
  const auto add_root = [&](double low, double high) {
    if (!roots.empty() && (roots.back().width > 0 || high > low) && roots.back().at + 0.5 * roots.back().width >= low) {
      low = roots.back().at - 0.5 * roots.back().width;
      roots.pop_back();
    }
    roots.push_back({0.5 * (low + high), high - low});
  };
  while (size > 0) {
    SeriesInterval& interval = stack[size - 1];
    // Drop negligible coefficients and add them to the error bound.
    const std::size_t terms = significant_terms(interval.c, interval.terms, 0.1 * interval.error);
    if (terms < interval.terms) {
      const double rest = sum_of_magnitudes(interval.c.data(), terms, interval.terms);
      interval.error += rest;
      interval.derivative_error += markov(interval.terms) * rest;
      interval.terms = terms;
    }
    const double rest = sum_of_magnitudes(interval.c.data(), 1, interval.terms), first = std::fabs(interval.c[0]);
    if (first > rest + interval.error) {
      --size;
      continue;
    }
    if (first + rest <= 3 * interval.error || interval.depth == kMaxDepth || interval.terms < 2) {
      add_root(interval.low, interval.high);
      --size;
      continue;
    }
    std::array<double, kNodes> derivative;
    differentiate_series(interval.c.data(), interval.terms, derivative.data());
    if (std::fabs(derivative[0]) >
        sum_of_magnitudes(derivative.data(), 1, interval.terms - 1) + interval.derivative_error) {
      const double at_low = end_value(interval, false), at_high = end_value(interval, true);
      const double middle = 0.5 * (interval.low + interval.high), half = 0.5 * (interval.high - interval.low);
      if ((at_low < 0) != (at_high < 0)) {
        const auto series = [&](double x) { return evaluate_series(interval.c.data(), interval.terms, x); };
        roots.push_back({middle + half * refine_root(series, -1, at_low, 1, at_high, 2 * kUnitRoundoff)});
      } else if (std::fabs(at_low) <= interval.error) {
        add_root(interval.low, interval.low);
      } else if (std::fabs(at_high) <= interval.error) {
        add_root(interval.high, interval.high);
      }
      --size;
      continue;
    }
    SeriesInterval& lower = stack[size];
    const double middle = 0.5 * (interval.low + interval.high);
    lower.low = interval.low;
    lower.high = middle;
    // Bound of the rounding errors of restrict_to_halves(), a product with a matrix whose rows have sums of magnitudes
    // below 4.6.
    const double rounding = 4.6 * kUnitRoundoff * (0.5 * static_cast<double>(interval.terms) + 3) * (first + rest);
    lower.error = interval.error + rounding;
    lower.derivative_error = 0.5 * interval.derivative_error + markov(interval.terms) * rounding;
    lower.terms = interval.terms;
    lower.depth = interval.depth + 1;
    restrict_to_halves(interval.c, interval.terms, lower.c, halved);
    interval.low = middle;
    interval.error = lower.error;
    interval.derivative_error = lower.derivative_error;
    interval.depth = lower.depth;
    std::copy_n(halved.begin(), interval.terms, interval.c.begin());
    ++size;
  }
}

}  // namespace pkm::generic::corner_curves
