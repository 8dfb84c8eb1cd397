// State and forces of the joints at a point of a path, as functions of the squared path speed y = sdot^2 and of the
// path acceleration u = sddot:
//
//   qdot = q' sqrt(y),   qddot = q' u + q'' y,   tau = A u + B y + C
//
// q' and q'' are derivatives by the path parameter; A = J^-T M_X X', B = J^-T (M_X X'' + h_X(X')), C = J^-T (G_X -
// W_X). A motion with its own time law is the special case s = t: y = 1 and u = 0; slowed down by the factor k: y =
// 1/k^2.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "engine/mechanism/inverse_dynamics.hpp"

namespace pkm {

template <class S>
struct PathPoint {
  AxisVector<S> q1, q2;  ///< first and second derivative of each joint coordinate with respect to the path parameter
  /// Coefficients of the joint forces tau = A u + B y + C for the path acceleration u and the squared path speed y,
  /// including the reflected inertia of drive trains; empty if the mechanism has no masses.
  AxisVector<S> A, B, C;
  /// X'.X', X'.X'' and X''.X'', where X' and X'' are the derivatives of the pose with respect to the path parameter,
  /// for coordinates that are lengths only.
  double tool11 = 0, tool12 = 0, tool22 = 0;
};

/// Converts a path point to another scalar type, with zero derivatives.
template <class T>
PathPoint<T> constant_point(const PathPoint<double>& p) {
  const auto convert = [](const AxisVector<double>& x) {
    AxisVector<T> y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) y[i] = T(x[i]);
    return y;
  };
  return {convert(p.q1), convert(p.q2), convert(p.A), convert(p.B), convert(p.C), p.tool11, p.tool12, p.tool22};
}

/// Torque of a joint's motor at a point of the path [N m].
/// @param p  a point whose force coefficients A, B, C are computed
template <class S>
S motor_torque(const PathPoint<S>& p, std::size_t joint, const S& y, const S& u, const DriveTrain& train) {
  const S speed = p.q1[joint] * sqrt_or_zero(y), acceleration = p.q1[joint] * u + p.q2[joint] * y;
  const S force = p.A[joint] * u + p.B[joint] * y + p.C[joint];
  return train.torque(S(force - acceleration * train.reflected()), speed, acceleration);
}

/// Computes the points of a path up to the first at which the mechanism does not assemble or its Jacobian is singular.
/// @param samples  poses of the path; velocity and acceleration contain the first and second derivatives of the pose
/// with respect to the path parameter
/// @return         number of computed points
template <class S>
std::size_t path_points(const Mechanism& mechanism, std::span<const S> parameters, const std::string& mode,
                        std::span<const MotionSample> samples, const Wrench<double>& wrench,
                        std::vector<PathPoint<S>>& points) {
  points.clear();
  const auto is_finite = [](const AxisVector<S>& values) {
    return std::ranges::all_of(values, [](const S& value) { return std::isfinite(value_of(value)); });
  };
  const auto append = [&](const MotionSample& at, PathPoint<S> p) {
    const auto& coordinates = mechanism.info().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      if (coordinates[i].turns()) continue;
      p.tool11 += at.velocity[i] * at.velocity[i];
      p.tool12 += at.velocity[i] * at.acceleration[i];
      p.tool22 += at.acceleration[i] * at.acceleration[i];
    }
    if (!is_finite(p.q1) || !is_finite(p.q2) || !is_finite(p.A) || !is_finite(p.B) || !is_finite(p.C)) return false;
    points.push_back(std::move(p));
    return true;
  };
  if (why_no_joint_forces(mechanism)) {
    if constexpr (std::is_same_v<S, double>)
      for (const MotionSample& at : samples) {
        const auto joints = mechanism.velocities()->influence(parameters, at.pose, mode);
        if (!joints ||
            !append(at, {.q1 = joints->G * at.velocity, .q2 = accelerations(*joints, at.velocity, at.acceleration)}))
          break;
      }
    return points.size();
  }
  Wrench<S> load;
  for (std::size_t i = 0; i < 6; ++i) load[i] = S(wrench[i]);
  InverseDynamicsScratch<S> scratch;
  equations_along<S>(*mechanism.dynamics(), parameters, mode, samples, scratch,
                     [&](std::size_t k, const MotionState<S>& state, const PoseDynamics<S>& d) {
                       const AxisVector<S>& tangent = state.velocity;
                       const AxisVector<S> curvature = samples[k].acceleration;
                       return append(samples[k], {.q1 = d.J * tangent,
                                                  .q2 = d.J * curvature + d.J_rate_X,
                                                  .A = at_joints<S>(d, d.M_X * tangent),
                                                  .B = at_joints<S>(d, d.M_X * curvature + d.h_X),
                                                  .C = at_joints<S>(d, d.G_X - transpose(d.J_wrench) * load)});
                     });
  return points.size();
}

}  // namespace pkm
