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
#include "engine/generic/columns/nested_integral.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

// Distance from the critical value, relative to the range of the coordinate, of the two slices that are compared.
constexpr double kOffset = 1e-9;
// Factor by which the distance kOffset from the critical value is larger for a second pair of slices, which shows
// whether there is a square-root singularity.
constexpr double kSecondOffset = 10;
// If the change of the measure, relative to the largest slice, is smaller, a discontinuity cannot be distinguished from
// a continuous change.
constexpr double kNegligible = 1e-6;

using Intervals = std::vector<std::array<double, 2>>;

/// The parts of the intervals x that no interval of y covers. Each list contains disjoint intervals in ascending order.
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

/// Divides intervals at the given points, at which the integrand can have square-root singularities.
std::vector<Subinterval<double>> divided(const std::vector<Subinterval<double>>& pieces, std::vector<double> places) {
  // Points within this distance from the ends of an interval, relative to the interval's length, do not divide it.
  constexpr double kInset = 1e-6;
  std::ranges::sort(places);
  std::vector<Subinterval<double>> all;
  for (Subinterval<double> rest : pieces) {
    const double inset = kInset * (rest.upper - rest.lower), end = rest.upper - inset;
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

/// Discontinuity at the lower or upper endpoint of an interval: the measure just above the endpoint minus that just
/// below.
double step_at(const SmoothInterval& part, bool upper) {
  return upper ? part.beyond_upper - part.above.measure : part.below.measure - part.beyond_lower;
}

}  // namespace

/// The set of points of a slice that are feasible on one side of a critical value and infeasible on the other side.
/// `in` and `out` are the scratch memories of the slices on these two sides.
struct NestedIntegral::OneSided {
  std::size_t level;  ///< nesting level of the integral over the coordinate to which the critical value belongs
  IntegralScratch &in, &out;
  const OneSidedVisitor& visit;
};

bool NestedIntegral::may_jump(std::size_t level, const SmoothInterval& part, bool upper,
                              const IntegralScratch& scratch) {
  if ((upper ? part.upper : part.lower) != kCriticalValue) return false;
  return std::fabs(step_at(part, upper)) > kDiscontinuity * scratch.levels[level].largest;
}

void NestedIntegral::visit_one_sided(std::size_t level, const SmoothInterval& part, bool upper, double side,
                                     IntegralScratch& scratch, const OneSidedVisitor& visit) const {
  if (!scratch.other) scratch.other = std::make_unique<IntegralScratch>();
  IntegralScratch& out = *scratch.other;
  out.registers = scratch.registers;
  out.column.operations = 0;
  out.column.max_operations = scratch.column.max_operations;
  out.levels.resize(scratch.levels.size());
  for (std::size_t i = 0; i < out.levels.size(); ++i) {
    const IntegralScratch::Level& own = scratch.levels[i];
    out.levels[i].largest = own.largest;
    if (i <= level) continue;                   // the outer coordinates are fixed
    out.levels[i].seen_count = own.seen_count;  // the slice `out` expects intervals where `in` has found them
    out.levels[i].seen.assign(own.seen.begin(), own.seen.begin() + static_cast<std::ptrdiff_t>(own.seen_count));
  }
  out.measured = true;
  out.for_gradient = scratch.for_gradient;
  out.has_hints = scratch.has_hints;
  if (scratch.has_hints) out.search = scratch.search;
  out.evaluations = 0;
  out.max_evaluations = scratch.max_evaluations;
  const auto [from, to] = plan().range[level];
  const double at = upper ? part.piece.upper : part.piece.lower;
  const double step = side * kOffset * (scratch.registers[to] - scratch.registers[from]);
  const double largest = scratch.levels[level].largest;
  std::array<Slice, 2> inside, outside;
  std::array<double, 2> one_sided_points{};
  const auto measure = [&](std::size_t i) {
    const double distance = i == 0 ? step : kSecondOffset * step;
    inside[i] = slice(level, at + distance, scratch);
    outside[i] = slice(level, at - distance, out);
    one_sided_points[i] = inside[i].measure - outside[i].measure;
  };
  measure(1);
  measure(0);
  // A square-root singularity at the critical value is no discontinuity: assume measure = jump + c sqrt(distance).
  const double root = std::sqrt(kSecondOffset);
  const bool like_root = std::fabs(one_sided_points[1] - one_sided_points[0]) > kDiscontinuity * largest;
  const double jump = like_root ? (root * one_sided_points[0] - one_sided_points[1]) / (root - 1) : one_sided_points[0];
  if (std::fabs(jump) <= kNegligible * largest) return;
  // If another critical value is near, the square-root singularity can begin there. A discontinuity, in contrast,
  // exists directly at the endpoint, too.
  if (!(side * step_at(part, upper) / jump > 0.5)) return;
  const OneSided set{level, scratch, out, visit};
  visit_one_sided(level + 1, like_root ? root / (root - 1) : 1, inside[0].hash == 0, outside[0].hash == 0, set);
  if (!like_root) return;
  measure(1);
  visit_one_sided(level + 1, -1 / (root - 1), inside[1].hash == 0, outside[1].hash == 0, set);
}

double NestedIntegral::unexplained_jump(std::size_t level, const CriticalValue& at, IntegralScratch& scratch) const {
  const double jump = at.above.measure - at.below.measure;
  const SmoothInterval below{.piece = {at.at, at.at}, .above = at.below, .beyond_upper = at.above.measure};
  double explained = 0;
  visit_one_sided(level, below, true, jump > 0 ? 1 : -1, scratch, [&](double weight, double) { explained += weight; });
  return std::max(0.0, std::fabs(jump) - explained);
}

/// Calls one_sided_points.visit for the quadrature points from `level` on that are feasible in the slice `in` and
/// infeasible in the slice `out`. To be called after inside(level) for both slices.
void NestedIntegral::visit_one_sided(std::size_t level, double weight, bool in_is_empty, bool out_is_empty,
                                     const OneSided& one_sided_points) const {
  if (in_is_empty) return;
  const NestedRule& rule = kronrod_rule();
  const auto for_each_node = [&](const std::vector<Subinterval<double>>& pieces, const std::vector<double>& ends,
                                 const auto& visit) {
    for (const Subinterval<double>& piece : divided(pieces, ends))
      for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
        const auto [at, jacobian] = map_node(piece, rule.node[i]);
        visit(at, weight * jacobian * rule.level.front().weight[i]);
      }
  };
  std::vector<Subinterval<double>> pieces;
  std::vector<double> ends;
  if (level < levels()) {
    for (const SmoothInterval& part : one_sided_points.in.levels[level].parts) pieces.push_back(part.piece);
    if (!out_is_empty)
      for (const SmoothInterval& part : one_sided_points.out.levels[level].parts)
        ends.insert(ends.end(), {part.piece.lower, part.piece.upper});
    for_each_node(pieces, ends, [&](double at, double own) {
      const bool is_empty = slice(level, at, one_sided_points.in).hash == 0;
      bool other_is_empty = true;
      if (out_is_empty)
        set(level, at, one_sided_points.out);
      else
        other_is_empty = slice(level, at, one_sided_points.out).hash == 0;
      visit_one_sided(level + 1, own, is_empty, other_is_empty, one_sided_points);
    });
    return;
  }
  if (const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_)) {
    planar_slice->append_smooth_intervals(one_sided_points.in.planar_slice, pieces);
    std::vector<Subinterval<double>> others;
    if (!out_is_empty) planar_slice->append_smooth_intervals(one_sided_points.out.planar_slice, others);
    for (const Subinterval<double>& other : others) ends.insert(ends.end(), {other.lower, other.upper});
    for_each_node(pieces, ends, [&](double v, double own) {
      const Intervals in = planar_slice->columns(v, one_sided_points.in.registers, one_sided_points.in.planar_slice);
      Intervals out = planar_slice->columns(v, one_sided_points.out.registers, one_sided_points.out.planar_slice);
      if (out_is_empty) out.clear();
      visit_columns(difference(in, out), v, own, one_sided_points);
    });
    return;
  }
  const auto columns = [](const ColumnScratch& scratch) {
    Intervals found;
    for (const auto& piece : scratch.pieces) found.push_back({piece.lower.first, piece.upper.first});
    return found;
  };
  visit_columns(difference(columns(one_sided_points.in.column),
                           out_is_empty ? Intervals() : columns(one_sided_points.out.column)),
                0, weight, one_sided_points);
}

void NestedIntegral::visit_columns(const std::vector<std::array<double, 2>>& columns, double v, double weight,
                                   const OneSided& one_sided_points) const {
  static const GaussRule rule = gauss_legendre(4);
  for (const auto& [from, to] : columns)
    pkm::visit_nodes(Subinterval<double>{from, to}, rule, [&](double z, double jacobian, double own) {
      const double slope = slope_of_violated(v, z, one_sided_points);
      if (slope != 0 && std::isfinite(slope)) one_sided_points.visit(weight * jacobian * own, slope);
    });
}

/// Derivative, with respect to the coordinate of the critical value, of the constraint that a point violates in the
/// slice `out`; 0 if it violates none. in.own receives the derivatives of this constraint with respect to the registers
/// of the previous stages.
double NestedIntegral::slope_of_violated(double v, double z, const OneSided& one_sided_points) const {
  const SlicePlan& plan = this->plan();
  const auto& stages = plan.program.stages();
  const bool are_lines = ends_in_lines();
  for (IntegralScratch* const scratch : {&one_sided_points.in, &one_sided_points.out})
    for (std::size_t stage = levels() + 1; stage < stages.size(); ++stage) {
      for (const auto& input : stages[stage].inputs) scratch->registers[input.to] = are_lines ? z : v;
      plan.program.run<double>(stage, std::span(scratch->registers));
    }
  std::vector<double>& by = one_sided_points.in.own;
  by.assign(plan.program.registers(), 0);
  const auto slope = [&] {
    for (std::size_t stage = stages.size() - 1;; --stage) {
      backward_sweep(plan.program, stage, one_sided_points.in.registers, by);
      double sum = 0;
      for (const auto& input : stages[stage].inputs) {
        sum += by[input.to];
        by[input.to] = 0;
      }
      if (stage == one_sided_points.level + 1) return sum;
    }
  };
  for (std::size_t stage = one_sided_points.level + 1; stage < plan.independent.size(); ++stage)
    for (const std::uint32_t at : plan.independent[stage])
      if (!is_satisfied(one_sided_points.out.registers[at]) && is_satisfied(one_sided_points.in.registers[at])) {
        by[at] = 1;
        return slope();
      }
  const std::array<double, 6> powers = are_lines ? std::array<double, 6>{1, z, z * z, z * z * z, z * z * z * z, 0}
                                                 : std::array<double, 6>{1, v, z, v * v, v * z, z * z};
  const auto signs_of = [&](const IntegralScratch& scratch) {
    Signs signs = 0;
    for (std::size_t k = 0; k < plan.surfaces.size(); ++k) {
      const Surface& surface = plan.surfaces[k];
      double value = 0;
      for (std::size_t i = 0; i < (surface.is_transcendental ? 1 : powers.size()); ++i)
        value += powers[i] * scratch.registers[surface.coefficients[i]];
      if (is_satisfied(value)) signs |= bit(k);
    }
    return signs;
  };
  const Signs in = signs_of(one_sided_points.in), changed = in ^ signs_of(one_sided_points.out);
  if (changed == 0) return 0;
  std::size_t violated = static_cast<std::size_t>(std::countr_zero(changed));
  for (Signs rest = changed; rest != 0; rest &= rest - 1)
    if (const auto k = static_cast<std::size_t>(std::countr_zero(rest));
        !plan.formula.holds(in ^ bit(k), one_sided_points.in.registers.data())) {
      violated = k;
      break;
    }
  const Surface& surface = plan.surfaces[violated];
  for (std::size_t i = 0; i < (surface.is_transcendental ? 1 : powers.size()); ++i)
    by[surface.coefficients[i]] += powers[i];
  return slope();
}

}  // namespace pkm::generic
