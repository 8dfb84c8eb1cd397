#include "engine/expression/vector3.hpp"

namespace pkm::expression {

Rotation rotation_about(std::size_t axis, const Term& sine, const Term& cosine) {
  const Term zero(sine.graph(), 0.0), one(sine.graph(), 1.0);
  Rotation R({one, zero, zero}, {zero, one, zero}, {zero, zero, one});
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  R[i][i] = R[j][j] = cosine;
  R[i][j] = -sine;
  R[j][i] = sine;
  return R;
}

Rotation rotation_about(const Vector3& axis, const Term& angle) {  // the matrix is cos I + (1 - cos) e e^T + sin [e]x
  const Term sine = sin(angle), cosine = cos(angle), rest = Term(angle.graph(), 1.0) - cosine;
  const Vector3 e = axis, s = axis * sine;
  const auto symmetric = [&](std::size_t i, std::size_t j) { return e[i] * e[j] * rest; };
  return {{symmetric(0, 0) + cosine, symmetric(0, 1) - s[2], symmetric(0, 2) + s[1]},
          {symmetric(1, 0) + s[2], symmetric(1, 1) + cosine, symmetric(1, 2) - s[0]},
          {symmetric(2, 0) - s[1], symmetric(2, 1) + s[0], symmetric(2, 2) + cosine}};
}

Rotation transpose(const Rotation& R) {
  const auto column = [&](std::size_t j) { return Vector3{R[0][j], R[1][j], R[2][j]}; };
  return {column(0), column(1), column(2)};
}

}  // namespace pkm::expression
