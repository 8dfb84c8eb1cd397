// The constraints of a planar slice, transformed to coordinates (t, s) in which its feasible points lie in the square
// [-1, 1]^2.
#include <cmath>

#include "engine/generic/columns/vertices.hpp"

namespace pkm::generic {
namespace {

/// Expresses a conic in v and z as a conic in t and s in [-1, 1].
/// @param v, z  centre and half width of the box in v, and in z
Conic in_box(const std::array<double, 6>& C, const std::array<double, 2>& v, const std::array<double, 2>& z) {
  const auto [vm, vh] = v;
  const auto [zm, zh] = z;
  Conic P;
  P.c = {C[0] + vm * (C[1] + vm * C[3]) + zm * (C[2] + vm * C[4] + zm * C[5]),
         vh * (C[1] + 2 * vm * C[3] + zm * C[4]),
         zh * (C[2] + vm * C[4] + 2 * zm * C[5]),
         vh * vh * C[3],
         vh * zh * C[4],
         zh * zh * C[5]};
  for (const double c : P.c) P.scale += std::fabs(c);
  // If the terms in z are rounding errors, the conic is a vertical line.
  constexpr double kRounding = 1e-14;
  if (std::fabs(P.c[2]) + std::fabs(P.c[4]) + std::fabs(P.c[5]) <= kRounding * P.scale) P.c[2] = P.c[4] = P.c[5] = 0;
  return P;
}

/// Reduces a range to its intersection with [low, high], enlarged by 1 % so that `low` and `high` lie inside.
/// @return false if the intersection is empty
bool cut(std::array<double, 2>& range, double low, double high) {
  if (!(low <= range[1] && high >= range[0])) return false;
  const double beyond = 1e-2 * (high - low);
  if (low - beyond > range[0]) range[0] = low - beyond;
  if (high + beyond < range[1]) range[1] = high + beyond;
  return true;
}

/// Reduces the ranges of v and z to the bounding box of the points with P >= 0 if these form an ellipse or a strip
/// along v or z; otherwise leaves the ranges unchanged.
/// @param C     coefficients of P
/// @param v, z  range of v, and of z
/// @return false if no point in the ranges can satisfy P >= 0
bool narrow_to(const std::array<double, 6>& C, std::array<double, 2>& v, std::array<double, 2>& z) {
  const auto [c, cv, cz, cvv, cvz, czz] = C;
  const bool has_sqrt_singularity = czz < 0 && cvv < 0 && cvz * cvz < 4 * cvv * czz;
  if (!has_sqrt_singularity && !(cvz == 0 && ((cv == 0 && cvv == 0 && czz < 0) || (cz == 0 && czz == 0 && cvv < 0))))
    return true;
  const auto range_of = [](const std::array<double, 3>& where, std::array<double, 2>& range) {
    const Roots roots = roots_of(where);
    return roots.count == 2 && cut(range, roots.s[0], roots.s[1]);
  };
  if (czz < 0 && cvv < 0)
    return range_of({cz * cz - 4 * czz * c, 2 * cz * cvz - 4 * czz * cv, cvz * cvz - 4 * czz * cvv}, v) &&
           range_of({cv * cv - 4 * cvv * c, 2 * cv * cvz - 4 * cvv * cz, cvz * cvz - 4 * cvv * czz}, z);
  return czz < 0 ? range_of({c, cz, czz}, z) : range_of({c, cv, cvv}, v);
}

/// 1 or -1 if P is a positive or negative multiple of Q, otherwise 0.
int is_multiple(const Conic& P, const Conic& Q) {
  constexpr double kSame = 1e-12;
  const double scratch = kSame * P.scale * Q.scale;
  bool same = true, opposite = true;
  for (std::size_t i = 0; i < 6 && (same || opposite); ++i) {
    const double p = P.c[i] * Q.scale, q = Q.c[i] * P.scale;
    same = same && std::fabs(p - q) <= scratch;
    opposite = opposite && std::fabs(p + q) <= scratch;
  }
  return same ? 1 : opposite ? -1 : 0;
}

void add_active(std::size_t k, PlanarSliceScratch& scratch) {
  for (const std::size_t known : scratch.active)
    if (const int sign = is_multiple(scratch.conics[k], scratch.conics[known])) {
      (sign > 0 ? scratch.meaning[known].same : scratch.meaning[known].opposite) |= bit(k);
      return;
    }
  scratch.active.push_back(k);
  scratch.meaning[k] = {bit(k), 0};
}

}  // namespace

bool PlanarSlice::load(std::span<const double> registers, PlanarSliceScratch& scratch) const {
  const auto ends_of = [&](const std::array<std::uint32_t, 2>& ends) {
    return std::array{registers[ends[0]], registers[ends[1]]};
  };
  std::array<double, 2> v = ends_of(plan_.range[plan_.range.size() - 2]), z = ends_of(plan_.range.back());
  if (!(v[1] > v[0]) || !(z[1] > z[0])) return false;
  std::array<std::array<double, 6>, kMaxSurfaces> C;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    for (std::size_t i = 0; i < 6; ++i) C[k][i] = registers[plan_.surfaces[k].coefficients[i]];
    if ((plan_.formula.all & bit(k)) != 0 && !narrow_to(C[k], v, z)) return false;
  }
  scratch.v = {0.5 * (v[0] + v[1]), 0.5 * (v[1] - v[0])};
  scratch.z = {0.5 * (z[0] + z[1]), 0.5 * (z[1] - z[0])};
  scratch.active.clear();
  scratch.always = 0;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    const Conic& P = scratch.conics[k] = in_box(C[k], scratch.v, scratch.z);
    if (!std::isfinite(P.scale)) {
      if ((plan_.formula.all & bit(k)) != 0) return false;
      continue;
    }
    const double rest = std::fabs(P.c[1]) + std::fabs(P.c[2]) + std::fabs(P.c[4]) + 1e-12 * P.scale;
    const auto least = [](double c) { return c < 0 ? c : 0; };
    if (P.c[0] - least(-P.c[3]) - least(-P.c[5]) + rest < 0) {
      if ((plan_.formula.all & bit(k)) != 0) return false;
    } else if (P.c[0] + least(P.c[3]) + least(P.c[5]) - rest > 0 || P.scale == std::fabs(P.c[0])) {
      scratch.always |= bit(k);
    } else {
      add_active(k, scratch);
    }
  }
  return true;
}

}  // namespace pkm::generic
