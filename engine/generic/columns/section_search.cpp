#include "engine/generic/columns/section_search.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/generic/columns/ends.hpp"
#include "engine/generic/columns/polynomial.hpp"

namespace pkm::generic {
namespace {

constexpr double kRather = 16;  // outer coordinates are halved, which nothing else narrows

double middle_of(const Interval& x) { return 0.5 * (x.lower + x.upper); }
double magnitude_of(const Interval& x) { return std::max(std::fabs(x.lower), std::fabs(x.upper)); }

/// Cuts [from, to] in [0, 1] to where c[0] + c[1] x + c[2] x^2 may be >= 0. False: it is so nowhere.
bool cut(const std::array<double, 3>& c, double& from, double& to) {
  const Roots roots = roots_of(c);
  from = c[0] >= 0 ? 0 : 2;
  to = c[0] + c[1] + c[2] >= 0 ? 1 : -1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(roots.count); ++i) {
    const double x = roots.s[i];
    if (!(x >= 0 && x <= 1)) continue;
    from = std::min(from, x);
    to = std::max(to, x);
  }
  return from <= to;
}

/// Narrows a side to where c + slope t + square t^2, with t in [-1, 1] on it, may be >= 0. False: it is so nowhere.
bool narrow(double c, const Interval& slope, double square, Interval& side) {
  constexpr double kBeyond = 1e-9, kWorthIt = 1.8;
  if (!std::isfinite(c + magnitude_of(slope) + square)) return true;
  double near = 0, far = 0, near_below = 0, far_below = 0;
  const bool above = cut({c, slope.upper, square}, near, far);
  const bool below = cut({c, -slope.lower, square}, near_below, far_below);
  if (!above && !below) return false;
  const double from = below ? -far_below : near, to = above ? far : -near_below;
  if (to - from > kWorthIt) return true;
  const double middle = middle_of(side), half = 0.5 * side.width();
  side = {std::max(side.lower, middle + half * (from - kBeyond)), std::min(side.upper, middle + half * (to + kBeyond))};
  return true;
}

}  // namespace

/// A surface in coordinates t and s in [-1, 1] for v and z of a box: c + ct t + cs s + ctt t^2 + css s^2, more or less
/// `rest`.
struct SectionSearch::Square {
  Interval c, ct, cs, ctt, css;
  double rest = 0;

  double upper_without_t() const { return c.upper + magnitude_of(cs) + std::max(css.upper, 0.0) + rest; }
  double upper_without_s() const { return c.upper + magnitude_of(ct) + std::max(ctt.upper, 0.0) + rest; }
  double upper() const { return upper_without_t() + magnitude_of(ct) + std::max(ctt.upper, 0.0); }
  double lower() const {
    return c.lower - magnitude_of(ct) - magnitude_of(cs) + std::min(ctt.lower, 0.0) + std::min(css.lower, 0.0) - rest;
  }
};

void SectionSearch::start(std::span<const double> registers, SearchRoom& room) const {
  room.boxes.clear();
  room.met.clear();
  room.examined = 0;
  room.registers.assign(registers.begin(), registers.end());
  room.entered.fill(Interval::empty());
  for (std::size_t i = 0; i < sides(); ++i) {
    const auto [from, to] = i + 1 == sides() ? plan_.range.back() : plan_.range[i];
    room.whole.side[i] = {registers[from], registers[to]};
  }
}

void SectionSearch::add(double from, double to, SearchRoom& room) const {
  room.boxes.push_back(room.whole);
  room.boxes.back().side[0] = {from, to};
}

void SectionSearch::examine(SearchRoom& room) const {
  room.examined += room.boxes.size();
  std::erase_if(room.boxes, [&](SearchRoom::Box& box) { return !may_hold(box, room); });
}

std::size_t SectionSearch::longest(const SearchRoom::Box& box, const SearchRoom& room) const {
  const auto share = [&](std::size_t i) {
    return (i < outer() ? kRather : 1) * box.side[i].width() / room.whole.side[i].width();
  };
  std::size_t found = 0;
  for (std::size_t i = 1; i < sides(); ++i)
    if (share(i) > 1.001 * share(found)) found = i;
  return found;
}

void SectionSearch::halve(SearchRoom& room) const {
  room.halves.clear();
  for (const SearchRoom::Box& box : room.boxes) {
    const std::size_t i = longest(box, room);
    const double middle = middle_of(box.side[i]);
    for (const bool is_upper : {false, true}) {
      SearchRoom::Box& half = room.halves.emplace_back(box);
      (is_upper ? half.side[i].lower : half.side[i].upper) = middle;
    }
  }
  room.boxes.swap(room.halves);
}

void SectionSearch::leave_out(double at, SearchRoom& room) const {
  std::erase_if(room.boxes, [&](const SearchRoom::Box& box) {
    const bool is_met = box.side[0].holds(at);
    if (is_met) room.met.push_back(box);
    return is_met;
  });
}

void SectionSearch::spread(std::size_t side, std::optional<double> at, int count, std::vector<double>& places,
                           SearchRoom& room) const {
  room.stretches.clear();
  for (const SearchRoom::Box& box : room.boxes)
    if (!at || box.side[0].holds(*at)) room.stretches.push_back({box.side[side].lower, box.side[side].upper});
  std::ranges::sort(room.stretches);
  for (std::size_t i = 0; i < room.stretches.size();) {
    auto [from, to] = room.stretches[i];
    int boxes = 1;  // beside each other
    for (++i; i < room.stretches.size() && room.stretches[i][0] <= to; ++i) {
      boxes += room.stretches[i][0] > room.stretches[i - 1][0] ? 1 : 0;
      to = std::max(to, room.stretches[i][1]);
    }
    const int number = std::max(count, boxes);
    for (int k = 0; k < number; ++k) places.push_back(from + (to - from) * (k + 0.5) / number);
  }
}

double SectionSearch::unknown(SearchRoom& room) const {
  std::vector<SearchRoom::Box>& all = room.halves;
  all = room.boxes;
  for (const SearchRoom::Box& box : room.met) all.emplace_back(box).open = 0;
  std::ranges::sort(all, {}, [](const SearchRoom::Box& box) { return box.side[0].lower; });
  double sum = 0, chain = 0, end = 0;
  bool is_met = true;
  for (const SearchRoom::Box& box : all) {
    if (box.side[0].lower > end || &box == &all.front()) {
      sum += is_met ? 0 : chain;
      chain = 0;
      is_met = false;
      end = box.side[0].upper;
    }
    end = std::max(end, box.side[0].upper);
    chain += volume(box);
    is_met = is_met || box.open == 0;
  }
  return sum + (is_met ? 0 : chain);
}

double SectionSearch::volume(const SearchRoom::Box& box) const {
  double volume = 1;
  for (std::size_t i = 0; i < sides(); ++i) volume *= box.side[i].width();
  return volume;
}

/// Computes what differs from the box before. False: a plain condition holds nowhere.
bool SectionSearch::enter(const SearchRoom::Box& box, SearchRoom& room) const {
  const auto& stages = plan_.program.stages();
  bool differs = false;
  for (std::size_t stage = 1; stage < stages.size(); ++stage) {
    const Interval& side = box.side[stage > outer() && !plan_.order.v ? outer() : stage - 1];
    Interval& entered = room.entered[stage - 1];
    differs = differs || side.lower != entered.lower || side.upper != entered.upper;
    if (differs) {
      entered = side;
      for (const auto& input : stages[stage].inputs) room.registers[input.to] = side;
      plan_.program.run<Interval>(stage, std::span(room.registers));
    }
    if (stage < plan_.plain.size() && std::ranges::any_of(plan_.plain[stage], [&](std::uint32_t at) {
          return room.registers[at].is_certified_violated();
        })) {
      for (std::size_t i = stage; i < stages.size() - 1; ++i) room.entered[i] = Interval::empty();
      return false;
    }
  }
  return true;
}

SectionSearch::Square SectionSearch::in_square(const Surface& surface, const SearchRoom::Box& box,
                                               std::span<const Interval> registers) const {
  const auto C = [&](std::size_t i) -> const Interval& { return registers[surface.coefficients[i]]; };
  if (surface.is_curve) return {.c = C(0)};
  const Interval& z = box.side[sides() - 1];
  const Interval zm(middle_of(z)), zh(0.5 * z.width());
  if (!plan_.order.v) {
    const Interval cubic = C(3) + zm * (C(4) + C(4) + C(4) + C(4)), zhh = zh * zh;
    Square P{.c = C(0) + zm * (C(1) + zm * (C(2) + zm * (C(3) + zm * C(4)))),
             .cs = zh * (C(1) + zm * (C(2) + C(2) + zm * (C(3) + C(3) + cubic))),
             .css = zhh * (C(2) + zm * (C(3) + C(3) + C(3) + zm * (Interval(6.0) * C(4))))};
    P.rest = magnitude_of(zhh * zh * cubic) + magnitude_of(zhh * zhh * C(4));
    return P;
  }
  const Interval& v = box.side[outer()];
  const Interval vm(middle_of(v)), vh(0.5 * v.width());
  Square P{.c = C(0) + vm * (C(1) + vm * C(3)), .ct = C(1) + vm * (C(3) + C(3)), .ctt = vh * vh * C(3)};
  if (surface.has_z) {
    P.c += zm * (C(2) + vm * C(4) + zm * C(5));
    P.ct += zm * C(4);
    P.cs = zh * (C(2) + vm * C(4) + zm * (C(5) + C(5)));
    P.css = zh * zh * C(5);
    P.rest = magnitude_of(vh * zh * C(4));
  }
  P.ct = vh * P.ct;
  return P;
}

/// False: nothing in the box is feasible. Narrows it.
bool SectionSearch::may_hold(SearchRoom::Box& box, SearchRoom& room) const {
  check_stop();
  if (!enter(box, room)) return false;
  Signs fails = 0;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if ((box.open & bit(k)) == 0) continue;
    const Square P = in_square(plan_.surfaces[k], box, room.registers);
    const bool has_to = (plan_.formula.all & bit(k)) != 0;
    if (P.lower() >= 0) {
      box.open &= ~bit(k);
    } else if (!(P.upper() >= 0)) {
      if (has_to) return false;
      fails |= bit(k);
    } else if (has_to && !plan_.surfaces[k].is_curve) {
      if (plan_.order.v && !narrow(P.upper_without_t(), P.ct, P.ctt.upper, box.side[outer()])) return false;
      if (!narrow(P.upper_without_s(), P.cs, P.css.upper, box.side[sides() - 1])) return false;
    }
  }
  return std::ranges::all_of(plan_.formula.any, [&](Signs one_of) { return (one_of & ~fails) != 0; });
}

}  // namespace pkm::generic
