// Statistics of weighted samples. Sums are accumulated in the order of the samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "engine/math/scalar.hpp"

namespace pkm {

/// Weighted mean: sum of w f divided by the sum of w; 0 if there are no samples.
template <class S>
S weighted_mean(const std::vector<S>& weight, const std::vector<S>& field) {
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    sum += weight[i] * field[i];
    total += weight[i];
  }
  return value_of(total) > 0 ? S(sum / total) : S(0.0);
}

/// Power mean (mean of f^r)^(1/r) of numbers >= 0: a smooth, scale-invariant approximation of their maximum. It is not
/// above the maximum and converges to it as r increases; 0 if there are no samples, NaN if one of them is NaN.
template <class S>
S power_mean(const std::vector<S>& field, double r) {
  double maximum = 0;  // scale factor without derivatives: the result does not depend on it
  for (const S& value : field) maximum = std::fmax(maximum, value_of(value));
  if (!(maximum > 0)) return S(0.0);
  S sum(0.0);
  for (const S& value : field)
    if (!(value_of(value) <= 0)) sum += exp(S(log(S(value / maximum)) * r));
  return exp(S(log(S(sum / static_cast<double>(field.size()))) / r)) * maximum;
}

/// Minimum of the samples; 0 if there are none.
template <class S>
S minimum(const std::vector<S>& field) {
  return field.empty() ? S(0.0) : *std::ranges::min_element(field, {}, [](const S& x) { return value_of(x); });
}

/// Maximum of the samples; 0 if there are none.
template <class S>
S maximum(const std::vector<S>& field) {
  return field.empty() ? S(0.0) : *std::ranges::max_element(field, {}, [](const S& x) { return value_of(x); });
}

/// Kreisselmeier-Steinhauser aggregate m + ln(sum of w exp(r (f - m)) / sum of w) / r, with a reference value m that
/// prevents overflow.
template <class S>
S kreisselmeier_steinhauser(const std::vector<S>& weight, const std::vector<S>& field, double m, double r) {
  if (field.empty()) return S(0.0);
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    sum += weight[i] * exp(S((field[i] - m) * r));
    total += weight[i];
  }
  return m + log(S(sum / total)) / r;
}

/// Smooth approximation of the minimum (soft-min): the weighted Kreisselmeier-Steinhauser aggregate
///   m - ln(sum of w exp(-r (f - m)) / sum of w) / r,   m = minimum of f,   r = sharpness.
/// It is not below the minimum and converges to it as r increases; 0 if there are no samples. m is treated as a
/// constant, because the result does not depend on it.
template <class S>
S soft_min(const std::vector<S>& weight, const std::vector<S>& field, double sharpness) {
  return kreisselmeier_steinhauser(weight, field, value_of(minimum(field)), -sharpness);
}

/// Smooth approximation of the maximum (soft-max), the counterpart of soft_min(): it is not above the maximum and
/// converges to it as `sharpness` increases.
template <class S>
S soft_max(const std::vector<S>& weight, const std::vector<S>& field, double sharpness) {
  return kreisselmeier_steinhauser(weight, field, value_of(maximum(field)), sharpness);
}

/// Weighted standard deviation of a population: the square root of the weighted mean of (f - mean)^2; 0 if there are no
/// samples.
template <class S>
S weighted_standard_deviation(const std::vector<S>& weight, const std::vector<S>& field) {
  const S mean = weighted_mean(weight, field);
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const S deviation = field[i] - mean;
    sum += weight[i] * deviation * deviation;
    total += weight[i];
  }
  return value_of(total) > 0 ? sqrt_or_zero(S(sum / total)) : S(0.0);
}

/// Weighted quantile for the probability p, by linear interpolation between the order statistics. Sample k is at the
/// cumulative weight of all samples before it plus half of its own, scaled so that the first is at 0 and the last at 1.
/// With equal weights this is the position p (count - 1), the usual interpolation (type 7 of Hyndman and Fan 1996). 0
/// if there are no samples.
/// @param order  scratch memory
inline double weighted_quantile(const std::vector<double>& weight, const std::vector<double>& field, double p,
                                std::vector<std::size_t>& order) {
  if (field.empty()) return 0;
  order.resize(field.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return field[a] != field[b] ? field[a] < field[b] : a < b; });
  double total = 0;
  for (std::size_t k = 0; k + 1 < order.size(); ++k) total += 0.5 * (weight[order[k]] + weight[order[k + 1]]);
  double rest = p * total;
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const double gap = 0.5 * (weight[order[k]] + weight[order[k + 1]]);
    if (rest <= gap && gap > 0) return field[order[k]] + (field[order[k + 1]] - field[order[k]]) * (rest / gap);
    rest -= gap;
  }
  return field[order.back()];
}
inline double weighted_quantile(const std::vector<double>& weight, const std::vector<double>& field, double p) {
  std::vector<std::size_t> order;
  return weighted_quantile(weight, field, p, order);
}

}  // namespace pkm
