// Newton's method for a system of equations (implicit_system.hpp), and the LU factors of its Jacobian.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/expression/implicit_system.hpp"

namespace pkm::expression {

/// LU factors of a Jacobian, with partial pivoting.
struct ImplicitSystem::Factors {
  std::size_t n;
  std::array<Vector, kMaxUnknowns> a;
  std::array<std::size_t, kMaxUnknowns> row;
  bool is_negative;  ///< sign of the determinant

  /// Factors the Jacobian of a linearisation. @return false if it is singular or not finite
  template <class Element>
  bool factor(const Element& element) {
    is_negative = false;
    for (std::size_t i = 0; i < n; ++i) {
      row[i] = i;
      for (std::size_t j = 0; j < n; ++j) a[i][j] = element(i, j);
    }
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
      if (pivot != k) {
        std::swap(a[pivot], a[k]);
        std::swap(row[pivot], row[k]);
        is_negative = !is_negative;
      }
      if (!(std::fabs(a[k][k]) > 0 && std::isfinite(a[k][k]))) return false;
      if (a[k][k] < 0) is_negative = !is_negative;
      for (std::size_t i = k + 1; i < n; ++i) {
        const double factor = a[i][k] /= a[k][k];
        for (std::size_t j = k + 1; j < n; ++j) a[i][j] -= factor * a[k][j];
      }
    }
    return true;
  }
  /// J^-1 b
  Vector solve(const Vector& b) const {
    Vector x{};
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = b[row[i]];
      for (std::size_t j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t j = i + 1; j < n; ++j) x[i] -= a[i][j] * x[j];
      x[i] /= a[i][i];
    }
    return x;
  }
  /// J^-T b
  Vector solve_transposed(Vector b) const {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) b[i] -= a[j][i] * b[j];
      b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t j = i + 1; j < n; ++j) b[i] -= a[j][i] * b[j];
    Vector x{};
    for (std::size_t i = 0; i < n; ++i) x[row[i]] = b[i];
    return x;
  }
};

/// The linearised equations at a point, and Newton's method.
class ImplicitSystem::Newton {
 public:
  static constexpr double kMinDamping = 1.0 / 64;  ///< minimum damping factor; a step with it is always carried out

  /// @param coefficients  their values
  /// @param scratch       memory with system.scratch_size() elements, which belongs to this object
  Newton(const ImplicitSystem& system, std::span<const double> coefficients, std::span<double> scratch)
      : system_(system),
        registers_(scratch.first(system.linearisation_.registers())),
        inputs_(scratch.subspan(registers_.size(), system.operands())) {
    factors.n = system.unknowns();
    std::ranges::fill(inputs_.first(factors.n), 0.0);
    std::ranges::copy(coefficients, inputs_.begin() + static_cast<std::ptrdiff_t>(factors.n));
    system.linearisation_.start<double>(registers_);
    system.linearisation_.run<double>(0, inputs_, registers_);
  }

  Factors factors;  ///< LU factors of the Jacobian at the point of the last successful call of factor()
  std::span<const double> registers() const { return registers_; }

  /// Evaluates the equations and their Jacobian at a point. @return the values of the equations
  Vector evaluate(const Vector& u) {
    std::copy_n(u.begin(), factors.n, inputs_.begin());
    system_.linearisation_.run<double>(1, inputs_, registers_);
    Vector f{};
    for (std::size_t i = 0; i < factors.n; ++i) f[i] = registers_[system_.linearisation_.outputs()[i]];
    return f;
  }
  /// Factors the Jacobian at the point of the last call of evaluate().
  bool factor() {
    const std::size_t n = factors.n;
    return factors.factor(
        [&](std::size_t i, std::size_t j) { return registers_[system_.linearisation_.outputs()[n + i * n + j]]; });
  }
  /// Newton's method from a start. @return false if it does not converge, or converges to another branch
  bool solve(Vector& u);

 private:
  Vector moved(Vector u, const Vector& change, double damping) const {
    for (std::size_t i = 0; i < factors.n; ++i) u[i] -= damping * change[i];
    return u;
  }
  /// Maximum norm of a change of the unknowns u, in which component i is divided by |u_i| if |u_i| > 1 [m, rad]; NaN if
  /// a component is NaN.
  double norm(const Vector& change, const Vector& u) const {
    double largest = 0;
    for (std::size_t i = 0; i < factors.n; ++i) {
      const double size = std::fabs(change[i]) / std::max(1.0, std::fabs(u[i]));
      if (!(size <= largest)) largest = size;
      if (size != size) break;
    }
    return largest;
  }

  const ImplicitSystem& system_;
  std::span<double> registers_, inputs_;  ///< parts of the scratch memory
};

}  // namespace pkm::expression
