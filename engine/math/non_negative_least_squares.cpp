#include "engine/math/non_negative_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/QR>

namespace pkm {
namespace {

Eigen::MatrixXd column_matrix(const std::vector<std::vector<double>>& columns, const std::vector<std::size_t>& passive,
                              std::size_t rows) {
  Eigen::MatrixXd m(rows, passive.size());
  for (std::size_t k = 0; k < passive.size(); ++k)
    for (std::size_t i = 0; i < rows; ++i)
      m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = columns[passive[k]][i];
  return m;
}

}  // namespace

std::vector<double> non_negative_least_squares(const std::vector<std::vector<double>>& columns,
                                               const std::vector<double>& b, double enough) {
  const std::size_t n = columns.size(), rows = b.size();
  const Eigen::Map<const Eigen::VectorXd> target(b.data(), static_cast<Eigen::Index>(rows));
  std::vector<double> x(n, 0.0);
  std::vector<bool> in_passive_set(n, false);
  for (std::size_t step = 0; step < 10 * n + 10; ++step) {
    Eigen::VectorXd residual = target;
    // Magnitude of the terms of the residual, which determines its rounding errors.
    double magnitude = target.norm() + 1e-300;
    for (std::size_t k = 0; k < n; ++k) {
      double square = 0;
      for (std::size_t i = 0; i < rows; ++i) {
        residual(static_cast<Eigen::Index>(i)) -= columns[k][i] * x[k];
        square += columns[k][i] * columns[k][i];
      }
      magnitude += std::sqrt(square) * x[k];
    }
    if (residual.norm() <= enough) return x;
    // The column with the largest component of the negative gradient enters the passive set.
    std::size_t entering = n;
    double max_gain = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (in_passive_set[k]) continue;
      double gain = 0, scale = 0;
      for (std::size_t i = 0; i < rows; ++i) {
        gain += columns[k][i] * residual(static_cast<Eigen::Index>(i));
        scale += columns[k][i] * columns[k][i];
      }
      if (gain > max_gain && gain > 1e-13 * std::sqrt(scale) * magnitude) {
        max_gain = gain;
        entering = k;
      }
    }
    if (entering == n) return x;
    in_passive_set[entering] = true;
    while (true) {
      std::vector<std::size_t> passive;
      for (std::size_t k = 0; k < n; ++k)
        if (in_passive_set[k]) passive.push_back(k);
      const Eigen::VectorXd trial = column_matrix(columns, passive, rows).colPivHouseholderQr().solve(target);
      double step_length = 1;  // length, relative to `trial` - x, of the largest step that keeps all components >= 0
      for (std::size_t k = 0; k < passive.size(); ++k) {
        const double to = trial(static_cast<Eigen::Index>(k)), from = x[passive[k]];
        if (to <= 0) step_length = std::min(step_length, from / (from - to));
      }
      // If the step length is 0/0, the entering column is linearly dependent on the others.
      if (!(step_length >= 0)) step_length = 0;
      for (std::size_t k = 0; k < passive.size(); ++k)
        x[passive[k]] += step_length * (trial(static_cast<Eigen::Index>(k)) - x[passive[k]]);
      if (step_length == 1) break;
      for (std::size_t k = 0; k < passive.size(); ++k)
        if (trial(static_cast<Eigen::Index>(k)) <= 0 && x[passive[k]] <= 1e-300) {
          x[passive[k]] = 0;
          in_passive_set[passive[k]] = false;
        }
      if (std::none_of(in_passive_set.begin(), in_passive_set.end(), [](bool is_passive) { return is_passive; })) break;
    }
  }
  throw std::runtime_error("the non-negative least-squares iteration does not converge");
}

}  // namespace pkm
