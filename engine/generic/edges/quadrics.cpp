#include "engine/generic/edges/quadrics.hpp"

namespace pkm::generic::edges {
namespace {

/// The symmetric matrix A of a quadric f(p) = k + b . p + p . A p.
Matrix<double, 3, 3> matrix_of(QuadricCoefficients f) {
  return {{f[4], 0.5 * f[7], 0.5 * f[8], 0.5 * f[7], f[5], 0.5 * f[9], 0.5 * f[8], 0.5 * f[9], f[6]}};
}
Vector3 linear_part(QuadricCoefficients f) { return {{f[1], f[2], f[3]}}; }
/// The factor in the matrix A of a sphere, A = factor I, or of a cylinder, A = factor (I - axis axis^T): its multiple
/// nonzero eigenvalue.
double factor_of(QuadricCoefficients f, Body::Kind kind) {
  return (f[4] + f[5] + f[6]) / (kind == Body::Kind::sphere ? 3 : 2);
}

/// Finds the axis of the cylinder with the matrix A. @return false if A is not the matrix of a cylinder
bool find_axis(const Matrix<double, 3, 3>& A, double factor, Vector3& axis) {
  // The matrix axis axis^T, provided that A is the matrix of a cylinder.
  Matrix<double, 3, 3> square = Matrix<double, 3, 3>::identity() - A * (1 / factor);
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (square(i, i) > square(largest, largest)) largest = i;
  if (!(square(largest, largest) > 0.1)) return false;
  for (std::size_t i = 0; i < 3; ++i) axis[i] = square(i, largest) / std::sqrt(square(largest, largest));
  constexpr double kRounding = 1e-11;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (std::fabs(square(i, j) - axis[i] * axis[j]) > kRounding) return false;
  axis = axis * (1 / norm(axis));
  return true;
}

}  // namespace

QuadricKind classify(QuadricCoefficients f, double bound, Body& body) {
  constexpr double kRounding = 1e-14, kEqual = 1e-11;
  const Matrix<double, 3, 3> A = matrix_of(f);
  const Vector3 b = linear_part(f);
  double size = 0;
  for (const double a : A) size = std::max(size, std::fabs(a));
  if (!std::isfinite(size + norm(b) + f[0])) return QuadricKind::other;
  if (size * bound <= kRounding * norm(b) || size * bound * bound <= kRounding * std::fabs(f[0])) {
    const double length = norm(b);
    if (length * bound <= kRounding * std::fabs(f[0]) || length == 0)
      return f[0] >= 0 ? QuadricKind::satisfied : QuadricKind::violated;
    body = {.kind = Body::Kind::plane, .axis = b * (-1 / length), .radius = f[0] / length};
    return QuadricKind::body;
  }
  body = {.kind = Body::Kind::sphere};
  double factor = factor_of(f, body.kind);
  const Matrix<double, 3, 3> difference = A - Matrix<double, 3, 3>::identity() * factor;
  for (const double each : difference)
    if (std::fabs(each) > kEqual * size) body.kind = Body::Kind::cylinder;
  if (body.kind == Body::Kind::cylinder) {
    factor = factor_of(f, body.kind);
    if (factor == 0 || !find_axis(A, factor, body.axis) || std::fabs(dot(b, body.axis)) > kEqual * norm(b))
      return QuadricKind::other;
  }
  body.centre = b * (-0.5 / factor);
  body.side = factor < 0 ? 1 : -1;
  const double square = dot(body.centre, body.centre) - f[0] / factor;
  if (square <= kRounding * (bound * bound + dot(body.centre, body.centre)))
    return body.side < 0 ? QuadricKind::satisfied : QuadricKind::violated;
  body.radius = std::sqrt(square);
  return QuadricKind::body;
}

std::array<double, 10> by_coefficients(QuadricCoefficients f, const Body& body, const Body& by) {
  std::array<double, 10> result{};
  const Vector3 b = linear_part(f);
  if (body.kind == Body::Kind::plane) {
    const double length = norm(b);
    // For the plane f = f_0 + b . p: derivatives with respect to b, multiplied by the length of b.
    const Vector3 along = body.axis * (dot(body.axis, by.axis) + by.radius * body.radius) - by.axis;
    result[0] = by.radius / length;
    for (std::size_t i = 0; i < 3; ++i) result[1 + i] = along[i] / length;
    return result;
  }
  // Use centre = -b / (2 factor) and radius^2 = |centre|^2 - f_0 / factor.
  const double factor = factor_of(f, body.kind), by_square = by.radius / (2 * body.radius);
  const Vector3 by_centre = by.centre + body.centre * (2 * by_square);
  result[0] = -by_square / factor;
  for (std::size_t i = 0; i < 3; ++i) result[1 + i] = -0.5 * by_centre[i] / factor;
  const double by_factor = (0.5 * dot(by_centre, b) + by_square * f[0]) / (factor * factor);
  const double share = body.kind == Body::Kind::sphere ? 1.0 / 3 : 0.5;
  const Vector3 turn = by.axis * (-1 / factor);  // a change dA of the matrix changes the axis by -dA axis / factor
  const Vector3& a = body.axis;
  for (std::size_t i = 0; i < 3; ++i) result[4 + i] = share * by_factor + turn[i] * a[i];
  result[7] = 0.5 * (turn[0] * a[1] + turn[1] * a[0]);
  result[8] = 0.5 * (turn[0] * a[2] + turn[2] * a[0]);
  result[9] = 0.5 * (turn[1] * a[2] + turn[2] * a[1]);
  return result;
}

}  // namespace pkm::generic::edges
