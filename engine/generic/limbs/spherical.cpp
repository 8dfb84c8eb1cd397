#include "engine/generic/limbs/spherical.hpp"

namespace pkm::limbs {

SphericalChain spherical_chain(const Vector3& u, const Vector3& v, const Vector3& zero, const Vector3& reference,
                               const std::array<Term, 2>& alpha, const Term& branch, const Term& q) {
  const Term c_1 = cos(alpha[0]), s_1 = sin(alpha[0]), c_2 = cos(alpha[1]), s_2 = sin(alpha[1]);
  const Vector3 beside = cross(u, zero);
  const auto middle = [&](const Term& cosine, const Term& sine) {
    return u * c_1 + (zero * cosine + beside * sine) * s_1;
  };
  // The condition w . v = cos(alpha_2) has the form A cos q + B sin q = C.
  const Term A = s_1 * dot(zero, v), B = s_1 * dot(beside, v), C = c_2 - c_1 * dot(u, v);
  const Term h = sqrt(A * A + B * B), root = branch * sqrt(h * h - C * C);
  const Vector3 w = middle((A * C - B * root) / (h * h), (B * C + A * root) / (h * h));
  const Vector3 n_1 = cross(u, w), n_2 = cross(w, v);
  const std::array<Term, 3> angles = {atan2(B, A) + branch * acos(C / h), atan2(dot(w, cross(n_1, n_2)), dot(n_1, n_2)),
                                      atan2(dot(v, cross(n_2, reference)), dot(n_2, reference))};
  // `normal`: normal of the second link if q is the angle of the last joint
  const Vector3 across = reference - v * dot(v, reference), r = across / length(across);
  const Vector3 normal = r * cos(q) - cross(v, r) * sin(q);
  const std::array<Term, 3> closures = {dot(middle(cos(q), sin(q)), v) - c_2,
                                        dot(u, v) - c_1 * c_2 + s_1 * s_2 * cos(q),
                                        dot(u, v * c_2 + cross(v, normal) * s_2) - c_1};
  return {w, angles, {{"reaches", "1", h - C}, {"unfolds", "1", h + C}}, closures};
}

}  // namespace pkm::limbs
