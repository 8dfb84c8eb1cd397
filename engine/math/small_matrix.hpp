// Matrices of a few rows and columns, for double and for a derivative scalar: what dynamics is written in.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/math/scalar.hpp"

namespace pkm {

/// R x C, by rows. A vector has one column.
template <class S, std::size_t R, std::size_t C = 1>
struct Matrix {
  std::array<S, R * C> m{};

  S& operator()(std::size_t i, std::size_t j) { return m[i * C + j]; }
  const S& operator()(std::size_t i, std::size_t j) const { return m[i * C + j]; }
  S& operator[](std::size_t i) { return m[i]; }
  const S& operator[](std::size_t i) const { return m[i]; }

  static Matrix identity() {
    Matrix unit;
    for (std::size_t i = 0; i < R && i < C; ++i) unit(i, i) = S(1.0);
    return unit;
  }
  Matrix& operator+=(const Matrix& other) {
    for (std::size_t k = 0; k < R * C; ++k) m[k] += other.m[k];
    return *this;
  }
  friend Matrix operator+(Matrix a, const Matrix& b) { return a += b; }
  friend Matrix operator-(Matrix a, const Matrix& b) {
    for (std::size_t k = 0; k < R * C; ++k) a.m[k] = a.m[k] - b.m[k];
    return a;
  }
  friend Matrix operator*(Matrix a, const S& factor) {
    for (S& element : a.m) element = element * factor;
    return a;
  }
};

template <class S, std::size_t N>
using Vector = Matrix<S, N, 1>;

template <class S, std::size_t R, std::size_t K, std::size_t C>
Matrix<S, R, C> operator*(const Matrix<S, R, K>& a, const Matrix<S, K, C>& b) {
  Matrix<S, R, C> product;
  for (std::size_t i = 0; i < R; ++i)
    for (std::size_t k = 0; k < K; ++k)
      for (std::size_t j = 0; j < C; ++j) product(i, j) += a(i, k) * b(k, j);
  return product;
}

template <class S, std::size_t R, std::size_t C>
Matrix<S, C, R> transpose(const Matrix<S, R, C>& a) {
  Matrix<S, C, R> t;
  for (std::size_t i = 0; i < R; ++i)
    for (std::size_t j = 0; j < C; ++j) t(j, i) = a(i, j);
  return t;
}

template <class S, std::size_t N>
S dot(const Vector<S, N>& a, const Vector<S, N>& b) {
  S sum = a[0] * b[0];
  for (std::size_t i = 1; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

template <class S>
Vector<S, 3> cross(const Vector<S, 3>& a, const Vector<S, 3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// X with a X = b, by elimination; the largest value of a column leads. Infinite or NaN where `a` is singular.
template <class S, std::size_t N, std::size_t C>
Matrix<S, N, C> solve(Matrix<S, N, N> a, Matrix<S, N, C> b) {
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t lead = k;
    for (std::size_t i = k + 1; i < N; ++i)
      if (std::fabs(value_of(a(i, k))) > std::fabs(value_of(a(lead, k)))) lead = i;
    if (lead != k) {
      for (std::size_t j = k; j < N; ++j) std::swap(a(k, j), a(lead, j));
      for (std::size_t j = 0; j < C; ++j) std::swap(b(k, j), b(lead, j));
    }
    const S inverse = S(1.0) / a(k, k);
    for (std::size_t i = k + 1; i < N; ++i) {
      const S factor = a(i, k) * inverse;
      for (std::size_t j = k + 1; j < N; ++j) a(i, j) = a(i, j) - factor * a(k, j);
      for (std::size_t j = 0; j < C; ++j) b(i, j) = b(i, j) - factor * b(k, j);
    }
  }
  for (std::size_t k = N; k-- > 0;)
    for (std::size_t j = 0; j < C; ++j) {
      for (std::size_t i = k + 1; i < N; ++i) b(k, j) = b(k, j) - a(k, i) * b(i, j);
      b(k, j) = b(k, j) / a(k, k);
    }
  return b;
}

}  // namespace pkm
