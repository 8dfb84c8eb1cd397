// Whether a pose of the hybrid robot is feasible, margin by margin and the cheap ones first: what voxels are compared
// with, and a fast pose test that their speed is compared with. Angles are compared by the sides of triangles, without
// a quotient.
#pragma once

#include <array>

#include "engine/accelerators/hybrid/slice.hpp"

namespace pkm::testing::hybrid {

using namespace pkm::hybrid;

/// Whether a pose is feasible, if the carriage is within its stroke.
inline bool feasible(const SlicedDesign<double>& d, double x, double z, double beta) {
  const Geometry<double>& g = d.g;
  const Limits<double>& l = d.l;
  const WorkingMode& signs = d.signs;
  const auto inside = [](double value, double lower, double upper) { return value >= lower && value <= upper; };
  const auto least = [](double p, double q, double limit) { return p >= q * limit && q > 0; };
  const auto stroke = [&](std::size_t i, double s) { return inside(s, l.s_min[i], l.s_max[i]); };
  const auto along_rail = [](double square, double L, int sign) {
    return square > kRoundoff * L * L ? sqrt(square) * sign : 0;
  };
  // |n| / L is the cosine of a link's pressure angle; out of reach n is 0
  const auto inclined = [&](double n, double L, double sin_psi) {
    return magnitude(n) >= L * l.tau_s && magnitude(n) <= L * sin_psi;
  };
  const auto turned = [](double sine, double cosine, const SinCosOf<double>& greatest) {
    return greatest.sin * cosine >= greatest.cos * magnitude(sine);
  };
  // limbs A and B
  const double n1 = along_rail((g.L1 - z) * (g.L1 + z), g.L1, signs[0]);
  const double n2 = along_rail((g.L2 - z) * (g.L2 + z), g.L2, signs[1]);
  if (!(z > 0 && inside(beta, l.beta_min, l.beta_max) && stroke(0, x - g.a + g.b1 - n1) &&
        stroke(2, x + g.a - g.b2 - n2) && inclined(n1, g.L1, l.psiA.sin) && inclined(n2, g.L2, l.psiA.sin) &&
        g.a * 2.0 + n1 - n2 - l.gap >= 0 && least(magnitude(z * (n1 - n2)), g.L1 * g.L2, l.tau_p)))
    return false;
  // the auxiliary chain
  const auto turn = sincos(beta);
  const std::array<double, 3> w = {x, g.fp * turn.cos + g.h2 * turn.sin - g.f,
                                   z + g.fp * turn.sin - g.h2 * turn.cos - g.h1};
  const double length = sqrt_or_zero(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  if (!(inside(length, l.lw_min, l.lw_max) && least(w[2], length, l.phi.cos) &&
        least((z - g.h1) * turn.cos + g.f * turn.sin - g.h2, length, l.phi.cos)))
    return false;
  // limb C
  const double k = g.e * turn.cos - g.d, N1 = z + g.e * turn.sin, N2 = g.e * (z * turn.cos + g.d * turn.sin);
  const double n3 = along_rail(g.L3 * g.L3 - k * k - N1 * N1, g.L3, signs[2]);
  return stroke(3, x - g.c - n3) && min(z, N1) - l.z_clear >= 0 && inclined(n3, g.L3, l.psiC.sin) &&
         least(N2 * d.branch, g.e * g.L3, l.tau_p) &&
         least(-k * home_side(g), sqrt_or_zero(k * k + N1 * N1), l.tau_c) && turned(-k, N1, l.lam) &&
         turned(k * turn.cos + N1 * turn.sin, N1 * turn.cos - k * turn.sin, l.mu);
}

}  // namespace pkm::testing::hybrid
