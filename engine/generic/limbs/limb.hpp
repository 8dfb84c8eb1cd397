// Limbs with one drive, in closed form: the joint for a place of the platform's point, what can keep the limb from
// reaching it, and its closure.
//
// A is the base point, B the platform's point, v = B - A; lengths in planes normal to `across`, where it is given.
// Every function states its joint over a graph, so that numbers, derivatives and lanes come from one statement.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/generic/limbs/vector3.hpp"

namespace pkm::limbs {

/// >= 0 where it holds.
struct Condition {
  std::string reason;  ///< "reaches"
  std::string unit;
  Term margin;
};

/// Where a crank's range ends, as surfaces that the platform's point passes: what a survey needs of the range without
/// the angle. The closure f(q) = |v - crank(q)|^2 - rod^2 is <= 0 between the two angles phi -+ acos(k / h) that
/// assemble, phi = atan2(w, u). So one of them is in [q_min, q_max], which is less than a turn, where f changes its
/// sign in that direction between the ends; and both are, where the limb reaches, if f >= 0 at both ends and phi is in
/// the range, or f <= 0 at both ends and phi + pi is.
struct CrankRange {
  Term at_min, at_max;         ///< f at the ends
  Term after_min, before_max;  ///< (u, w) is at most half a turn after q_min, before q_max
  Term half_turn;              ///< >= 0: the range is at most half a turn
  Term reach;                  ///< h^2 - k^2
  Term branch;
};

/// A link of constant length that turns about a pivot, and the rod from its end to B: rates follow from them without
/// angles, arm' = turn' axis x arm with turn' = rod . B' / rod . (axis x arm). The pivot moves along the axis at most.
struct Arm {
  Vector3 arm;        ///< from the pivot to C, by roots alone
  Vector3 axis, rod;  ///< axis: unit vector
};

/// What a crank and a rod in one plane reach, |crank - rod| <= |v| <= crank + rod, as surfaces that are >= 0: of degree
/// two, where h - k is a root and its square of degree four.
using Folds = std::array<Term, 2>;

struct Limb {
  Term joint;                         ///< undefined where a condition is < 0
  std::vector<Condition> conditions;  ///< for it to assemble
  /// Zero where the joint variable belongs to the pose: Jq qdot = G Xdot with Jq = -d/dq, G = d/dX.
  Term closure;
  Vector3 C;  ///< where the rod begins: the crank's end, the elbow, the slide; of a telescope A
  Vector3 S;  ///< the slide; of cranks and telescopes A
  std::optional<CrankRange> crank_range{};
  std::optional<Arm> arm{};
  std::optional<Folds> folds{};  ///< what all conditions of a crank in a plane are together
};

/// The ends of a limb.
struct Ends {
  Vector3 A, B;
  std::optional<Vector3> across;  ///< unit vector: rod and crank stay normal to it
};

/// q = |v|. @param q  the joint variable, for the closure
Limb telescope(const Ends& ends, const Term& q);
/// q = s + branch sqrt(rod^2 - (|v|^2 - s^2)), s = v . e, e a unit vector.
Limb slider_and_rod(const Ends& ends, const Vector3& e, const Term& rod, const Term& branch, const Term& q);
/// q = v . e: the platform's point follows the rail.
Limb slider(const Ends& ends, const Vector3& e, const Term& q);
/// q = v . e, and two links in the plane normal to e; branch is the sign of the second one's angle with the first about
/// `axis`, which is e or -e.
Limb slider_and_links(const Ends& ends, const Vector3& e, const Vector3& axis, const Term& l_1, const Term& l_2,
                      const Term& branch, const Term& q);
/// q = atan2(w, u) + branch acos(k / h) with u = v . zero, w = v . (axis x zero), h = hypot(u, w) and
/// k = (|v|^2 + crank^2 - rod^2) / (2 crank), in the turn nearest to the range's middle, or to 0. axis and zero are
/// unit vectors.
Limb crank_and_rod(const Ends& ends, const Vector3& axis, const Vector3& zero, const Term& crank, const Term& rod,
                   const Term& branch, const std::optional<std::array<Term, 2>>& range, const Term& q);

}  // namespace pkm::limbs
