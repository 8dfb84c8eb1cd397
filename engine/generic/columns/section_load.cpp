// A section's surfaces in a square that its workspace fills.
#include <cmath>

#include "engine/generic/columns/corners.hpp"

namespace pkm::generic {
namespace {

/// c by t and s, from C by v and z.
Conic in_square(const std::array<double, 6>& C, const std::array<double, 2>& v, const std::array<double, 2>& z) {
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
  // A conic that contains z formally only, but for rounding, is upright.
  constexpr double kRounding = 1e-14;
  if (std::fabs(P.c[2]) + std::fabs(P.c[4]) + std::fabs(P.c[5]) <= kRounding * P.scale) P.c[2] = P.c[4] = P.c[5] = 0;
  return P;
}

/// Cuts a range to [low, high] and a little beyond, so that what ends there does so inside. False: nothing is left.
bool cut(std::array<double, 2>& range, double low, double high) {
  if (!(low <= range[1] && high >= range[0])) return false;
  const double beyond = 1e-2 * (high - low);
  if (low - beyond > range[0]) range[0] = low - beyond;
  if (high + beyond < range[1]) range[1] = high + beyond;
  return true;
}

/// Cuts the ranges to where a conic that is an ellipse, or a strip along one of the coordinates, is >= 0. False: it is
/// so nowhere in them.
bool narrow_to(const std::array<double, 6>& C, std::array<double, 2>& v, std::array<double, 2>& z) {
  const auto [c, cv, cz, cvv, cvz, czz] = C;
  const bool is_round = czz < 0 && cvv < 0 && cvz * cvz < 4 * cvv * czz;
  if (!is_round && !(cvz == 0 && ((cv == 0 && cvv == 0 && czz < 0) || (cz == 0 && czz == 0 && cvv < 0)))) return true;
  const auto range_of = [](const std::array<double, 3>& where, std::array<double, 2>& range) {
    const Roots roots = roots_of(where);
    return roots.count == 2 && cut(range, roots.s[0], roots.s[1]);
  };
  if (czz < 0 && cvv < 0)
    return range_of({cz * cz - 4 * czz * c, 2 * cz * cvz - 4 * czz * cv, cvz * cvz - 4 * czz * cvv}, v) &&
           range_of({cv * cv - 4 * cvv * c, 2 * cv * cvz - 4 * cvv * cz, cvz * cvz - 4 * cvv * czz}, z);
  return czz < 0 ? range_of({c, cz, czz}, z) : range_of({c, cv, cvv}, v);
}

/// P is a multiple of Q: 1 or -1 by its sign, or 0.
int is_multiple(const Conic& P, const Conic& Q) {
  constexpr double kSame = 1e-12;
  const double room = kSame * P.scale * Q.scale;
  bool same = true, opposite = true;
  for (std::size_t i = 0; i < 6 && (same || opposite); ++i) {
    const double p = P.c[i] * Q.scale, q = Q.c[i] * P.scale;
    same = same && std::fabs(p - q) <= room;
    opposite = opposite && std::fabs(p + q) <= room;
  }
  return same ? 1 : opposite ? -1 : 0;
}

void add_active(std::size_t k, SectionRoom& room) {
  for (const std::size_t known : room.active)
    if (const int sign = is_multiple(room.conics[k], room.conics[known])) {
      (sign > 0 ? room.meaning[known].same : room.meaning[known].opposite) |= bit(k);
      return;
    }
  room.active.push_back(k);
  room.meaning[k] = {bit(k), 0};
}

}  // namespace

bool Section::load(std::span<const double> registers, SectionRoom& room) const {
  const auto ends_of = [&](const std::array<std::uint32_t, 2>& ends) {
    return std::array{registers[ends[0]], registers[ends[1]]};
  };
  std::array<double, 2> v = ends_of(plan_.range[plan_.range.size() - 2]), z = ends_of(plan_.range.back());
  if (!(v[1] > v[0]) || !(z[1] > z[0])) return false;
  std::array<std::array<double, 6>, kMostSurfaces> C;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    for (std::size_t i = 0; i < 6; ++i) C[k][i] = registers[plan_.surfaces[k].coefficients[i]];
    if ((plan_.formula.all & bit(k)) != 0 && !narrow_to(C[k], v, z)) return false;
  }
  room.v = {0.5 * (v[0] + v[1]), 0.5 * (v[1] - v[0])};
  room.z = {0.5 * (z[0] + z[1]), 0.5 * (z[1] - z[0])};
  room.active.clear();
  room.always = 0;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    const Conic& P = room.conics[k] = in_square(C[k], room.v, room.z);
    if (!std::isfinite(P.scale)) {
      if ((plan_.formula.all & bit(k)) != 0) return false;
      continue;
    }
    const double rest = std::fabs(P.c[1]) + std::fabs(P.c[2]) + std::fabs(P.c[4]) + 1e-12 * P.scale;
    const auto least = [](double c) { return c < 0 ? c : 0; };
    if (P.c[0] - least(-P.c[3]) - least(-P.c[5]) + rest < 0) {
      if ((plan_.formula.all & bit(k)) != 0) return false;
    } else if (P.c[0] + least(P.c[3]) + least(P.c[5]) - rest > 0 || P.scale == std::fabs(P.c[0])) {
      room.always |= bit(k);
    } else {
      add_active(k, room);
    }
  }
  return true;
}

}  // namespace pkm::generic
