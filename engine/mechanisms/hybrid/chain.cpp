#include "engine/mechanisms/hybrid/chain.hpp"

#include "engine/math/taylor.hpp"

namespace pkm::hybrid {
namespace {

/// Where the forks turn.
Taylor output(const Geometry<double>& g, const Pose<Taylor>& pose, const Taylor& theta, double zeta) {
  return output_angle(g, forks(shaft(g, pose), pose.angle, zeta), theta);
}

/// By (x, y, z, beta, theta).
ChainInfluence influence(const Geometry<double>& g, const Pose<double>& pose, double theta, double zeta) {
  const auto along = [&](const Vector<double, 5>& u) {
    return output(g, {{pose.x, u[0], 0}, {pose.y, u[1], 0}, {pose.z, u[2], 0}, {pose.angle, u[3], 0}}, {theta, u[4], 0},
                  zeta);
  };
  ChainInfluence found{.gradient = AxisVector<double>(5), .hessian = AxisMatrix<double>(5, 5)};
  std::array<Vector<double, 5>, 5> axis;
  for (std::size_t i = 0; i < 5; ++i) {
    axis[i][i] = 1;
    const Taylor gamma = along(axis[i]);
    found.gradient[i] = gamma.d;
    found.hessian(i, i) = gamma.dd;
  }
  for (std::size_t i = 0; i < 5; ++i)  // u^T H u for the sum of two axes is H_ii + H_jj + 2 H_ij
    for (std::size_t j = 0; j < i; ++j)
      found.hessian(i, j) = found.hessian(j, i) =
          (along(axis[i] + axis[j]).dd - found.hessian(i, i) - found.hessian(j, j)) / 2;
  return found;
}

Spin spin(const Turning& beta, const Turning& gamma) {
  const auto [s, c] = sincos(beta.angle);
  const double cross = beta.speed * gamma.speed;
  return {{{beta.speed, -gamma.speed * s, gamma.speed * c}},
          {{beta.acceleration, -gamma.acceleration * s - cross * c, gamma.acceleration * c - cross * s}}};
}

}  // namespace

ChainReport inspect_chain(const Geometry<double>& g, const MotionSample& at, double zeta) {
  const Pose<double> pose = schoenflies(at.pose);
  const Shaft<double> axis = shaft(g, pose);
  const AxisVector<double>&X = at.pose, &V = at.velocity, &A = at.acceleration;
  ChainReport report;
  report.angles = {{"phi1", acos(axis.cos_phi1)}, {"phi2", acos(axis.cos_phi2)}, {"shaft_length", axis.length}};
  report.turns = forks(axis, X[3], zeta).turns;
  if (!report.turns) {
    report.reason = axis.P * axis.Q > 0 ? "the chain is mirrored, and its forks are out of phase"
                                        : "a universal joint of the chain is bent by a right angle or more";
    return report;
  }
  const Pose<Taylor> moving{{X[0], V[0], A[0]}, {X[1], V[1], A[1]}, {X[2], V[2], A[2]}, {X[3], V[3], A[3]}};
  const Turning& theta = at.input;
  const Taylor gamma = output(g, moving, {theta.angle, theta.speed, theta.acceleration}, zeta);
  report.output = {gamma.a, gamma.d, gamma.dd};
  report.influence = influence(g, pose, theta.angle, zeta);
  report.spin = spin({X[3], V[3], A[3]}, report.output);
  return report;
}

}  // namespace pkm::hybrid
