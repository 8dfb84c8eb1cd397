#include "engine/generic/columns/component_search.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/generic/columns/endpoints.hpp"
#include "engine/generic/polynomial.hpp"

namespace pkm::generic {
namespace {

// Factor by which outer coordinates are preferred when the side to be bisected is chosen, because contraction reduces
// only the sides v and z.
constexpr double kOuterBias = 16;

double middle_of(const Interval& x) { return 0.5 * (x.lower + x.upper); }
double magnitude_of(const Interval& x) { return std::max(std::fabs(x.lower), std::fabs(x.upper)); }

/// Sets [from, to] to the smallest part of [0, 1] outside which c[0] + c[1] x + c[2] x^2 is negative.
/// @return false if the quadratic is negative in all of [0, 1]
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

/// Reduces the interval `side` to the part of it in which c + slope t + curvature t^2 can be >= 0, where t is -1 at the
/// lower and 1 at the upper end of the interval. @return false if there is no such part
bool narrow(double c, const Interval& slope, double curvature, Interval& side) {
  constexpr double kBeyond = 1e-9, kWorthIt = 1.8;
  if (!std::isfinite(c + magnitude_of(slope) + curvature)) return true;
  double near = 0, far = 0, near_below = 0, far_below = 0;
  const bool above = cut({c, slope.upper, curvature}, near, far);
  const bool below = cut({c, -slope.lower, curvature}, near_below, far_below);
  if (!above && !below) return false;
  const double from = below ? -far_below : near, to = above ? far : -near_below;
  if (to - from > kWorthIt) return true;
  const double middle = middle_of(side), half = 0.5 * side.width();
  side = {std::max(side.lower, middle + half * (from - kBeyond)), std::min(side.upper, middle + half * (to + kBeyond))};
  return true;
}

}  // namespace

/// The polynomial of a surface in a box, as a function of t and s in [-1, 1], which stand for v and z in the box: c +
/// ct t + cs s + ctt t^2 + css s^2, with an error between -rest and rest.
struct ComponentSearch::BoxQuadratic {
  Interval c, ct, cs, ctt, css;
  double rest = 0;

  double upper_without_t() const { return c.upper + magnitude_of(cs) + std::max(css.upper, 0.0) + rest; }
  double upper_without_s() const { return c.upper + magnitude_of(ct) + std::max(ctt.upper, 0.0) + rest; }
  double upper() const { return upper_without_t() + magnitude_of(ct) + std::max(ctt.upper, 0.0); }
  double lower() const {
    return c.lower - magnitude_of(ct) - magnitude_of(cs) + std::min(ctt.lower, 0.0) + std::min(css.lower, 0.0) - rest;
  }
};

void ComponentSearch::start(std::span<const double> registers, SearchScratch& scratch) const {
  scratch.boxes.clear();
  scratch.non_empty.clear();
  scratch.examined = 0;
  scratch.registers.assign(registers.begin(), registers.end());
  scratch.evaluated.fill(Interval::empty());
  for (std::size_t i = 0; i < sides(); ++i) {
    const auto [from, to] = i + 1 == sides() ? plan_.range.back() : plan_.range[i];
    scratch.whole.side[i] = {registers[from], registers[to]};
  }
}

void ComponentSearch::add(double from, double to, SearchScratch& scratch) const {
  scratch.boxes.push_back(scratch.whole);
  scratch.boxes.back().side[0] = {from, to};
}

void ComponentSearch::examine(SearchScratch& scratch) const {
  scratch.examined += scratch.boxes.size();
  std::erase_if(scratch.boxes, [&](SearchScratch::Box& box) { return !may_be_feasible(box, scratch); });
}

std::size_t ComponentSearch::longest(const SearchScratch::Box& box, const SearchScratch& scratch) const {
  const auto share = [&](std::size_t i) {
    return (i < outer() ? kOuterBias : 1) * box.side[i].width() / scratch.whole.side[i].width();
  };
  std::size_t found = 0;
  for (std::size_t i = 1; i < sides(); ++i)
    if (share(i) > 1.001 * share(found)) found = i;
  return found;
}

void ComponentSearch::bisect(SearchScratch& scratch) const {
  scratch.halves.clear();
  for (const SearchScratch::Box& box : scratch.boxes) {
    const std::size_t i = longest(box, scratch);
    const double middle = middle_of(box.side[i]);
    for (const bool is_upper : {false, true}) {
      SearchScratch::Box& half = scratch.halves.emplace_back(box);
      (is_upper ? half.side[i].lower : half.side[i].upper) = middle;
    }
  }
  scratch.boxes.swap(scratch.halves);
}

void ComponentSearch::remove_containing(double at, SearchScratch& scratch) const {
  std::erase_if(scratch.boxes, [&](const SearchScratch::Box& box) {
    const bool is_met = box.side[0].holds(at);
    if (is_met) scratch.non_empty.push_back(box);
    return is_met;
  });
}

void ComponentSearch::add_samples(std::size_t side, std::optional<double> at, int count, std::vector<double>& places,
                                  SearchScratch& scratch) const {
  scratch.uncovered.clear();
  for (const SearchScratch::Box& box : scratch.boxes)
    if (!at || box.side[0].holds(*at)) scratch.uncovered.push_back({box.side[side].lower, box.side[side].upper});
  std::ranges::sort(scratch.uncovered);
  for (std::size_t i = 0; i < scratch.uncovered.size();) {
    auto [from, to] = scratch.uncovered[i];
    int boxes = 1;  // number of different boxes in this group of adjacent boxes
    for (++i; i < scratch.uncovered.size() && scratch.uncovered[i][0] <= to; ++i) {
      boxes += scratch.uncovered[i][0] > scratch.uncovered[i - 1][0] ? 1 : 0;
      to = std::max(to, scratch.uncovered[i][1]);
    }
    const int number = std::max(count, boxes);
    for (int k = 0; k < number; ++k) places.push_back(from + (to - from) * (k + 0.5) / number);
  }
}

double ComponentSearch::undecided_volume(SearchScratch& scratch) const {
  std::vector<SearchScratch::Box>& all = scratch.halves;
  all = scratch.boxes;
  for (const SearchScratch::Box& box : scratch.non_empty) all.emplace_back(box).open = 0;
  std::ranges::sort(all, {}, [](const SearchScratch::Box& box) { return box.side[0].lower; });
  double sum = 0, chain = 0, end = 0;
  bool is_met = true;
  for (const SearchScratch::Box& box : all) {
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

double ComponentSearch::volume(const SearchScratch::Box& box) const {
  double volume = 1;
  for (std::size_t i = 0; i < sides(); ++i) volume *= box.side[i].width();
  return volume;
}

/// Evaluates those stages of the program for a box whose inputs differ from the last evaluation.
/// @return false if a constraint that is independent of the inner coordinates is violated everywhere in the box
bool ComponentSearch::evaluate(const SearchScratch::Box& box, SearchScratch& scratch) const {
  const auto& stages = plan_.program.stages();
  bool differs = false;
  for (std::size_t stage = 1; stage < stages.size(); ++stage) {
    const Interval& side = box.side[stage > outer() && !plan_.order.v ? outer() : stage - 1];
    Interval& evaluated = scratch.evaluated[stage - 1];
    differs = differs || side.lower != evaluated.lower || side.upper != evaluated.upper;
    if (differs) {
      evaluated = side;
      for (const auto& input : stages[stage].inputs) scratch.registers[input.to] = side;
      plan_.program.run<Interval>(stage, std::span(scratch.registers));
    }
    if (stage < plan_.independent.size() && std::ranges::any_of(plan_.independent[stage], [&](std::uint32_t at) {
          return scratch.registers[at].is_certified_violated();
        })) {
      for (std::size_t i = stage; i < stages.size() - 1; ++i) scratch.evaluated[i] = Interval::empty();
      return false;
    }
  }
  return true;
}

ComponentSearch::BoxQuadratic ComponentSearch::in_box(const Surface& surface, const SearchScratch::Box& box,
                                                      std::span<const Interval> registers) const {
  const auto C = [&](std::size_t i) -> const Interval& { return registers[surface.coefficients[i]]; };
  if (surface.is_transcendental) return {.c = C(0)};
  const Interval& z = box.side[sides() - 1];
  const Interval zm(middle_of(z)), zh(0.5 * z.width());
  if (!plan_.order.v) {
    const Interval cubic = C(3) + zm * (C(4) + C(4) + C(4) + C(4)), zhh = zh * zh;
    BoxQuadratic P{.c = C(0) + zm * (C(1) + zm * (C(2) + zm * (C(3) + zm * C(4)))),
                   .cs = zh * (C(1) + zm * (C(2) + C(2) + zm * (C(3) + C(3) + cubic))),
                   .css = zhh * (C(2) + zm * (C(3) + C(3) + C(3) + zm * (Interval(6.0) * C(4))))};
    P.rest = magnitude_of(zhh * zh * cubic) + magnitude_of(zhh * zhh * C(4));
    return P;
  }
  const Interval& v = box.side[outer()];
  const Interval vm(middle_of(v)), vh(0.5 * v.width());
  BoxQuadratic P{.c = C(0) + vm * (C(1) + vm * C(3)), .ct = C(1) + vm * (C(3) + C(3)), .ctt = vh * vh * C(3)};
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

/// Reduces the box to a part that contains all of its feasible points. @return false if it has no feasible point
bool ComponentSearch::may_be_feasible(SearchScratch::Box& box, SearchScratch& scratch) const {
  check_stop();
  if (!evaluate(box, scratch)) return false;
  Signs fails = 0;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if ((box.open & bit(k)) == 0) continue;
    const BoxQuadratic P = in_box(plan_.surfaces[k], box, scratch.registers);
    const bool has_to = (plan_.formula.all & bit(k)) != 0;
    if (P.lower() >= 0) {
      box.open &= ~bit(k);
    } else if (!(P.upper() >= 0)) {
      if (has_to) return false;
      fails |= bit(k);
    } else if (has_to && !plan_.surfaces[k].is_transcendental) {
      if (plan_.order.v && !narrow(P.upper_without_t(), P.ct, P.ctt.upper, box.side[outer()])) return false;
      if (!narrow(P.upper_without_s(), P.cs, P.css.upper, box.side[sides() - 1])) return false;
    }
  }
  return std::ranges::all_of(plan_.formula.any, [&](Signs one_of) { return (one_of & ~fails) != 0; });
}

}  // namespace pkm::generic
