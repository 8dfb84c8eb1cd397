// Singular values of small matrices, and their inverse condition number sigma_min / sigma_max.
//
// Two implementations. The one-sided Jacobi method (Hestenes) works for every size. Workspace analyses need the
// condition number at every sample. They use a closed form for 3 x 3 matrices, which is two to three times faster:
// sigma_1^2 is the largest eigenvalue of M M^T, (sigma_1 sigma_2)^2 is that of C C^T, where C is the cofactor matrix of
// M, and sigma_3 = |det M| / (sigma_1 sigma_2). Unlike the smallest eigenvalue of M M^T, this quotient keeps the
// leading digits of a small sigma_3. With the singular vectors u_i, v_i of M, the derivatives are
// d sigma_i = u_i^T dM v_i.
//
// References: Golub, Van Loan, "Matrix Computations", 4th ed., section 8.6 (one-sided Jacobi); Smith, "Eigenvalues of
// a symmetric 3 x 3 matrix", Comm. ACM 4 (1961), 168 (trigonometric solution).
#pragma once

#include <array>
#include <cmath>

#include "engine/math/dual.hpp"
#include "engine/math/scalar.hpp"

namespace pkm {

/// sigma_min / sigma_max of an N x N matrix, in [0, 1]; 0 if the matrix is singular or not finite.
/// One-sided Jacobi method: plane rotations of pairs of columns until all columns are orthogonal. Their lengths are
/// then the singular values, with high relative accuracy. S is double or a dual number.
/// @param m  columns, m[column][row]; overwritten
template <int N, class S>
S inverse_condition(S (&m)[N][N]) {
  constexpr int kMaxSweeps = 30;         // limit of the number of sweeps; 4 or 5 are enough in practice
  constexpr double kOrthogonal = 1e-15;  // columns with a smaller cosine between them count as orthogonal
  const auto dot = [&](int i, int j) {
    S sum = m[i][0] * m[j][0];
    for (int k = 1; k < N; ++k) sum += m[i][k] * m[j][k];
    return sum;
  };
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool rotated = false;
    for (int i = 0; i < N - 1; ++i)
      for (int j = i + 1; j < N; ++j) {
        const S aa = dot(i, i), bb = dot(j, j), ab = dot(i, j);
        const double scale = value_of(aa) * value_of(bb), product = value_of(ab) * value_of(ab);
        // Skips orthogonal columns, and columns whose product is NaN.
        if (!(product > kOrthogonal * kOrthogonal * scale)) continue;
        rotated = true;
        const S zeta = (bb - aa) / (ab * 2.0);
        const S root = sqrt(S(zeta * zeta + 1.0));
        const S t = value_of(zeta) >= 0 ? S(1.0 / (zeta + root)) : S(-1.0 / (root - zeta));
        const S c = S(1.0) / sqrt(S(t * t + 1.0)), s = c * t;
        for (int k = 0; k < N; ++k) {
          const S p = m[i][k], q = m[j][k];
          m[i][k] = c * p - s * q;
          m[j][k] = s * p + c * q;
        }
      }
    if (!rotated) break;
  }
  S smallest = dot(0, 0), largest = smallest;
  for (int i = 1; i < N; ++i) {
    const S length = dot(i, i);
    smallest = min(smallest, length);
    largest = max(largest, length);
  }
  const bool usable = value_of(smallest) > 0 && value_of(largest) < 1e300;
  return usable ? S(sqrt(S(smallest / largest))) : S(0.0);
}

/// A symmetric 3 x 3 matrix.
template <class S>
struct Symmetric3 {
  S xx, yy, zz, xy, yz, zx;
};

/// Rows of a 3 x 3 matrix.
template <class S>
using Rows3 = std::array<std::array<S, 3>, 3>;

/// Returns the symmetric matrix M M^T of a matrix M.
template <class S>
[[gnu::always_inline]] inline Symmetric3<S> gram(const Rows3<S>& m) {
  const auto dot = [&](std::size_t i, std::size_t j) {
    return S(m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2]);
  };
  return {dot(0, 0), dot(1, 1), dot(2, 2), dot(0, 1), dot(1, 2), dot(2, 0)};
}

/// cos(phi / 2) for 0 <= phi <= pi/3, given t = cos(3 phi / 2): the root r in [sqrt(3/4), 1] of 4 r^3 - 3 r = t, whose
/// derivative is at least 6 there. Two Halley iterations from a linear initial value with an error below 0.01 reach
/// rounding accuracy.
template <class S>
[[gnu::always_inline]] inline S cos_of_a_third(const S& t) {
  constexpr double kAtZero = 0.86602540378443864676;  // sqrt(3/4), the root for t = 0
  S r = t * (1 - kAtZero) + kAtZero;
  for (int step = 0; step < 2; ++step) {
    const S square = r * r, f = (square * 4.0 - 3.0) * r - t, df = square * 12.0 - 3.0;
    r = r - f * df / (df * df - f * r * 12.0);
  }
  return r;
}

/// Largest eigenvalue of a positive semidefinite matrix, accurate to a few ulp even if two eigenvalues (nearly)
/// coincide; NaN for the zero matrix. S is double or Lanes.
///
/// Trigonometric solution: with the mean m of the eigenvalues and p^2 = sum (lambda_i - m)^2 / 6, the largest
/// eigenvalue is m + 2 p cos(phi), where p^3 (cos 3 phi, sin 3 phi) = (det(A - m I) / 2, sqrt(D / 108)) and D is the
/// discriminant of the characteristic polynomial. The formula D = 4 (3 p^2)^3 - 27 det^2 would lose half of the digits
/// where eigenvalues coincide. D is therefore computed as the Gram determinant of I, A, A^2 (as vectors of their
/// elements), which the Cauchy-Binet formula turns into a sum of squares.
template <class S>
[[gnu::always_inline]] inline S largest_eigenvalue(const Symmetric3<S>& matrix) {
  const S trace = matrix.xx + matrix.yy + matrix.zz, scale = S(1.0) / trace;  // scaled to trace 1: no overflow
  const S third(1.0 / 3);
  const S x = matrix.xx * scale - third, y = matrix.yy * scale - third, z = matrix.zz * scale - third;
  const S f = matrix.xy * scale, g = matrix.yz * scale, h = matrix.zx * scale;
  // elements of the square of the shifted matrix
  const S ff = f * f, gg = g * g, hh = h * h;
  const S X = x * x + ff + hh, Y = y * y + ff + gg, Z = z * z + gg + hh;
  const S F = f * (x + y) + g * h, G = g * (y + z) + f * h, H = h * (z + x) + f * g;

  const S xy = x - y, yz = y - z, zx = z - x, XY = X - Y, YZ = Y - Z, ZX = Z - X;
  const auto square = [](const S& a) { return S(a * a); };
  const auto with_diagonal = [&](const S& e, const S& E) {
    return S(square(S(xy * E - XY * e)) + square(S(yz * E - YZ * e)) + square(S(zx * E - ZX * e)));
  };
  const S discriminant = square(S(xy * YZ - yz * XY)) +
                         (with_diagonal(f, F) + with_diagonal(g, G) + with_diagonal(h, H)) * 2.0 +
                         (square(S(f * G - g * F)) + square(S(g * H - h * G)) + square(S(h * F - f * H))) * 12.0;

  const S p = sqrt_or_zero(S((X + Y + Z) * (1.0 / 6)));
  const S cosine = (x * (y * z - gg) - f * (f * z - g * h) + h * (f * g - y * h)) * 0.5;  // p^3 cos(3 phi)
  const S sine_2 = discriminant * (1.0 / 108);                                            // p^6 sin(3 phi)^2
  const S cube = sqrt_or_zero(S(cosine * cosine + sine_2));                               // p^3
  // p^3 (1 + cos(3 phi))
  const S more = select(value_of(cosine) >= 0.0, S(cube + cosine), S(sine_2 / (cube - cosine)));
  const S r = cos_of_a_third(sqrt_or_zero(S(more / (cube * 2.0))));
  // p = 0: all three eigenvalues are equal
  return trace * (p * 2.0 * select(value_of(cube) > 0.0, S(r * r * 2.0 - 1.0), S(1.0)) + third);
}

/// Unit eigenvector v of the largest eigenvalue of a positive semidefinite matrix. The adjugate of (lambda I - matrix)
/// is a multiple of v v^T; v is its longest column, which is the most accurate one, normalised. The zero vector if the
/// eigenvalue is double to the last bit.
inline std::array<double, 3> eigenvector_of_largest(const Symmetric3<double>& matrix, double eigenvalue) {
  const double scale = 1 / eigenvalue;  // avoids overflow
  const double x = 1 - matrix.xx * scale, y = 1 - matrix.yy * scale, z = 1 - matrix.zz * scale;
  const double f = -matrix.xy * scale, g = -matrix.yz * scale, h = -matrix.zx * scale;
  const double X = y * z - g * g, Y = z * x - h * h, Z = x * y - f * f;
  const double F = g * h - f * z, G = h * f - g * x, H = f * g - h * y;
  std::array<double, 3> v = X >= Y && X >= Z ? std::array{X, F, H} : Y >= Z ? std::array{F, Y, G} : std::array{H, G, Z};
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const double inverse = square > 0 ? 1 / std::sqrt(square) : 0;
  for (double& component : v) component *= inverse;
  return v;
}

/// The extreme singular values of a 3 x 3 matrix M in closed form, with intermediate results. S is double or Lanes.
template <class S>
struct ExtremeSingularValues {
  Rows3<S> cofactors;
  S determinant;
  Symmetric3<S> square, square_of_cofactors;  ///< M M^T and C C^T, C: cofactors
  /// Sigma_1^2 and (sigma_1 sigma_2)^2, where sigma_1 >= sigma_2 are the largest singular values.
  S max_squared, leading_product_squared;
  [[gnu::always_inline]] S min_squared() const { return determinant * determinant / leading_product_squared; }
};
template <class S>
[[gnu::always_inline]] inline ExtremeSingularValues<S> extreme_singular_values(const Rows3<S>& m) {
  const auto cross = [](const std::array<S, 3>& a, const std::array<S, 3>& b) {
    return std::array<S, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  ExtremeSingularValues<S> s;
  s.cofactors = {cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
  s.determinant = m[0][0] * s.cofactors[0][0] + m[0][1] * s.cofactors[0][1] + m[0][2] * s.cofactors[0][2];
  s.square_of_cofactors = gram(s.cofactors);
  s.leading_product_squared = largest_eigenvalue(s.square_of_cofactors);
  s.square = gram(m);
  s.max_squared = largest_eigenvalue(s.square);
  return s;
}

/// Inverse condition number from the squares of the extreme singular values.
template <class S>
[[gnu::always_inline]] inline S inverse_condition_of(const S& min_squared, const S& max_squared) {
  const S index = select(max_squared < 1e300, S(sqrt(S(min_squared / max_squared))), S(0.0));
  return select(min_squared > 0.0, index, S(0.0));
}

/// Inverse condition number of a 3 x 3 matrix in closed form. S is double or Lanes. The relative error is a few ulp if
/// determinant and cofactors are computed without cancellation, otherwise a few ulp times sigma_1 / sigma_2.
/// @param extra  square of the singular value of a separate 1 x 1 diagonal block; < 0: there is no such block
template <class S>
[[gnu::always_inline]] inline S inverse_condition(const Rows3<S>& m, const S& extra = S(-1.0)) {
  const ExtremeSingularValues<S> s = extreme_singular_values(m);
  const S min_squared = s.min_squared(), max_squared = s.max_squared;
  const S smaller_2 = select(extra < min_squared, extra, min_squared),
          larger_2 = select(extra > max_squared, extra, max_squared);
  return inverse_condition_of(select(extra >= 0.0, smaller_2, min_squared),
                              select(extra >= 0.0, larger_2, max_squared));
}

/// Inverse condition number of a 3 x 3 matrix with derivatives. If an extreme singular value is double, it is not
/// differentiable; the derivatives are then those of one of the two, or finite but meaningless.
template <int N>
Dual<N> inverse_condition(const Rows3<Dual<N>>& m, const Dual<N>& extra = Dual<N>(-1.0)) {
  Rows3<double> plain;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) plain[i][j] = m[i][j].a;
  const ExtremeSingularValues<double> s = extreme_singular_values(plain);
  const bool extra_is_smallest = extra.a >= 0 && extra.a<s.min_squared(), extra_is_largest = extra.a> s.max_squared;
  Dual<N> result(
      inverse_condition_of(extra_is_smallest ? extra.a : s.min_squared(), extra_is_largest ? extra.a : s.max_squared));
  if (!(result.a > 0)) return result;
  // d ln(sigma_3 / sigma_1) = G : dM, with u_3^T C = det v_3^T / sigma_3 and u_1^T M = sigma_1 v_1^T
  Rows3<double> G{};
  const auto add = [&](const std::array<double, 3>& u, const Rows3<double>& rows, double factor) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double v = (u[0] * rows[0][j] + u[1] * rows[1][j] + u[2] * rows[2][j]) * factor;
      for (std::size_t i = 0; i < 3; ++i) G[i][j] += u[i] * v;
    }
  };
  if (!extra_is_smallest)
    add(eigenvector_of_largest(s.square_of_cofactors, s.leading_product_squared), s.cofactors, 1 / s.determinant);
  if (!extra_is_largest) add(eigenvector_of_largest(s.square, s.max_squared), plain, -1 / s.max_squared);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) result.v = result.v + m[i][j].v * (G[i][j] * result.a);
  if (extra_is_smallest != extra_is_largest)
    result.v = result.v + extra.v * ((extra_is_smallest ? 0.5 : -0.5) / extra.a * result.a);
  return result;
}

}  // namespace pkm
