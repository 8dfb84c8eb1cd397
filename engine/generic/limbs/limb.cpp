#include "engine/generic/limbs/limb.hpp"

#include "engine/math/scalar.hpp"

namespace pkm::limbs {
namespace {

/// The vector v = B - A from the joint on the base to that on the platform; if the limb is restricted to a plane, its
/// projection onto this plane.
Vector3 projected(const Ends& ends) {
  const Vector3 v = ends.B - ends.A;
  return ends.across ? v - *ends.across * dot(v, *ends.across) : v;
}
/// Loop-closure function of a rod, (|v|^2 - length^2) / 2, where v is the vector between its ends. The factor 1/2 makes
/// v its gradient.
Term rod_closure(const Vector3& v, const Term& length) { return (dot(v, v) - length * length) * 0.5; }

}  // namespace

Limb telescope(const Ends& ends, const Term& q) {
  const Vector3 v = projected(ends);
  return {.joint = length(v), .constraints = {}, .closure = rod_closure(v, q), .C = ends.A, .S = ends.A};
}

Limb cable_over_pulley(const Ends& ends, const Vector3& e, const Term& radius, const Term& q) {
  const Vector3 v = ends.B - ends.A;
  const Term w = dot(v, e);
  const Vector3 normal = v - e * w;
  const Term distance = length(normal), u = distance - radius, square = u * u + w * w;
  const Term free = sqrt(square - radius * radius);
  const Term joint = free + radius * (Term(q.graph(), kPi) - atan2(w, u) - atan2(free, radius));
  // n is the unit vector from the pulley's centre to the point at which the cable leaves it.
  const Vector3 across = normal / distance, centre = ends.A + across * radius;
  const Vector3 n = across * ((radius * u - free * w) / square) + e * ((free * u + radius * w) / square);
  return {.joint = joint,
          .constraints = {{"is outside of the pulley", "m", sqrt(square) - radius}},
          .closure = joint - q,
          .C = centre + n * radius,
          .S = ends.A};
}

Limb slider_and_rod(const Ends& ends, const Vector3& e, const Term& rod, const Term& branch, const Term& q) {
  const Vector3 v = projected(ends);
  const Term s = dot(v, e);
  const Vector3 normal = v - e * s;
  const Term distance_2 = dot(normal, normal);
  const Term joint = s + branch * sqrt(rod * rod - distance_2);
  Limb limb = {.joint = joint,
               .constraints = {{"reaches", "m", rod - sqrt(distance_2)}},
               .closure = rod_closure(v - e * q, rod),
               .C = ends.A + e * joint,
               .S = ends.A + e * joint};
  if (!ends.across) limb.path = RodAndPath{false, v, e, e, rod, rod, branch};
  return limb;
}

Limb slider(const Ends& ends, const Vector3& e, const Term& q) {
  const Term s = dot(ends.B - ends.A, e);
  return {.joint = s, .constraints = {}, .closure = s - q, .C = ends.A + e * s, .S = ends.A + e * s};
}

Limb slider_and_links(const Ends& ends, const Vector3& e, const Vector3& axis, const Term& l_1, const Term& l_2,
                      const Term& branch, const Term& q) {
  const Vector3 v = ends.B - ends.A;
  const Term s = dot(v, e);
  const Vector3 normal = v - e * s;
  const Term distance_2 = dot(normal, normal), distance = sqrt(distance_2);
  // Position of the elbow: its component along the line between the outer ends of the two links, and its distance from
  // this line.
  const Term along = (distance_2 + l_1 * l_1 - l_2 * l_2) / (distance * 2.0);
  const Term beside = branch * sqrt(l_1 * l_1 - along * along);
  const Vector3 slide = ends.A + e * s, arm = (normal * along - cross(axis, normal) * beside) / distance;
  return {.joint = s,
          .constraints = {{"reaches", "m", l_1 + l_2 - distance}, {"unfolds", "m", distance - abs(l_1 - l_2)}},
          .closure = s - q,
          .C = slide + arm,
          .S = slide,
          .arm = Arm{arm, axis, normal - arm}};
}

Limb crank_and_rod(const Ends& ends, const Vector3& axis, const Vector3& zero, const Term& crank, const Term& rod,
                   const Term& branch, const std::optional<std::array<Term, 2>>& range, const Term& q) {
  const Vector3 v = projected(ends), beside = cross(axis, zero);
  const Term u = dot(v, zero), w = dot(v, beside);
  const Term h = sqrt(u * u + w * w), k = (dot(v, v) + crank * crank - rod * rod) / (crank * 2.0);
  const Term centre = range ? ((*range)[0] + (*range)[1]) * 0.5 : Term(q.graph(), 0.0);
  const Term angle = atan2(w, u) + branch * acos(k / h);
  const Term joint = centre + call(expression::angle_wrapping(), angle - centre);
  const auto arm = [&](const Term& at) { return zero * (crank * cos(at)) + beside * (crank * sin(at)); };
  // cosine and sine of the crank angle, both multiplied by h^2
  const Term root = branch * sqrt(h * h - k * k), cosine = u * k - w * root, sine = w * k + u * root;
  const Vector3 to_C = (zero * cosine + beside * sine) * (crank / (h * h));
  Limb limb = {.joint = joint,
               .constraints = {{"reaches", "m", h - k}, {"unfolds", "m", h + k}},
               .closure = rod_closure(v - arm(q), rod),
               .C = ends.A + arm(joint),
               .S = ends.A,
               .arm = Arm{to_C, axis, v - to_C}};
  if (!ends.across) limb.path = RodAndPath{true, v, axis, zero, crank, rod, branch};
  if (dot(v, axis).is(0)) {
    const Term longest = crank + rod, shortest = crank - rod;
    limb.annulus = Annulus{longest * longest - dot(v, v), dot(v, v) - shortest * shortest};
  }
  if (!range) return limb;
  const Term pi(q.graph(), kPi);
  const Term from = call(expression::operation("max"), (*range)[0], centre - pi);
  const Term to = call(expression::operation("min"), (*range)[1], centre + pi);
  limb.crank_range = CrankRange{.at_min = rod_closure(v - arm(from), rod),
                                .at_max = rod_closure(v - arm(to), rod),
                                .after_min = cos(from) * w - sin(from) * u,
                                .before_max = sin(to) * u - cos(to) * w,
                                .half_turn = pi - (to - from),
                                .reach = u * u + w * w - k * k,
                                .branch = branch};
  return limb;
}

}  // namespace pkm::limbs
