#include "engine/mechanisms/described/columns/section.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/graph/reverse.hpp"
#include "engine/math/hash.hpp"

namespace pkm::described {
namespace {

// Kinds of corners, in the order in which one stands for all at its place.
constexpr std::uint32_t kSide = 1U << 28, kPlain = 2U << 28, kUpright = 3U << 28, kCrossing = 4U << 28,
                        kExtreme = 5U << 28, kKind = 15U << 28;
constexpr double kTie = 1e-13;

std::uint32_t crossing(std::size_t k, std::size_t l) { return kCrossing | static_cast<std::uint32_t>(k << 8U | l); }
Signs bit(std::size_t k) { return Signs{1} << k; }

/// The sign of a quadratic below all of its roots.
bool positive_below(const std::array<double, 3>& c, int roots) {
  if (c[2] != 0) return c[2] > 0;
  return roots > 0 ? c[1] < 0 : c[0] >= 0;
}

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

bool is_upright(std::uint32_t corner) { return (corner & kKind) <= kUpright; }

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

/// Unless the place is known to be infeasible whatever the surfaces `of` say there.
void Section::add_corner(double t, double s, Signs of, std::uint32_t label, SectionRoom& room) const {
  if (!(std::fabs(s) <= 1 + 1e-9)) return;
  Signs maybe = room.always;
  for (const std::size_t m : room.active) {
    const auto [same, opposite] = room.meaning[m];
    const Conic& P = room.conics[m];
    const double there = (of & bit(m)) != 0 ? 0 : P.at(t, s), near = 1e-7 * P.scale;
    const Signs no = (there < -near ? same : 0) | (there > near ? opposite : 0);
    if ((plan_.formula.all & no) != 0) return;
    maybe |= (same | opposite) & ~no;
  }
  for (const Signs one_of : plan_.formula.any)
    if ((maybe & one_of) == 0) return;
  room.corners.push_back({t, label});
}

void Section::find_corners(SectionRoom& room) const {
  room.corners.clear();
  std::array<double, 8> at{};
  std::array<Point, 16> points{};
  for (std::size_t i = 0; i < room.active.size(); ++i) {
    const std::size_t k = room.active[i];
    const Conic& P = room.conics[k];
    const auto number = static_cast<std::uint32_t>(k);
    if (!plan_.surfaces[k].has_z || (P.c[2] == 0 && P.c[4] == 0 && P.c[5] == 0)) {
      const std::size_t found = roots_between(std::array{P.c[0], P.c[1], P.c[3]}, at);
      for (std::size_t n = 0; n < found; ++n) room.corners.push_back({at[n], kUpright | number});
      continue;
    }
    if (P.is_straight()) {
      if (P.c[4] != 0) room.corners.push_back({-P.c[2] / P.c[4], kExtreme | number});
    } else {
      const std::size_t found = roots_between(P.discriminant(), at);
      for (std::size_t n = 0; n < found; ++n)
        add_corner(at[n], -0.5 * (P.c[2] + at[n] * P.c[4]) / P.c[5], bit(k), kExtreme | number, room);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t l = room.active[j];
      if (!plan_.surfaces[l].has_z) continue;
      const std::size_t found = crossings(P, room.conics[l], points);
      for (std::size_t n = 0; n < found; ++n)
        add_corner(points[n].t, points[n].s, bit(k) | bit(l), crossing(l, k), room);
    }
  }
}

void Section::find_column(double t, const double* registers, SectionRoom& room) const {
  Signs signs = room.always;
  room.ends.clear();
  for (const std::size_t k : room.active) {
    const auto c = room.conics[k].along(t);
    const Roots roots = roots_of(c);
    signs |= positive_below(c, roots.count) ? room.meaning[k].same : room.meaning[k].opposite;
    for (int r = 0; r < roots.count; ++r)
      room.ends.emplace_back(roots.s[static_cast<std::size_t>(r)], static_cast<EndLabel>(k << 1U) + (r ? 1U : 0U));
  }
  std::sort(room.ends.begin(), room.ends.end());
  room.column.clear();
  bool is_in = false;
  EndLabel lower = 0;
  for (std::size_t i = 0; i < room.ends.size();) {
    const double s = room.ends[i].first;
    const Signs before = signs;
    std::size_t end = i;
    for (; end < room.ends.size() && room.ends[end].first <= s + kTie; ++end) {
      const auto [same, opposite] = room.meaning[room.ends[end].second >> 1U];
      signs ^= same | opposite;
    }
    if (plan_.formula.holds(signs, registers) != is_in) {
      is_in = !is_in;
      // of several ends at one place, the first surface's that changes in this direction
      EndLabel label = ~EndLabel{0}, any = ~EndLabel{0};
      for (std::size_t j = i; j < end; ++j) {
        const EndLabel each = room.ends[j].second;
        any = std::min(any, each);
        if (((signs & ~before & room.meaning[each >> 1U].same) != 0) == is_in) label = std::min(label, each);
      }
      if (label == ~EndLabel{0}) label = any;
      if (is_in)
        lower = label;
      else
        room.column.push_back({lower, label});
    }
    i = end;
  }
}

void Section::run_plain(double t, std::span<double> registers, const SectionRoom& room,
                        std::vector<double>& values) const {
  const graph::Program& program = plan_.program;
  for (const auto& input : program.stages()[stage_of_v()].inputs) registers[input.to] = room.v[0] + room.v[1] * t;
  program.run<double>(stage_of_v(), registers);
  values.clear();
  for (const std::uint32_t at : plan_.plain.back()) values.push_back(registers[at]);
}

bool Section::plain_holds(double t, std::span<double> registers, const SectionRoom& room) const {
  const graph::Program& program = plan_.program;
  for (const auto& input : program.stages()[stage_of_v()].inputs) registers[input.to] = room.v[0] + room.v[1] * t;
  program.run<double>(stage_of_v(), registers);
  return std::ranges::all_of(plan_.plain.back(), [&](std::uint32_t at) { return registers[at] >= 0; });
}

/// Corners where a plain condition along v changes its sign, among the pieces found so far.
void Section::find_plain_corners(std::span<double> registers, SectionRoom& room) const {
  constexpr int kSteps = 24;
  const double low = room.pieces.front().from, high = room.pieces.back().to;
  const double inset = 1e-9 * (high - low);
  double t = low + inset;
  run_plain(t, registers, room, room.before);
  for (int step = 1; step <= kSteps; ++step) {
    const double next = step == kSteps ? high - inset : low + (high - low) * step / kSteps;
    run_plain(next, registers, room, room.now);
    for (std::size_t i = 0; i < room.now.size(); ++i) {
      if ((room.before[i] >= 0) == (room.now[i] >= 0)) continue;
      double a = t, b = next, at_a = room.before[i], at_b = room.now[i];
      for (int n = 0; n < 100 && b - a > 4e-16; ++n) {  // Illinois, which halves where a side stays
        double x = a - at_a * (b - a) / (at_b - at_a);
        if (!(x > a && x < b) || n % 3 == 2) x = 0.5 * (a + b);
        if (x <= a || x >= b) break;
        run_plain(x, registers, room, room.other_adjoints);
        const double f = room.other_adjoints[i];
        ((f >= 0) == (at_a >= 0) ? a : b) = x;
        ((f >= 0) == (at_a >= 0) ? at_a : at_b) = f;
      }
      room.corners.push_back({b, kPlain | static_cast<std::uint32_t>(i)});
    }
    t = next;
    std::swap(room.before, room.now);
  }
}

/// @param plain  whether plain conditions are looked at, too
void Section::find_pieces(bool plain, std::span<double> registers, SectionRoom& room) const {
  room.pieces.clear();
  room.spans.clear();
  std::sort(room.corners.begin(), room.corners.end(), [](const auto& x, const auto& y) { return x.t < y.t; });
  double from = -1;
  std::size_t from_corner = room.corners.size();
  const auto add = [&](double to, std::size_t to_corner) {
    const double middle = 0.5 * (from + to);
    room.column.clear();
    if (!plain || plain_holds(middle, registers, room)) find_column(middle, registers.data(), room);
    if (room.column.empty()) return;
    SectionRoom::Piece* const last = room.pieces.empty() ? nullptr : &room.pieces.back();
    if (last && last->to == from && std::ranges::equal(std::span(room.spans).subspan(last->first), room.column)) {
      last->to = to;
      last->to_corner = to_corner;
      return;
    }
    room.pieces.push_back({from, to, from_corner, to_corner, room.spans.size(), room.column.size()});
    room.spans.insert(room.spans.end(), room.column.begin(), room.column.end());
  };
  for (std::size_t i = 0; i < room.corners.size(); ++i) {
    const double t = room.corners[i].t;
    if (t <= -1 + kTie || t - from <= kTie) continue;
    if (t >= 1 - kTie) break;
    add(t, i);
    from = t;
    from_corner = i;
  }
  add(1, room.corners.size());
}

namespace {

/// Of the corners at a place, the one that ends arcs of a surface; a condition along v ends all of them.
std::uint32_t corner_of(std::size_t surface, std::size_t first, double t, const SectionRoom& room) {
  if (first == room.corners.size()) return kSide | (t > 0 ? 1U : 0U);
  std::uint32_t found = 0;
  for (std::size_t i = first; i < room.corners.size() && room.corners[i].t <= room.corners[first].t + kTie; ++i) {
    const std::uint32_t label = room.corners[i].label, kind = label & kKind, place = label & ~kKind;
    const bool its_own =
        kind == kCrossing ? (place & 255U) == surface || place >> 8U == surface : kind != kExtreme || place == surface;
    if (its_own && (found == 0 || label < found)) found = label;
  }
  return found;
}

}  // namespace

void Section::find_structure(SectionRoom& room) const {
  Structure& structure = room.structure;
  const auto goes_on = [&](const SectionRoom::Piece& piece, EndLabel end, bool above) {
    return std::any_of(room.spans.begin() + static_cast<std::ptrdiff_t>(piece.first),
                       room.spans.begin() + static_cast<std::ptrdiff_t>(piece.first + piece.count),
                       [&](const SectionRoom::Span& span) { return (above ? span.upper : span.lower) == end; });
  };
  Signs round = 0, cut = 0;  // surfaces whose arcs go on beyond extremes, and those that have other corners
  const auto add = [&](std::size_t surface, std::size_t first, double t) {
    const std::uint32_t label = corner_of(surface, first, t, room);
    if ((label & kKind) == kExtreme) {
      round |= bit(surface);
      return;
    }
    cut |= bit(surface);
    structure.corners.push_back(label);
    Fnv1a corner;
    corner.add(surface);
    corner.add(label);
    structure.hash += corner.value();
  };
  for (std::size_t p = 0; p < room.pieces.size(); ++p) {
    const auto& piece = room.pieces[p];
    const auto* const before = p > 0 && room.pieces[p - 1].to == piece.from ? &piece - 1 : nullptr;
    const auto* const after = p + 1 < room.pieces.size() && room.pieces[p + 1].from == piece.to ? &piece + 1 : nullptr;
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i)
      for (const bool above : {false, true}) {
        const EndLabel end = above ? room.spans[i].upper : room.spans[i].lower;
        if (!before || !goes_on(*before, end, above)) add(end >> 1U, piece.from_corner, piece.from);
        if (!after || !goes_on(*after, end, above)) add(end >> 1U, piece.to_corner, piece.to);
      }
  }
  for (Signs whole = round & ~cut; whole != 0; whole &= whole - 1) {
    Fnv1a conic;
    conic.add(static_cast<std::uint64_t>(std::countr_zero(whole)));
    structure.hash += conic.value();
  }
  if (!room.pieces.empty() && structure.hash == 0) structure.hash = 1;
}

double Section::measure(std::span<double> registers, SectionRoom& room) const {
  Structure& structure = room.structure;
  structure = {0, std::move(structure.corners), 0};
  structure.corners.clear();
  room.pieces.clear();
  room.spans.clear();
  if (!load(registers, room)) return 0;
  find_corners(room);
  find_pieces(false, registers, room);
  if (!plan_.plain.back().empty() && !room.pieces.empty()) {
    find_plain_corners(registers, room);
    find_pieces(true, registers, room);
  }
  double sum = 0;
  for (const auto& piece : room.pieces)
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
      const auto [lower, upper] = room.spans[i];
      const auto area = [&](EndLabel end) {
        return area_below(room.conics[end >> 1U], {static_cast<int>(end & 1U), piece.from, piece.to});
      };
      sum += area(upper) - area(lower);
    }
  find_structure(room);
  return sum * room.v[1] * room.z[1];
}

double Section::length(const SectionRoom::Piece& piece, double t, const SectionRoom& room) const {
  double sum = 0;
  for (std::size_t i = piece.first; i < piece.first + piece.count; ++i)
    sum += end_at(room.spans[i].upper, t, room) - end_at(room.spans[i].lower, t, room);
  return sum;
}

bool Section::is_round(std::size_t corner, const SectionRoom& room) {
  return corner < room.corners.size() && (room.corners[corner].label & kKind) == kExtreme;
}

void Section::add_slopes(double factor, std::span<double> registers, std::span<double> adjoints,
                         SectionRoom& room) const {
  std::array<std::array<double, 6>, kMostSurfaces> slopes{};
  Signs used = 0;
  const double measure = factor * room.v[1] * room.z[1];
  const auto add_arc = [&](EndLabel end, const SectionRoom::Piece& piece, double sign) {
    const std::size_t k = end >> 1U;
    used |= bit(k);
    add_slopes_of_area(room.conics[k], {static_cast<int>(end & 1U), piece.from, piece.to}, sign * measure, slopes[k]);
  };
  // A side moves by dt and takes columns of this length along.
  const auto add_side = [&](double t, std::uint32_t label, double columns) {
    const std::size_t k = label & ~kKind;
    if ((label & kKind) == kSide) {
      adjoints[plan_.range[plan_.range.size() - 2][k]] += factor * room.z[1] * columns;
    } else if ((label & kKind) == kUpright) {
      const Conic& P = room.conics[k];
      const double g = -measure * columns / (P.c[1] + 2 * t * P.c[3]);
      used |= bit(k);
      slopes[k][0] += g;
      slopes[k][1] += g * t;
      slopes[k][3] += g * t * t;
    } else if ((label & kKind) == kPlain) {
      const graph::Program& program = plan_.program;
      const auto& stage = program.stages()[stage_of_v()];
      run_plain(t, registers, room, room.now);
      std::vector<double>& own = room.other_adjoints;
      own.assign(program.registers(), 0);
      own[plan_.plain.back()[k]] = 1;
      run_backwards(program, stage_of_v(), registers, own);
      double slope = 0;
      for (const auto& input : stage.inputs) {
        slope += own[input.to];
        own[input.to] = 0;
      }
      const double g = -factor * room.z[1] * columns / slope;
      for (std::size_t i = 0; i < own.size(); ++i) adjoints[i] += g * own[i];
    }
  };
  for (const auto& piece : room.pieces) {
    for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
      add_arc(room.spans[i].upper, piece, 1);
      add_arc(room.spans[i].lower, piece, -1);
    }
    add_side(piece.from, corner_of(kMostSurfaces, piece.from_corner, piece.from, room),
             -length(piece, piece.from, room));
    add_side(piece.to, corner_of(kMostSurfaces, piece.to_corner, piece.to, room), length(piece, piece.to, room));
  }
  const auto [vm, vh] = room.v;
  const auto [zm, zh] = room.z;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if ((used & bit(k)) == 0) continue;
    const auto& d = slopes[k];
    const double of_v_z[6] = {d[0],
                              vm * d[0] + vh * d[1],
                              zm * d[0] + zh * d[2],
                              vm * vm * d[0] + 2 * vm * vh * d[1] + vh * vh * d[3],
                              vm * zm * d[0] + vh * zm * d[1] + vm * zh * d[2] + vh * zh * d[4],
                              zm * zm * d[0] + 2 * zm * zh * d[2] + zh * zh * d[5]};
    for (std::size_t i = 0; i < 6; ++i) adjoints[plan_.surfaces[k].coefficients[i]] += of_v_z[i];
  }
}

}  // namespace pkm::described
