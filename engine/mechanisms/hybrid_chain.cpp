#include "engine/mechanisms/hybrid_chain.hpp"

#include "engine/math/taylor.hpp"

namespace pkm::hybrid {
namespace {

Geometry<Taylor> at_rest(const Geometry<double>& g) {
  Geometry<Taylor> still{g.a, g.b1, g.b2, g.c, g.d, g.e, g.L1, g.L2, g.L3, g.f, g.fp, g.h1, g.h2, g.theta0, {}};
  for (std::size_t i = 0; i < g.radius.size(); ++i) still.radius[i] = g.radius[i];
  return still;
}

Taylor output(const Geometry<Taylor>& g, const Pose<Taylor>& pose, const Taylor& theta, double zeta) {
  const Forks<Taylor> k = forks(shaft(g, pose), pose.angle, zeta);
  return k.turns ? output_angle(g, k, theta) : Taylor();
}

}  // namespace

Turning output_motion(const Geometry<double>& g, const Pose<double>& pose, const Vector<double, 4>& v,
                      const Vector<double, 4>& a, const Turning& theta, double zeta) {
  const Pose<Taylor> moving{{pose.x, v[0], a[0]}, {pose.y, v[1], a[1]}, {pose.z, v[2], a[2]}, {pose.angle, v[3], a[3]}};
  const Taylor gamma = output(at_rest(g), moving, {theta.angle, theta.speed, theta.acceleration}, zeta);
  return {gamma.a, gamma.d, gamma.dd};
}

ChainInfluence chain_influence(const Geometry<double>& g, const Pose<double>& pose, double theta, double zeta) {
  const Geometry<Taylor> still = at_rest(g);
  const auto along = [&](const Vector<double, 5>& u) {
    return output(still, {{pose.x, u[0], 0}, {pose.y, u[1], 0}, {pose.z, u[2], 0}, {pose.angle, u[3], 0}},
                  {theta, u[4], 0}, zeta);
  };
  ChainInfluence found;
  std::array<Vector<double, 5>, 5> axis;
  for (std::size_t i = 0; i < 5; ++i) {
    axis[i][i] = 1;
    const Taylor gamma = along(axis[i]);
    found.gradient[i] = gamma.d;
    found.hessian(i, i) = gamma.dd;
  }
  for (std::size_t i = 0; i < 5; ++i)  // a quadratic form on the diagonal of a square has all four of its terms
    for (std::size_t j = 0; j < i; ++j)
      found.hessian(i, j) = found.hessian(j, i) =
          (along(axis[i] + axis[j]).dd - found.hessian(i, i) - found.hessian(j, j)) / 2;
  return found;
}

Spin output_spin(const Turning& beta, const Turning& gamma) {
  const auto [s, c] = sincos(beta.angle);
  const double cross = beta.speed * gamma.speed;
  return {{{beta.speed, -gamma.speed * s, gamma.speed * c}},
          {{beta.acceleration, -gamma.acceleration * s - cross * c, gamma.acceleration * c - cross * s}}};
}

}  // namespace pkm::hybrid
