// Inverse kinematics of limbs with one drive, in closed form: the joint coordinate for a position of the platform's
// joint, the constraints under which the limb assembles, and the loop-closure equation.
//
// A is the joint on the base, B the joint on the platform, v = B - A. If Ends::across is given, the limb moves in a
// plane normal to it, and v is projected onto this plane. All results are nodes of an expression graph, from which
// numbers, derivatives, SIMD batches and intervals are computed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/expression/vector3.hpp"

namespace pkm::limbs {

using expression::length, expression::rotation_about;
using expression::Rotation, expression::Term, expression::Vector3;

/// A constraint: satisfied if `margin` >= 0.
struct Constraint {
  std::string name;  ///< name of the constraint, such as "reaches"
  std::string unit;
  Term margin;
};

/// The range [q_min, q_max] of a crank's angle as constraints on B, without inverse trigonometric functions, for
/// workspace analyses.
///
/// The crank angles that assemble are phi - acos(k / h) and phi + acos(k / h), phi = atan2(w, u) (see crank_and_rod()).
/// The loop-closure function f(q) = (|v - crank(q)|^2 - rod^2) / 2 is <= 0 between them and > 0 elsewhere. For a range
/// of less than one revolution:
/// - exactly one of the angles is in the range if f has different signs at its two ends; the sign of f at q_min
///   determines which one it is;
/// - both are in the range if the limb reaches B, and either f >= 0 at both ends and phi is in the range, or f <= 0 at
///   both ends and phi + pi is in the range.
struct CrankRange {
  Term at_min, at_max;  ///< values of the loop-closure function f at q_min and at q_max
  /// >= 0 if the angle phi is at most half a revolution after q_min, and at most half a revolution before q_max,
  /// respectively.
  Term after_min, before_max;
  Term half_turn;  ///< >= 0: the range is at most half a revolution
  Term reach;      ///< h^2 - k^2, >= 0 if the limb reaches B
  Term branch;
};

/// A link of constant length that rotates about a pivot, with the rod from its end C to B. The rate of the vector `arm`
/// is computed without the joint angle: arm' = q' axis x arm, where q' = rod . B' / rod . (axis x arm). The pivot may
/// move, but only along the axis.
struct Arm {
  Vector3 arm;        ///< vector from the pivot to C, by formulas that contain square roots but no angles
  Vector3 axis, rod;  ///< axis: unit vector along the axis of rotation; rod: vector from the end C of the link to B
};

/// The annulus |crank - rod| <= |v| <= crank + rod that a planar crank and rod reach, as two quadratic constraints
/// >= 0. The equivalent constraints "reaches" and "unfolds" contain a root, and their squares have degree four.
using Annulus = std::array<Term, 2>;

/// A rod of constant length in space whose other end E moves along a line or circle:
/// E = A + q axis, or E = A + crank (cos q zero + sin q axis x zero).
struct RodAndPath {
  bool is_circle;
  /// v: from the joint A on the base to the joint B on the platform; axis: unit vector of the line or circle; zero:
  /// direction of the crank at q = 0 (circle only).
  Vector3 v, axis, zero;
  Term crank, rod, branch;
};

/// The inverse kinematics of a limb in closed form.
struct Limb {
  Term joint;                           ///< the joint coordinate; undefined if one of `constraints` is violated
  std::vector<Constraint> constraints;  ///< constraints under which the limb assembles
  /// Residual of the loop-closure equation, closure = 0. With Jq = -d closure/dq and G = d closure/dX, the velocities
  /// satisfy Jq qdot = G Xdot.
  Term closure;
  Vector3 C;  ///< inner end of the rod: end of the crank, elbow or slide; A for a telescope; the point at which a cable
              ///< leaves its pulley
  Vector3 S;  ///< position of the slide; A for cranks and telescopes
  std::optional<CrankRange> crank_range{};
  std::optional<Arm> arm{};
  /// For a planar crank with a rod: quadratic constraints that are equivalent to `constraints`.
  std::optional<Annulus> annulus{};
  std::optional<RodAndPath> path{};  ///< set for a rod with ball joints if Ends::across is not given
};

/// The positions A of the limb's joint on the base and B of its joint on the platform.
struct Ends {
  Vector3 A, B;
  /// Unit vector to which rod and crank stay normal; std::nullopt: the limb is not restricted to a plane.
  std::optional<Vector3> across;
};

// In the following functions, the argument q is the joint coordinate as a variable of the loop-closure equation; the
// formula q = .. in the comment becomes Limb::joint. v is the vector from the joint on the base to that on the
// platform.

/// Telescope: q = |v|, where v is the vector from the joint on the base to that on the platform.
Limb telescope(const Ends& ends, const Term& q);
/// Cable over a pulley (Pott, "Cable-Driven Parallel Robots", Springer, 2018, section 7.1): q = free + radius wrap. The
/// cable reaches the pulley at A in the direction e. The pulley swivels about the line through A along e until B is in
/// its plane. In this plane, u and w are the components of B - M normal to e and along e, where M is the pulley's
/// centre, free = sqrt(u^2 + w^2 - radius^2) is the length of the cable from the pulley to B, and wrap = pi - atan2(w,
/// u) - atan2(free, radius) is the angle of the arc.
/// @param e  unit vector
Limb cable_over_pulley(const Ends& ends, const Vector3& e, const Term& radius, const Term& q);
/// Slide and rod: q = s + branch sqrt(rod^2 - (|v|^2 - s^2)), where s = v . e and v is the vector from the joint on the
/// base to that on the platform.
/// @param e  unit vector along the rail
Limb slider_and_rod(const Ends& ends, const Vector3& e, const Term& rod, const Term& branch, const Term& q);
/// Slide without a rod: q = v . e, where v is the vector from the joint on the base to that on the platform, which
/// moves along with the slide.
/// @param e  unit vector along the rail
Limb slider(const Ends& ends, const Vector3& e, const Term& q);
/// Slide and two links that move in the plane normal to e: q = v . e, where v is the vector from the joint on the base
/// to that on the platform.
/// @param axis    unit vector e or -e, about which the angle of the links is counted
/// @param branch  sign of the angle from the first link to the second one about `axis`
Limb slider_and_links(const Ends& ends, const Vector3& e, const Vector3& axis, const Term& l_1, const Term& l_2,
                      const Term& branch, const Term& q);
/// Crank and rod: q = atan2(w, u) + branch acos(k / h), where v is the vector from the joint on the base to that on the
/// platform, u = v . zero, w = v . (axis x zero), h = hypot(u, w) and k = (|v|^2 + crank^2 - rod^2) / (2 crank). The
/// angle is wrapped to the revolution about the centre of the range, or about 0 if there is no range.
/// @param axis, zero  orthogonal unit vectors: axis of rotation, direction of the crank at q = 0
/// @param range       minimum and maximum angle [rad]
Limb crank_and_rod(const Ends& ends, const Vector3& axis, const Vector3& zero, const Term& crank, const Term& rod,
                   const Term& branch, const std::optional<std::array<Term, 2>>& range, const Term& q);

}  // namespace pkm::limbs
