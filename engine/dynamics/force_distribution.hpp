// Forces of redundant drives: choice of one solution of J^T tau = f, which has infinitely many if there are more drives
// than coordinates.
//
// The solutions are tau_0 + N lambda, where N is an orthonormal basis of the internal forces, J^T N = 0. Without
// limits, the solution of least norm is J (J^T J)^-1 f. With limits of the forces (tensions of cables), the point of
// the polyhedron of allowed lambda that is nearest to 0 is found by least distance programming (Lawson, Hanson 1974,
// chapter 23), the minimum of the maximum by bisection, and the centre by Newton's method.
#pragma once

#include <optional>

#include "engine/math/small_matrix.hpp"

namespace pkm {

enum class ForceSharing {
  least_norm,     ///< minimum of the sum of the squared drive forces
  least_maximum,  ///< minimum of the largest magnitude of a drive force; among several, that of least norm
  centre          ///< maximum of the product of the distances of the drive forces from all limits (analytic centre)
};

struct DriveLimits {
  ForceSharing sharing = ForceSharing::least_norm;
  /// Force or torque by which the force of each drive is divided in least_norm and least_maximum, by joint [N, N m].
  AxisVector<double> scale;
  /// Lower and upper limits of the drive forces, by joint [N, N m]; infinite if there are none. A cable has -t_max and
  /// -t_min.
  AxisVector<double> lower, upper;
};

/// Limits for drives that can exert any force; the drives share a load by least norm.
DriveLimits no_drive_limits(std::size_t joints);

/// Drive forces tau with J^T tau = f, within the limits.
/// @param J  Jacobian, joints x coordinates; at least as many joints as coordinates
/// @return   std::nullopt if J does not have full rank, or if no forces within the limits balance f
std::optional<AxisVector<double>> distribute_forces(const AxisMatrix<double>& J, const AxisVector<double>& f,
                                                    const DriveLimits& limits);

/// A vector c with c^T J^T tau < c^T f for all tau within the limits (Farkas' lemma), which proves that no such tau
/// balances f; std::nullopt if there is none. Of several, c belongs to the limits that have to be widened most.
/// @param J  Jacobian, joints x coordinates, of full rank
std::optional<AxisVector<double>> separating_vector(const AxisMatrix<double>& J, const AxisVector<double>& f,
                                                    const DriveLimits& limits);

/// Orthonormal basis of the internal forces: drive forces that balance each other. The largest component of each column
/// is positive.
/// @param J  Jacobian, joints x coordinates, of full rank
/// @return   joints x (joints - coordinates)
AxisMatrix<double> internal_forces(const AxisMatrix<double>& J);

}  // namespace pkm
