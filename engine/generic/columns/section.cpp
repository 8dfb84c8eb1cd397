#include "engine/generic/columns/section.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/generic/columns/corners.hpp"
#include "engine/math/hash.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

/// The sign of a quadratic below all of its roots.
bool positive_below(const std::array<double, 3>& c, int roots) {
  if (c[2] != 0) return c[2] > 0;
  return roots > 0 ? c[1] < 0 : c[0] >= 0;
}

}  // namespace

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

void Section::set_v(double t, std::span<double> registers, const SectionRoom& room) const {
  const expression::Program& program = plan_.program;
  for (const auto& input : program.stages()[stage_of_v()].inputs) registers[input.to] = room.v[0] + room.v[1] * t;
  program.run<double>(stage_of_v(), registers);
}

void Section::run_plain(double t, std::span<double> registers, const SectionRoom& room,
                        std::vector<double>& values) const {
  set_v(t, registers, room);
  values.clear();
  for (const std::uint32_t at : plan_.plain.back()) values.push_back(registers[at]);
}

bool Section::plain_holds(double t, std::span<double> registers, const SectionRoom& room) const {
  set_v(t, registers, room);
  return std::ranges::all_of(plan_.plain.back(), [&](std::uint32_t at) { return is_satisfied(registers[at]); });
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

void Section::find_structure(SectionRoom& room) const {
  Structure& structure = room.structure;
  Signs round = 0, cut = 0;  // surfaces whose arcs go on beyond extremes, and those that have other corners
  const auto add = [&](std::size_t surface, std::size_t first, double t) {
    const std::uint32_t label = corner_of(surface, first, t, room);
    if ((label & kKind) == kExtreme) {
      round |= bit(surface);
      return;
    }
    cut |= bit(surface);
    Fnv1a corner;
    corner.add(surface);
    corner.add(label);
    structure += corner.value();
  };
  for_each_arc_end(room, [&](EndLabel end, std::size_t first, double t) { add(end >> 1U, first, t); });
  for (Signs whole = round & ~cut; whole != 0; whole &= whole - 1) {
    Fnv1a conic;
    conic.add(static_cast<std::uint64_t>(std::countr_zero(whole)));
    structure += conic.value();
  }
  if (!room.pieces.empty() && structure == 0) structure = 1;
}

void Section::find_marks(const SectionRoom& room, Marks& marks) const {
  for_each_arc_end(room, [&](EndLabel end, std::size_t first, double t) {
    const std::uint64_t surface = end >> 1U;
    const std::uint32_t label = corner_of(end >> 1U, first, t, room);
    const auto corner = std::find_if(room.corners.begin() + static_cast<std::ptrdiff_t>(first), room.corners.end(),
                                     [&](const SectionRoom::Corner& each) { return each.label == label; });
    if (corner != room.corners.end() && ((label & kKind) == kCrossing || (label & kKind) == kExtreme)) {
      // which both of its arcs have
      const Mark mark{label, label, corner->t, corner->s};
      if (std::ranges::none_of(marks, [&](const Mark& m) { return m.key == label && m.t == mark.t && m.s == mark.s; }))
        marks.push_back(mark);
    } else {
      marks.push_back({surface << 32U | label, label, t, end_at(end, t, room)});
    }
  });
}

double Section::distance(const Mark& corner, const Mark& other, const SectionRoom& room) {
  const auto surfaces = [](const Mark& mark) {
    const auto place = static_cast<std::uint32_t>(mark.of) & ~kKind;
    return std::array<std::size_t, 2>{place & 255U, place >> 8U};
  };
  const auto crosses = [](const Mark& mark) { return (mark.of & kKind) == kCrossing; };
  double least = std::numeric_limits<double>::infinity();
  if (!crosses(corner) || !crosses(other)) return least;
  const auto lies_on = [own = surfaces(corner)](std::size_t k) { return own[0] == k || own[1] == k; };
  for (const std::size_t k : surfaces(other)) {
    const Conic& conic = room.conics[k];
    if (!lies_on(k)) least = std::fmin(least, std::fabs(conic.at(corner.t, corner.s)) / conic.scale);
  }
  return least;
}

double Section::measure(std::span<double> registers, SectionRoom& room) const {
  room.structure = 0;
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

std::array<double, 3> Section::moments(const SectionRoom::Piece& piece, double t, const SectionRoom& room) const {
  std::array<double, 3> sum{};
  for (std::size_t i = piece.first; i < piece.first + piece.count; ++i) {
    const double a = end_at(room.spans[i].lower, t, room), b = end_at(room.spans[i].upper, t, room);
    sum[0] += b - a;
    sum[1] += (b * b - a * a) / 2;
    sum[2] += (b * b * b - a * a * a) / 3;
  }
  return sum;
}

void Section::add_pieces(const SectionRoom& room, std::vector<Piece<double>>& pieces) const {
  for (const auto& piece : room.pieces)
    pieces.push_back({room.v[0] + room.v[1] * piece.from, room.v[0] + room.v[1] * piece.to,
                      is_round(piece.from_corner, room), is_round(piece.to_corner, room)});
}

std::vector<std::array<double, 2>> Section::columns(double v, std::span<double> registers, SectionRoom& room) const {
  std::vector<std::array<double, 2>> found;
  const double t = (v - room.v[0]) / room.v[1];
  const bool holds = plan_.plain.back().empty() || plain_holds(t, registers, room);
  if (!holds || room.pieces.empty() || t < room.pieces.front().from || t > room.pieces.back().to) return found;
  find_column(t, registers.data(), room);
  for (const auto& [lower, upper] : room.column)
    found.push_back({room.z[0] + room.z[1] * end_at(lower, t, room), room.z[0] + room.z[1] * end_at(upper, t, room)});
  return found;
}

bool Section::is_round(std::size_t corner, const SectionRoom& room) {
  constexpr double kNear = 1e-7;  // where conics touch, crossings are beside their extreme, on either side
  return corner < room.corners.size() && std::ranges::any_of(room.corners, [&](const SectionRoom::Corner& other) {
           return (other.label & kKind) == kExtreme && std::fabs(other.t - room.corners[corner].t) <= kNear;
         });
}

}  // namespace pkm::generic
