#include "engine/dynamics/force_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/singular.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "engine/math/non_negative_least_squares.hpp"

namespace pkm {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

VectorXd eigen_vector(const AxisVector<double>& x) {
  return Eigen::Map<const VectorXd>(x.begin(), static_cast<Index>(x.size()));
}

/// The solutions y = particular + basis lambda of A y = f, with basis^T particular = 0.
struct Solutions {
  VectorXd particular;
  MatrixXd basis;
};

/// diag(scale) J
MatrixXd scaled_jacobian(const AxisMatrix<double>& J, const VectorXd& scale) {
  const auto m = static_cast<Index>(J.rows()), n = static_cast<Index>(J.cols());
  MatrixXd scaled(m, n);
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < n; ++j) scaled(i, j) = scale(i) * J(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  return scaled;
}

/// Solves J^T diag(scale) y = f.
Solutions solutions_of(const AxisMatrix<double>& J, const VectorXd& scale, const VectorXd& f) {
  const auto m = static_cast<Index>(J.rows()), n = static_cast<Index>(J.cols());
  const MatrixXd scaled = scaled_jacobian(J, scale);
  // With the decomposition scaled P = Q R, the solutions are y = Q (R^-T P^T f, lambda).
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(scaled);
  const MatrixXd Q = qr.householderQ();
  const MatrixXd R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const VectorXd permuted = qr.colsPermutation().transpose() * f;
  return {Q.leftCols(n) * R.transpose().triangularView<Eigen::Lower>().solve(permuted), Q.rightCols(m - n)};
}

/// The lambda of least norm with lower <= particular + basis lambda <= upper; std::nullopt if no lambda satisfies this.
/// @param multipliers  if no lambda satisfies the limits, receives a vector v with basis^T v = 0 and v^T y < v^T
///                     particular for all y within the limits
std::optional<VectorXd> nearest(const Solutions& y, const VectorXd& lower, const VectorXd& upper,
                                VectorXd* multipliers = nullptr) {
  const Index r = y.basis.cols();
  // All limits are divided by `length`, which exceeds |lambda| if all limits are finite. In this case, the residual of
  // the least squares is at least 1 / sqrt(2) if a lambda satisfies the limits, and 0 if none does. If a limit is
  // infinite, solutions with |lambda| <= 1000 length are found.
  double square = y.particular.squaredNorm();
  for (Index i = 0; i < lower.size(); ++i)
    for (const double limit : {lower(i), upper(i)})
      if (std::isfinite(limit)) square += limit * limit;
  const double length = square > 0 ? std::sqrt(square) : 1, empty = lower.allFinite() && upper.allFinite() ? 0.5 : 1e-3;
  std::vector<std::vector<double>> columns;
  std::vector<std::pair<Index, double>> origins;  // row of the basis and sign of each column
  const auto add = [&](Index i, double sign, double limit) {
    if (!std::isfinite(limit)) return;
    origins.emplace_back(i, sign);
    std::vector<double> column;
    for (Index k = 0; k < r; ++k) column.push_back(sign * y.basis(i, k));
    column.push_back(sign * (limit - y.particular(i)) / length);
    columns.push_back(std::move(column));
  };
  for (Index i = 0; i < lower.size(); ++i) {
    add(i, 1, lower(i));
    add(i, -1, upper(i));
  }
  std::vector<double> target(static_cast<std::size_t>(r) + 1, 0.0);
  target.back() = 1;
  const std::vector<double> u = non_negative_least_squares(columns, target, multipliers ? 1e-12 : empty);
  VectorXd residual = -Eigen::Map<const VectorXd>(target.data(), r + 1);
  for (std::size_t k = 0; k < columns.size(); ++k)
    residual += u[k] * Eigen::Map<const VectorXd>(columns[k].data(), r + 1);
  if (!(residual.norm() > empty)) {
    if (!multipliers) return {};
    multipliers->setZero(lower.size());
    for (std::size_t k = 0; k < columns.size(); ++k) (*multipliers)(origins[k].first) -= u[k] * origins[k].second;
    return {};
  }
  const VectorXd lambda = residual.head(r) * (-length / residual(r)), forces = y.particular + y.basis * lambda;
  constexpr double kRounding = 1e-9;
  const bool is_within =
      (forces - lower).minCoeff() >= -kRounding * length && (upper - forces).minCoeff() >= -kRounding * length;
  return is_within ? std::optional(lambda) : std::nullopt;
}

/// Finds the largest s in [0, most] for which is_possible(s) is true, if it is true for all smaller s, too; 0 if it is
/// true for no s.
template <class Possible>
double bisect(double most, const Possible& is_possible) {
  double from = 0, to = most;
  for (int step = 0; step < 50; ++step) {
    const double middle = (from + to) / 2;
    (is_possible(middle) ? from : to) = middle;
  }
  return from;
}

/// The lambda that minimises the largest magnitude of y and, if several lambda do, the one with the least norm.
VectorXd least_maximum(const Solutions& y, const VectorXd& lower, const VectorXd& upper, const VectorXd& start) {
  const double largest = (y.particular + y.basis * start).cwiseAbs().maxCoeff();
  const auto within = [&](double magnitude) {
    return nearest(y, lower.cwiseMax(-magnitude), upper.cwiseMin(magnitude));
  };
  const double reduction = bisect(largest, [&](double by) { return within(largest - by).has_value(); });
  // Relative widening of the limits, so that the set of solutions is not a single point.
  constexpr double kRounding = 1e-9;
  return within(largest - reduction + kRounding * largest).value_or(start);
}

/// Analytic centre: maximises the sum of log(y - lower) + log(upper - y) by Newton's method.
VectorXd analytic_centre(const Solutions& y, const VectorXd& lower, const VectorXd& upper, const VectorXd& start) {
  const auto tightened = [&](double by) { return nearest(y, lower.array() + by, upper.array() - by); };
  double widest = 0;
  for (Index i = 0; i < lower.size(); ++i)
    if (std::isfinite(upper(i) - lower(i))) widest = std::max(widest, upper(i) - lower(i));
  const double reserve = bisect(widest / 2, [&](double by) { return tightened(by).has_value(); });
  VectorXd lambda = tightened(reserve / 2).value_or(start);
  const auto distances = [&](const VectorXd& at) {
    const VectorXd forces = y.particular + y.basis * at;
    return std::pair<VectorXd, VectorXd>(forces - lower, upper - forces);
  };
  for (int step = 0; step < 100; ++step) {
    const auto [below, above] = distances(lambda);
    if (!(below.minCoeff() > 0 && above.minCoeff() > 0)) return lambda;  // the set of solutions has no interior
    const VectorXd gradient = y.basis.transpose() * (below.cwiseInverse() - above.cwiseInverse());
    const VectorXd weights = below.cwiseInverse().cwiseAbs2() + above.cwiseInverse().cwiseAbs2();
    const VectorXd change = (y.basis.transpose() * weights.asDiagonal() * y.basis).ldlt().solve(gradient);
    const double decrement = std::sqrt(std::max(0.0, gradient.dot(change)));
    lambda += change / (1 + decrement);  // the point stays in the interior, because the logarithms are self-concordant
    if (decrement < 1e-9) break;
  }
  return lambda;
}

}  // namespace

DriveLimits no_drive_limits(std::size_t joints) {
  DriveLimits limits{ForceSharing::least_norm, AxisVector<double>(joints), AxisVector<double>(joints),
                     AxisVector<double>(joints)};
  std::ranges::fill(limits.scale, 1.0);
  std::ranges::fill(limits.lower, -kInfinity);
  std::ranges::fill(limits.upper, kInfinity);
  return limits;
}

std::optional<AxisVector<double>> distribute_forces(const AxisMatrix<double>& J, const AxisVector<double>& f,
                                                    const DriveLimits& limits) {
  if (is_rank_deficient(J)) return {};
  const VectorXd scale = eigen_vector(limits.scale), lower = eigen_vector(limits.lower).cwiseQuotient(scale),
                 upper = eigen_vector(limits.upper).cwiseQuotient(scale);
  const Solutions y = solutions_of(J, scale, eigen_vector(f));
  std::optional<VectorXd> lambda = nearest(y, lower, upper);
  if (!lambda) return {};
  if (y.basis.cols() > 0 && limits.sharing == ForceSharing::least_maximum)
    lambda = least_maximum(y, lower, upper, *lambda);
  if (y.basis.cols() > 0 && limits.sharing == ForceSharing::centre) lambda = analytic_centre(y, lower, upper, *lambda);
  const VectorXd forces = (y.particular + y.basis * *lambda).cwiseProduct(scale);
  AxisVector<double> tau(limits.scale.size());
  // lambda satisfies the limits only up to rounding errors; therefore each force is clamped to its limits.
  for (std::size_t i = 0; i < tau.size(); ++i)
    tau[i] = std::clamp(forces(static_cast<Index>(i)), limits.lower[i], limits.upper[i]);
  return tau;
}

std::optional<AxisVector<double>> separating_vector(const AxisMatrix<double>& J, const AxisVector<double>& f,
                                                    const DriveLimits& limits) {
  if (is_rank_deficient(J)) return {};
  const VectorXd scale = eigen_vector(limits.scale), lower = eigen_vector(limits.lower).cwiseQuotient(scale),
                 upper = eigen_vector(limits.upper).cwiseQuotient(scale);
  const Solutions y = solutions_of(J, scale, eigen_vector(f));
  // Bisect how far the limits have to be widened until some forces satisfy them.
  const double most = std::max((lower - y.particular).maxCoeff(), (y.particular - upper).maxCoeff());
  if (!(most > 0)) return {};
  const auto within = [&](double widening, VectorXd* multipliers = nullptr) {
    return nearest(y, lower.array() - widening, upper.array() + widening, multipliers);
  };
  const double sufficient = most - bisect(most, [&](double by) { return within(most - by).has_value(); });
  VectorXd v;
  constexpr double kBelow = 0.999;  // limits that are slightly too narrow have multipliers that are almost unique
  if (within(kBelow * sufficient, &v) || v.size() == 0) return {};
  // v is in the range of diag(scale) J, because it is normal to the null space of the transposed matrix.
  const VectorXd solution = scaled_jacobian(J, scale).colPivHouseholderQr().solve(v);
  AxisVector<double> c(J.cols());
  for (std::size_t j = 0; j < c.size(); ++j) c[j] = solution(static_cast<Index>(j));
  return c;
}

AxisMatrix<double> internal_forces(const AxisMatrix<double>& J) {
  const MatrixXd basis =
      solutions_of(J, VectorXd::Ones(static_cast<Index>(J.rows())), VectorXd::Zero(static_cast<Index>(J.cols()))).basis;
  AxisMatrix<double> columns(J.rows(), J.rows() - J.cols());
  for (Index k = 0; k < basis.cols(); ++k) {
    Index largest = 0;
    basis.col(k).cwiseAbs().maxCoeff(&largest);
    const double sign = basis(largest, k) < 0 ? -1 : 1;
    for (Index i = 0; i < basis.rows(); ++i)
      columns(static_cast<std::size_t>(i), static_cast<std::size_t>(k)) = sign * basis(i, k);
  }
  return columns;
}

}  // namespace pkm
