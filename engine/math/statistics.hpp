// Statistics of weighted samples, added in the order of the samples.
#pragma once

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

/// The least value; 0 without samples.
template <class S>
S least(const std::vector<S>& field) {
  if (field.empty()) return S(0.0);
  S result = field.front();
  for (const S& value : field) result = min(result, value);
  return result;
}

/// Kreisselmeier-Steinhauser aggregate of the least value, weighted by measure:
///   m - ln(sum of w exp(-r (f - m)) / sum of w) / r,   m = least f,   r = sharpness.
/// Smooth, not below the least value, and it tends to it as r grows; 0 without samples.
template <class S>
S soft_least(const std::vector<S>& weight, const std::vector<S>& field, double sharpness) {
  if (field.empty()) return S(0.0);
  const double shift = value_of(least(field));  // a constant: the sum's derivative does not depend on it
  S sum(0.0), total(0.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    sum += weight[i] * exp(S((field[i] - shift) * -sharpness));
    total += weight[i];
  }
  return shift - log(S(sum / total)) / sharpness;
}

}  // namespace pkm
