// Small dense matrices over double or a scalar with derivatives, as used for the dynamics. Their size is a compile-time
// constant (Matrix) or a run-time value with a compile-time bound (MatrixUpTo). There are no heap allocations. Sums are
// accumulated in the order of the index, so that results are bit-identical for both types, all compilers and
// processors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <type_traits>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/math/scalar.hpp"

namespace pkm {

/// R x C matrix of fixed size, row-major. A vector has one column.
template <class S, std::size_t R, std::size_t C = 1>
struct Matrix {
  using Scalar = S;
  static constexpr std::size_t kRows = R, kColumns = C;
  static constexpr bool kFixed = true;

  std::array<S, R * C> m{};

  static constexpr std::size_t rows() { return R; }
  static constexpr std::size_t cols() { return C; }
  static constexpr std::size_t size() { return R * C; }
  S& operator()(std::size_t i, std::size_t j) { return m[i * C + j]; }
  const S& operator()(std::size_t i, std::size_t j) const { return m[i * C + j]; }
  S& operator[](std::size_t i) { return m[i]; }
  const S& operator[](std::size_t i) const { return m[i]; }
  auto begin() { return m.begin(); }
  auto end() { return m.end(); }
  auto begin() const { return m.begin(); }
  auto end() const { return m.end(); }

  static constexpr Matrix zero(std::size_t, std::size_t) { return {}; }
  static Matrix identity(std::size_t = R) {
    Matrix unit;
    for (std::size_t i = 0; i < R && i < C; ++i) unit(i, i) = S(1.0);
    return unit;
  }
};

template <class S, std::size_t N>
using Vector = Matrix<S, N, 1>;

/// A matrix or vector type of this file, or one with the same element access (such as Eigen's).
template <class M>
concept HasElements = requires(const M& m) {
  { m.rows() } -> std::convertible_to<std::size_t>;
  { m.cols() } -> std::convertible_to<std::size_t>;
  m(0, 0);
};

/// Matrix of at most R x C elements, stored row-major and contiguously.
template <class S, std::size_t R, std::size_t C = 1>
class MatrixUpTo {
 public:
  using Scalar = S;
  static constexpr std::size_t kRows = R, kColumns = C;
  static constexpr bool kFixed = false;

  MatrixUpTo() = default;
  explicit MatrixUpTo(std::size_t rows, std::size_t cols = 1) : rows_(rows), cols_(cols) {
    PKM_EXPECTS(rows <= R && cols <= C);
    for (std::size_t k = 0; k < size(); ++k) m_[k] = S{};
  }
  /// Makes a column vector of the given elements.
  MatrixUpTo(std::initializer_list<S> elements) : MatrixUpTo(elements.size()) {
    std::size_t k = 0;
    for (const S& element : elements) m_[k++] = element;
  }
  /// Conversion from another matrix type.
  template <HasElements M>
  requires(!std::same_as<std::remove_cvref_t<M>, MatrixUpTo>) MatrixUpTo(const M& other)
      : MatrixUpTo(static_cast<std::size_t>(other.rows()), static_cast<std::size_t>(other.cols())) {
    using Index = std::remove_cvref_t<decltype(other.rows())>;
    for (std::size_t i = 0; i < rows_; ++i)
      for (std::size_t j = 0; j < cols_; ++j) (*this)(i, j) = S(other(static_cast<Index>(i), static_cast<Index>(j)));
  }

  std::size_t rows() const { return rows_; }
  std::size_t cols() const { return cols_; }
  std::size_t size() const { return rows_ * cols_; }
  S& operator()(std::size_t i, std::size_t j) {
    PKM_EXPECTS(i < rows_ && j < cols_);
    return m_[i * cols_ + j];
  }
  const S& operator()(std::size_t i, std::size_t j) const {
    PKM_EXPECTS(i < rows_ && j < cols_);
    return m_[i * cols_ + j];
  }
  S& operator[](std::size_t i) {
    PKM_EXPECTS(i < size());
    return m_[i];
  }
  const S& operator[](std::size_t i) const {
    PKM_EXPECTS(i < size());
    return m_[i];
  }
  S* begin() { return m_.data(); }
  S* end() { return m_.data() + size(); }
  const S* begin() const { return m_.data(); }
  const S* end() const { return m_.data() + size(); }

  static MatrixUpTo zero(std::size_t rows, std::size_t cols) { return MatrixUpTo(rows, cols); }
  static MatrixUpTo identity(std::size_t n) {
    MatrixUpTo unit(n, n);
    for (std::size_t i = 0; i < n; ++i) unit(i, i) = S(1.0);
    return unit;
  }

 private:
  std::size_t rows_ = 0, cols_ = 0;
  std::array<S, R * C> m_;  // only the first size() elements are initialised
};

/// A matrix type of this file: Matrix or MatrixUpTo.
template <class M>
concept SmallMatrix = requires {
  typename M::Scalar;
  { M::kFixed } -> std::convertible_to<bool>;
};

/// Type of an R x C matrix if its size is fixed, otherwise of a matrix of at most R x C elements.
template <class S, std::size_t R, std::size_t C, bool fixed>
using MatrixOf = std::conditional_t<fixed, Matrix<S, R, C>, MatrixUpTo<S, R, C>>;

/// Equality of the sizes and of all elements.
template <SmallMatrix A, SmallMatrix B>
bool operator==(const A& a, const B& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && std::equal(a.begin(), a.end(), b.begin());
}

template <SmallMatrix A, SmallMatrix B>
A& operator+=(A& a, const B& b) {
  PKM_EXPECTS(a.rows() == b.rows() && a.cols() == b.cols());
  for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
  return a;
}
template <SmallMatrix A, SmallMatrix B>
A operator+(A a, const B& b) {
  return a += b;
}
template <SmallMatrix A, SmallMatrix B>
A operator-(A a, const B& b) {
  PKM_EXPECTS(a.rows() == b.rows() && a.cols() == b.cols());
  for (std::size_t k = 0; k < a.size(); ++k) a[k] = a[k] - b[k];
  return a;
}
template <SmallMatrix A>
A operator*(A a, const typename A::Scalar& factor) {
  for (auto& element : a) element = element * factor;
  return a;
}

template <SmallMatrix A, SmallMatrix B>
auto operator*(const A& a, const B& b) {
  constexpr bool fixed = A::kFixed && B::kFixed;
  static_assert(!fixed || A::kColumns == B::kRows);
  PKM_EXPECTS(a.cols() == b.rows());
  auto product = MatrixOf<typename A::Scalar, A::kRows, B::kColumns, fixed>::zero(a.rows(), b.cols());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t k = 0; k < a.cols(); ++k)
      for (std::size_t j = 0; j < b.cols(); ++j) product(i, j) += a(i, k) * b(k, j);
  return product;
}

template <SmallMatrix A>
auto transpose(const A& a) {
  auto t = MatrixOf<typename A::Scalar, A::kColumns, A::kRows, A::kFixed>::zero(a.cols(), a.rows());
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < a.cols(); ++j) t(j, i) = a(i, j);
  return t;
}

/// Conversion to a matrix of fixed size, which must be the size of `a`.
template <std::size_t R, std::size_t C = 1, SmallMatrix A>
Matrix<typename A::Scalar, R, C> fixed(const A& a) {
  PKM_EXPECTS(a.rows() == R && a.cols() == C);
  Matrix<typename A::Scalar, R, C> result;
  for (std::size_t k = 0; k < R * C; ++k) result[k] = a[k];
  return result;
}

template <SmallMatrix A, SmallMatrix B>
typename A::Scalar dot(const A& a, const B& b) {
  typename A::Scalar sum = a[0] * b[0];
  for (std::size_t i = 1; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

template <class S>
Vector<S, 3> cross(const Vector<S, 3>& a, const Vector<S, 3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Gaussian elimination with partial pivoting: transforms `a` to upper triangular form (elements below the diagonal are
/// not set to 0) and applies the same row operations to each b.
template <SmallMatrix A, SmallMatrix... B>
void eliminate(A& a, B&... b) {
  using S = typename A::Scalar;
  PKM_EXPECTS(a.rows() == a.cols() && ((a.rows() == b.rows()) && ...));
  const std::size_t n = a.rows();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(value_of(a(i, k))) > std::fabs(value_of(a(pivot, k)))) pivot = i;
    const auto exchange = [k, pivot](auto& m, std::size_t first) {
      for (std::size_t j = first; j < m.cols(); ++j) std::swap(m(k, j), m(pivot, j));
    };
    if (pivot != k) {
      exchange(a, k);
      (exchange(b, 0), ...);
    }
    const S inverse = S(1.0) / a(k, k);
    for (std::size_t i = k + 1; i < n; ++i) {
      const S factor = a(i, k) * inverse;
      const auto subtract_pivot_row = [&factor, i, k](auto& m, std::size_t first) {
        for (std::size_t j = first; j < m.cols(); ++j) m(i, j) = m(i, j) - factor * m(k, j);
      };
      subtract_pivot_row(a, k + 1);
      (subtract_pivot_row(b, 0), ...);
    }
  }
}

/// Back substitution: replaces b by the solution X of u X = b, where u is upper triangular; elements of u below the
/// diagonal are ignored.
template <SmallMatrix A, SmallMatrix B>
void substitute_back(const A& u, B& b) {
  const std::size_t n = u.rows();
  for (std::size_t k = n; k-- > 0;)
    for (std::size_t j = 0; j < b.cols(); ++j) {
      for (std::size_t i = k + 1; i < n; ++i) b(k, j) = b(k, j) - u(k, i) * b(i, j);
      b(k, j) = b(k, j) / u(k, k);
    }
}

/// The solution X of a X = b. Its elements are infinite or NaN if `a` is singular.
template <SmallMatrix A, SmallMatrix B>
B solve(A a, B b) {
  eliminate(a, b);
  substitute_back(a, b);
  return b;
}

/// Maximum number of coordinates of a pose, and of actuated joints.
inline constexpr std::size_t kMaxCoordinates = 6, kMaxJoints = 8;

/// Vector with one element per pose coordinate or per actuated joint, and matrix each of whose dimensions has one index
/// per pose coordinate or per actuated joint.
template <class S>
using AxisVector = MatrixUpTo<S, kMaxJoints>;
template <class S>
using AxisMatrix = MatrixUpTo<S, kMaxJoints, kMaxJoints>;

}  // namespace pkm
