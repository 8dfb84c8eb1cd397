// Three-dimensional vectors and rotation matrices whose elements are nodes of an expression graph.
#pragma once

#include <array>

#include "engine/expression/graph.hpp"

namespace pkm::expression {

struct Vector3 : std::array<Term, 3> {
  Vector3(const Term& x, const Term& y, const Term& z) : std::array<Term, 3>{{x, y, z}} {}
};
struct Rotation : std::array<Vector3, 3> {
  /// @param x, y, z  the rows of the rotation matrix
  Rotation(const Vector3& x, const Vector3& y, const Vector3& z) : std::array<Vector3, 3>{{x, y, z}} {}
};

inline Vector3 operator+(const Vector3& x, const Vector3& y) { return {x[0] + y[0], x[1] + y[1], x[2] + y[2]}; }
inline Vector3 operator-(const Vector3& x, const Vector3& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
inline Vector3 operator*(const Vector3& x, const Term& factor) { return {x[0] * factor, x[1] * factor, x[2] * factor}; }
inline Vector3 operator/(const Vector3& x, const Term& divisor) {
  return {x[0] / divisor, x[1] / divisor, x[2] / divisor};
}
inline Term dot(const Vector3& x, const Vector3& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
inline Vector3 cross(const Vector3& x, const Vector3& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
inline Term length(const Vector3& x) { return sqrt(dot(x, x)); }
inline Vector3 operator*(const Rotation& R, const Vector3& x) { return {dot(R[0], x), dot(R[1], x), dot(R[2], x)}; }
inline Rotation operator*(const Rotation& A, const Rotation& B) {
  const Vector3 columns[3] = {{B[0][0], B[1][0], B[2][0]}, {B[0][1], B[1][1], B[2][1]}, {B[0][2], B[1][2], B[2][2]}};
  const auto row = [&](const Vector3& a) {
    return Vector3{dot(a, columns[0]), dot(a, columns[1]), dot(a, columns[2])};
  };
  return {row(A[0]), row(A[1]), row(A[2])};
}

/// Rotation about a coordinate axis by an angle with this sine and cosine.
/// @param axis  index of the coordinate axis, 0 to 2
Rotation rotation_about(std::size_t axis, const Term& sine, const Term& cosine);
/// Rotation about a unit vector by an angle (Rodrigues' formula).
Rotation rotation_about(const Vector3& axis, const Term& angle);
Rotation transpose(const Rotation& R);

}  // namespace pkm::expression
