// Leibniz terms of an integral whose integrand jumps: where the measure m of slices jumps at x = b(p),
//
//   d/dp of the integral of m(x) dx  contains  (m(b-) - m(b+)) db/dp.
//
// Let D be the set of points y of a slice that are feasible on one side of b only. One constraint g is violated there
// on the other side, so g(b(p), y; p) = 0 for y in D, even if g formally contains y. The term is therefore the integral
// of -g_p / g_x over D, evaluated by quadrature: g may be independent of y at this design only.
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/sections_integral.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

constexpr double kBeside = 1e-9;      // of the range: distance from the break at which the two sides are compared
constexpr double kFarther = 10;       // a second distance, in units of the first
constexpr double kNegligible = 1e-6;  // of the greatest slice: jumps that the extrapolation to the break cannot tell

using Intervals = std::vector<std::array<double, 2>>;

/// x without y; both in order.
Intervals difference(const Intervals& x, const Intervals& y) {
  Intervals rest;
  for (auto [from, to] : x) {
    for (const auto& [low, high] : y) {
      if (high <= from || low >= to) continue;
      if (low > from) rest.push_back({from, low});
      from = std::max(from, high);
    }
    if (to > from) rest.push_back({from, to});
  }
  return rest;
}

/// Pieces divided at those of the places that are well inside; integrands may behave like roots there.
std::vector<Piece<double>> divided(const std::vector<Piece<double>>& pieces, std::vector<double> places) {
  constexpr double kInside = 1e-6;  // of a piece
  std::ranges::sort(places);
  std::vector<Piece<double>> all;
  for (Piece<double> rest : pieces) {
    const double inset = kInside * (rest.upper - rest.lower), end = rest.upper - inset;
    for (const double at : places) {
      if (!(at > rest.lower + inset && at < end)) continue;
      all.push_back({rest.lower, at, rest.sqrt_at_lower, true});
      rest.lower = at;
      rest.sqrt_at_lower = true;
    }
    all.push_back(rest);
  }
  return all;
}

/// The measure just above an end of a part less that just below it.
double step_at(const SlicePart& part, bool upper) {
  return upper ? part.beyond_upper - part.above.measure : part.below.measure - part.beyond_lower;
}

}  // namespace

/// The points that are feasible on the side `in` of a break and infeasible on the side `out`.
struct SectionsIntegral::Lost {
  std::size_t level;  ///< of the break
  IntegralRoom &in, &out;
  const LostVisitor& visit;
};

bool SectionsIntegral::may_jump(std::size_t level, const SlicePart& part, bool upper, const IntegralRoom& room) {
  if ((upper ? part.upper : part.lower) != kChange) return false;
  return std::fabs(step_at(part, upper)) > kJump * room.levels[level].greatest;
}

void SectionsIntegral::visit_lost(std::size_t level, const SlicePart& part, bool upper, double side, IntegralRoom& room,
                                  const LostVisitor& visit) const {
  if (!room.other) room.other = std::make_unique<IntegralRoom>();
  IntegralRoom& out = *room.other;
  out.registers = room.registers;
  out.levels.resize(room.levels.size());
  for (std::size_t i = 0; i < out.levels.size(); ++i) {
    const IntegralRoom::Level& own = room.levels[i];
    out.levels[i].greatest = own.greatest;
    if (i <= level) continue;                   // not integrated over again
    out.levels[i].seen_count = own.seen_count;  // where small parts are
    out.levels[i].seen.assign(own.seen.begin(), own.seen.begin() + static_cast<std::ptrdiff_t>(own.seen_count));
  }
  out.measured = true;
  out.for_slopes = room.for_slopes;
  out.has_hints = room.has_hints;
  if (room.has_hints) out.search = room.search;
  out.sections = 0;
  out.most = room.most;
  const auto [from, to] = plan().range[level];
  const double at = upper ? part.piece.upper : part.piece.lower;
  const double step = side * kBeside * (room.registers[to] - room.registers[from]);
  const double greatest = room.levels[level].greatest;
  std::array<Slice, 2> inside, outside;
  std::array<double, 2> lost{};
  const auto measure = [&](std::size_t i) {
    const double distance = i == 0 ? step : kFarther * step;
    inside[i] = slice(level, at + distance, room);
    outside[i] = slice(level, at - distance, out);
    lost[i] = inside[i].measure - outside[i].measure;
  };
  measure(1);
  measure(0);
  // What grows like a root from the break is no jump: lost = jump + c sqrt(distance).
  const double root = std::sqrt(kFarther);
  const bool like_root = std::fabs(lost[1] - lost[0]) > kJump * greatest;
  const double jump = like_root ? (root * lost[0] - lost[1]) / (root - 1) : lost[0];
  if (std::fabs(jump) <= kNegligible * greatest) return;
  // Next to another break, the root may begin elsewhere; a jump is there right beside the break, too.
  if (!(side * step_at(part, upper) / jump > 0.5)) return;
  const Lost set{level, room, out, visit};
  visit_lost(level + 1, like_root ? root / (root - 1) : 1, inside[0].hash == 0, outside[0].hash == 0, set);
  if (!like_root) return;
  measure(1);
  visit_lost(level + 1, -1 / (root - 1), inside[1].hash == 0, outside[1].hash == 0, set);
}

double SectionsIntegral::unexplained(std::size_t level, const SliceBreak& at, IntegralRoom& room) const {
  const double jump = at.above.measure - at.below.measure;
  const SlicePart below{.piece = {at.at, at.at}, .above = at.below, .beyond_upper = at.above.measure};
  double explained = 0;
  visit_lost(level, below, true, jump > 0 ? 1 : -1, room, [&](double weight, double) { explained += weight; });
  return std::max(0.0, std::fabs(jump) - explained);
}

/// After inside(level) on both sides.
void SectionsIntegral::visit_lost(std::size_t level, double weight, bool in_is_empty, bool out_is_empty,
                                  const Lost& lost) const {
  if (in_is_empty) return;
  const NestedRule& rule = kronrod_rule();
  const auto for_each_node = [&](const std::vector<Piece<double>>& pieces, const std::vector<double>& ends,
                                 const auto& visit) {
    for (const Piece<double>& piece : divided(pieces, ends))
      for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
        const auto [at, jacobian] = map_node(piece, rule.node[i]);
        visit(at, weight * jacobian * rule.level.front().weight[i]);
      }
  };
  std::vector<Piece<double>> pieces;
  std::vector<double> ends;
  if (level < levels()) {
    for (const SlicePart& part : lost.in.levels[level].parts) pieces.push_back(part.piece);
    if (!out_is_empty)
      for (const SlicePart& part : lost.out.levels[level].parts)
        ends.insert(ends.end(), {part.piece.lower, part.piece.upper});
    for_each_node(pieces, ends, [&](double at, double own) {
      const bool is_empty = slice(level, at, lost.in).hash == 0;
      bool other_is_empty = true;
      if (out_is_empty)
        set(level, at, lost.out);
      else
        other_is_empty = slice(level, at, lost.out).hash == 0;
      visit_lost(level + 1, own, is_empty, other_is_empty, lost);
    });
    return;
  }
  if (const auto* const section = std::get_if<Section>(&innermost_)) {
    section->add_pieces(lost.in.section, pieces);
    std::vector<Piece<double>> others;
    if (!out_is_empty) section->add_pieces(lost.out.section, others);
    for (const Piece<double>& other : others) ends.insert(ends.end(), {other.lower, other.upper});
    for_each_node(pieces, ends, [&](double v, double own) {
      const Intervals in = section->columns(v, lost.in.registers, lost.in.section);
      Intervals out = section->columns(v, lost.out.registers, lost.out.section);
      if (out_is_empty) out.clear();
      visit_columns(difference(in, out), v, own, lost);
    });
    return;
  }
  const auto columns = [](const ColumnRoom& room) {
    Intervals found;
    for (const auto& piece : room.pieces) found.push_back({piece.lower.first, piece.upper.first});
    return found;
  };
  visit_columns(difference(columns(lost.in.column), out_is_empty ? Intervals() : columns(lost.out.column)), 0, weight,
                lost);
}

void SectionsIntegral::visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                                     const Lost& lost) const {
  static const GaussRule rule = gauss_legendre(4);
  for (const auto& [from, to] : columns)
    pkm::visit_nodes(Piece<double>{from, to}, rule, [&](double z, double jacobian, double own) {
      const double slope = slope_of_violated(v, z, lost);
      if (slope != 0 && std::isfinite(slope)) lost.visit(weight * jacobian * own, slope);
    });
}

/// How much the constraint that a point violates on the side `out` changes with the coordinate of the break; in.own: by
/// the registers of the stages before. 0: no constraint is.
double SectionsIntegral::slope_of_violated(double v, double z, const Lost& lost) const {
  const SectionPlan& plan = this->plan();
  const auto& stages = plan.program.stages();
  const bool are_lines = ends_in_lines();
  for (IntegralRoom* const room : {&lost.in, &lost.out})
    for (std::size_t stage = levels() + 1; stage < stages.size(); ++stage) {
      for (const auto& input : stages[stage].inputs) room->registers[input.to] = are_lines ? z : v;
      plan.program.run<double>(stage, std::span(room->registers));
    }
  std::vector<double>& by = lost.in.own;
  by.assign(plan.program.registers(), 0);
  const auto slope = [&] {
    for (std::size_t stage = stages.size() - 1;; --stage) {
      backward_sweep(plan.program, stage, lost.in.registers, by);
      double sum = 0;
      for (const auto& input : stages[stage].inputs) {
        sum += by[input.to];
        by[input.to] = 0;
      }
      if (stage == lost.level + 1) return sum;
    }
  };
  for (std::size_t stage = lost.level + 1; stage < plan.plain.size(); ++stage)
    for (const std::uint32_t at : plan.plain[stage])
      if (!is_satisfied(lost.out.registers[at]) && is_satisfied(lost.in.registers[at])) {
        by[at] = 1;
        return slope();
      }
  const std::array<double, 6> powers = are_lines ? std::array<double, 6>{1, z, z * z, z * z * z, z * z * z * z, 0}
                                                 : std::array<double, 6>{1, v, z, v * v, v * z, z * z};
  const auto signs_of = [&](const IntegralRoom& room) {
    Signs signs = 0;
    for (std::size_t k = 0; k < plan.surfaces.size(); ++k) {
      const Surface& surface = plan.surfaces[k];
      double value = 0;
      for (std::size_t i = 0; i < (surface.is_curve ? 1 : powers.size()); ++i)
        value += powers[i] * room.registers[surface.coefficients[i]];
      if (is_satisfied(value)) signs |= bit(k);
    }
    return signs;
  };
  const Signs in = signs_of(lost.in), changed = in ^ signs_of(lost.out);
  if (changed == 0) return 0;
  std::size_t violated = static_cast<std::size_t>(std::countr_zero(changed));
  for (Signs rest = changed; rest != 0; rest &= rest - 1)
    if (const auto k = static_cast<std::size_t>(std::countr_zero(rest));
        !plan.formula.holds(in ^ bit(k), lost.in.registers.data())) {
      violated = k;
      break;
    }
  const Surface& surface = plan.surfaces[violated];
  for (std::size_t i = 0; i < (surface.is_curve ? 1 : powers.size()); ++i) by[surface.coefficients[i]] += powers[i];
  return slope();
}

}  // namespace pkm::generic
