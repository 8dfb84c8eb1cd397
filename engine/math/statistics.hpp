// Statistics of weighted samples, added in the order of the samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/math/scalar.hpp"

namespace pkm {

/// Sum of w f over the sum of w; 0 without samples.
template <class S>
S weighted_mean(const std::vector<S>& weight, const std::vector<S>& field) {
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    sum += weight[i] * field[i];
    total += weight[i];
  }
  return value_of(total) > 0 ? S(sum / total) : S(0.0);
}

/// (mean of f^r)^(1/r) of numbers >= 0: a smooth stand-in for the greatest of them, whatever their unit. Not above it,
/// and it tends to it as r grows; 0 without samples, NaN where one is.
template <class S>
S power_mean(const std::vector<S>& field, double r) {
  double greatest = 0;  // a constant: the result does not depend on what the sum is scaled by
  for (const S& value : field) greatest = std::fmax(greatest, value_of(value));
  if (!(greatest > 0)) return S(0.0);
  S sum(0.0);
  for (const S& value : field)
    if (!(value_of(value) <= 0)) sum += exp(S(log(S(value / greatest)) * r));
  return exp(S(log(S(sum / static_cast<double>(field.size()))) / r)) * greatest;
}

/// The least value; 0 without samples.
template <class S>
S least(const std::vector<S>& field) {
  return field.empty() ? S(0.0) : *std::ranges::min_element(field, {}, [](const S& x) { return value_of(x); });
}

/// The greatest value; 0 without samples.
template <class S>
S greatest(const std::vector<S>& field) {
  return field.empty() ? S(0.0) : *std::ranges::max_element(field, {}, [](const S& x) { return value_of(x); });
}

/// m + ln(sum of w exp(r (f - m)) / sum of w) / r.
template <class S>
S soft_extreme(const std::vector<S>& weight, const std::vector<S>& field, double m, double r) {
  if (field.empty()) return S(0.0);
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    sum += weight[i] * exp(S((field[i] - m) * r));
    total += weight[i];
  }
  return m + log(S(sum / total)) / r;
}

/// Kreisselmeier-Steinhauser aggregate of the least value, weighted by measure:
///   m - ln(sum of w exp(-r (f - m)) / sum of w) / r,   m = least f,   r = sharpness.
/// Smooth, not below the least value, and it tends to it as r grows; 0 without samples. m counts as a constant: the
/// sum's derivative does not depend on it.
template <class S>
S soft_least(const std::vector<S>& weight, const std::vector<S>& field, double sharpness) {
  return soft_extreme(weight, field, value_of(least(field)), -sharpness);
}

/// The same aggregate of the greatest value: not above it, and it tends to it as `sharpness` grows.
template <class S>
S soft_greatest(const std::vector<S>& weight, const std::vector<S>& field, double sharpness) {
  return soft_extreme(weight, field, value_of(greatest(field)), sharpness);
}

/// Root of the weighted mean square distance from the mean (population); 0 without samples.
template <class S>
S weighted_deviation(const std::vector<S>& weight, const std::vector<S>& field) {
  const S mean = weighted_mean(weight, field);
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const S off = field[i] - mean;
    sum += weight[i] * off * off;
    total += weight[i];
  }
  return value_of(total) > 0 ? root_or_zero(S(sum / total)) : S(0.0);
}

/// The value below which the share p of the weight lies, interpolated between the samples in their order: sample k
/// stands at the weight of half of itself and all before it, between 0 for the first and 1 for the last. With equal
/// weights that is position p (count - 1), the usual interpolation of order statistics. 0 without samples.
/// @param order  overwritten
inline double weighted_quantile(const std::vector<double>& weight, const std::vector<double>& field, double p,
                                std::vector<std::size_t>& order) {
  if (field.empty()) return 0;
  order.resize(field.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return field[a] != field[b] ? field[a] < field[b] : a < b; });
  double span = 0;
  for (std::size_t k = 0; k + 1 < order.size(); ++k) span += 0.5 * (weight[order[k]] + weight[order[k + 1]]);
  double left = p * span;
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const double step = 0.5 * (weight[order[k]] + weight[order[k + 1]]);
    if (left <= step && step > 0) return field[order[k]] + (field[order[k + 1]] - field[order[k]]) * (left / step);
    left -= step;
  }
  return field[order.back()];
}
inline double weighted_quantile(const std::vector<double>& weight, const std::vector<double>& field, double p) {
  std::vector<std::size_t> order;
  return weighted_quantile(weight, field, p, order);
}

}  // namespace pkm
