#include "engine/generic/columns/section_motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/generic/columns/corners.hpp"

namespace pkm::generic {

Dual4 moved(double at, const Components<4>& sum, double by) {
  const Components<4> motion = sum * (-1 / by);
  return std::ranges::all_of(motion.d, [](double x) { return std::isfinite(x); }) ? Dual4(at, motion) : Dual4(at);
}

Components<4> motion_of(std::span<const double> by, std::span<const Dual4> registers) {
  Components<4> sum;
  for (std::size_t i = 0; i < by.size(); ++i)
    if (by[i] != 0) sum = sum + registers[i].v * by[i];
  return sum;
}

SectionMotion::Boundary SectionMotion::boundary(std::uint32_t of, double t, double s) const {
  const SectionPlan& plan = section_.plan();
  const std::uint32_t number = of & ~kKind;
  if ((of & kKind) == kSide) return {1, 0, moving_[plan.range[plan.range.size() - 2][number]].v * (-1 / room_.v[1])};
  if ((of & kKind) == kPlain) {
    std::vector<double> by;
    const double slope = section_.slope_of_plain(number, t, registers_, room_, by);
    return {slope * room_.v[1], 0, motion_of(by, moving_)};
  }
  const auto [along_t, along_s] = gradient(room_.conics[number], t, s);
  const double v = room_.v[0] + room_.v[1] * t, z = room_.z[0] + room_.z[1] * s;
  const double powers[6] = {1, v, z, v * v, v * z, z * z};
  Components<4> change;
  for (std::size_t i = 0; i < 6; ++i) change = change + moving_[plan.surfaces[number].coefficients[i]].v * powers[i];
  return {along_t, along_s, change};
}

Dual4 SectionMotion::corner(std::size_t first, double t) const {
  if (const std::uint32_t label = corner_of(kMostSurfaces, first, t, room_)) {
    const bool is_surface = (label & kKind) == kUpright;
    const Boundary side = boundary(is_surface ? label & ~kKind : label, t, -room_.z[0] / room_.z[1]);
    return moved(t, side.change, side.t);
  }
  const SectionRoom::Corner& at = room_.corners[first];
  return {t, ((at.label & kKind) == kCrossing ? crossing(at) : extreme(at.label & ~kKind, at)).v};
}

Dual4 SectionMotion::crossing(const SectionRoom::Corner& at) const {
  if (at.touches) return at.t;  // where two columns' ends touch, it does not matter which of them is taken
  const Boundary p = boundary(at.label & 255U, at.t, at.s), q = boundary((at.label & ~kKind) >> 8U, at.t, at.s);
  return moved(at.t, p.change * q.s - q.change * p.s, p.t * q.s - p.s * q.t);
}

Dual4 SectionMotion::extreme(std::uint32_t surface, const SectionRoom::Corner& at) const {
  const Conic& P = room_.conics[surface];
  const auto change = [&](double s) { return boundary(surface, at.t, s).change; };
  if (!P.is_straight()) return moved(at.t, change(at.s), gradient(P, at.t, at.s)[0]);
  // The root is infinite there: P_s = 0 whatever s is.
  return moved(at.t, (change(1) - change(-1)) * 0.5, P.c[4]);
}

Dual4 SectionMotion::end(EndLabel end, const Dual4& t) const {
  const double s = end_at(end, t.a, room_);
  const Boundary at = boundary(end >> 1U, t.a, s);
  return moved(s, at.change + t.v * at.t, at.s);
}

}  // namespace pkm::generic
