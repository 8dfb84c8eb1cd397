// Performance indices of a pose: transmission of velocities and forces, accuracy, stiffness, natural frequency,
// effective mass, acceleration. All are formulas of the pose in the expression graph of the mechanism; limits,
// statistics, maps and derivatives treat them like any [[quantity]].
//
// J maps the rates x' of the coordinates to those of the joints, q' = J x'. T_v x' is the velocity of the origin of the
// platform's frame and T_w x' its angular velocity. Where J is singular, J^-1 = adj(J) / det(J) is infinite; quantities
// whose limit is 0 there are formed such that they are 0.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/expression/term_matrix.hpp"
#include "engine/generic/model.hpp"

namespace pkm::generic {

using expression::TermMatrix;
using limbs::Term;

/// A named quantity of the pose that a mechanism has even if its file does not contain a [[quantity]] for it.
struct NamedTerm {
  std::string name, unit, meaning;
  Term value;
};

/// Velocities of the joints and of the platform for unit rates of the coordinates: one column per coordinate.
struct FirstOrderKinematics {
  TermMatrix J;  ///< Jacobian of the inverse kinematics, q' = J x': one row per joint, one column per coordinate
  /// T_v (rates of the coordinates to velocity of the origin) without rows for directions in which the origin cannot
  /// move; at most three rows.
  TermMatrix translation;
  /// T_w (rates of the coordinates to angular velocity); if there are one or two rotations, whose axes are orthonormal,
  /// only the components along these axes.
  TermMatrix rotation;
  /// Inverse of J or, if there are more joints than coordinates, its pseudo-inverse (J^T J)^-1 J^T by least squares;
  /// std::nullopt if there are fewer joints.
  std::optional<expression::Inverse> inverse;
};
FirstOrderKinematics first_order_kinematics(Model& model);

/// `velocity_transmission` and `force_transmission`, and for rotations `angular_velocity_transmission` and
/// `moment_transmission`: minimum singular values of V = T J^-1, which maps joint rates to velocities of the platform,
/// and of its inverse, 1 / sigma_max(V). They are in the units of the joints, which have to be the same for all.
/// @param kinematics  must have an `inverse`
std::vector<NamedTerm> velocity_quantities(const Model& model, const FirstOrderKinematics& kinematics);

/// Bounds of the errors of the joint coordinates: errors of the joints themselves, plus errors of dimensions,
/// multiplied by their effect on the joint coordinate at this pose.
struct JointErrors {
  /// Worst case: sum of the magnitudes of all contributions to the error of a joint [m, rad]; by joint.
  std::vector<Term> bound;
  /// Sum of the squares of all contributions to the error of a joint, which is the variance if each contribution is a
  /// standard deviation; by joint.
  std::vector<Term> squared_spread;
};
/// `accuracy` and `accuracy_rms` [m] of the origin of the platform, `accuracy_angle` and `accuracy_angle_rms` [rad] of
/// its orientation, to first order: the error of the pose is J^-1 times the errors e of the joints.
///
/// The worst case is the maximum of |T J^-1 e| over |e_i| <= bound_i. Since the norm is convex, the maximum is at a
/// vertex of the box of errors: all 2^(n-1) pairs of vertices are compared.
/// @param kinematics  must have an `inverse`
std::vector<NamedTerm> accuracy_quantities(const FirstOrderKinematics& kinematics, const JointErrors& errors);

/// One limb as a spring. An internal force or torque of the limb deflects it by `compliance` times its value. `row` is
/// the power of a unit force or torque per unit rate of each coordinate (for a unit force f at the point B of the
/// platform: f . (dB/dx)), so that the stiffness matrix of the limb in the coordinates is row^T row / compliance.
struct LimbSpring {
  std::vector<Term> row;
  Term compliance;  ///< compliance [m/N], or [rad/(N m)] if `row` is a row of joint rates
};
/// `stiffness` [N/m]: the minimum over all directions of the force at the origin of the platform, divided by the
/// deflection in its direction; `rotational_stiffness` [N m/rad] for couples. The compliance is sum c_i a_i a_i^T,
/// where the columns a_i of A^-1 are the displacements of the platform if limb i alone is elastic. With more limbs than
/// coordinates it is (A^T diag(1 / c) A)^-1, for which all compliances have to be positive.
/// With `M_X`, the inertia by the coordinates, also `natural_frequency` [Hz], the lowest one: det(K - omega^2 M_X) = 0.
std::vector<NamedTerm> stiffness_quantities(const FirstOrderKinematics& kinematics,
                                            const std::vector<LimbSpring>& springs,
                                            const std::optional<TermMatrix>& M_X);

/// `effective_mass` [kg], the maximum over all directions of the mass that a force at the origin of the platform has to
/// accelerate, 1 / lambda_min(T_v M_X^-1 T_v^T), and `effective_mass_ratio`, its minimum divided by its maximum.
std::vector<NamedTerm> inertia_quantities(const FirstOrderKinematics& kinematics, const TermMatrix& M_X);

/// `acceleration` [m/s^2]: the acceleration of the platform's origin that the drives reach in every direction, from
/// rest and under gravity. The accelerations for |tau_i| <= peak_i are the zonotope of the vectors
/// w_i = peak_i T_v M_X^-1 J_i^T, moved by the weight; the result is the radius of the largest ball about 0 inside,
/// the minimum over its faces; it is negative where the drives cannot hold the weight.
/// @param peak  maximum force or torque of each drive, by joint
std::optional<NamedTerm> acceleration_quantity(const FirstOrderKinematics& kinematics, const TermMatrix& M_X,
                                               const std::vector<Term>& G_X, const std::vector<Term>& peak);

}  // namespace pkm::generic
