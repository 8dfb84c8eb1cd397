#include "engine/generic/columns/nested_integral.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/stop.hpp"
#include "engine/math/hash.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

// Minimum width of an interval, relative to the range of the coordinate; narrower intervals are ignored.
constexpr double kMinWidth = 1e-12;
// In intervals whose width, relative to the range of the coordinate, is smaller, rounding errors can mix slices of
// different types.
constexpr double kMinResolvableWidth = 1e-6;
constexpr double kMinResolvableWidthInLines = 1e-4;  // kMinResolvableWidth for slices that are lines
constexpr std::size_t kMaxIntervals = 3000;
// If, in this many consecutive bisections, nearly all of a change of the measure is in one half, the measure is
// discontinuous there.
constexpr int kBisectionsOfJump = 5;
// At this depth of the subdivision and beyond, an interval is not divided at changes of the slice type if its error is
// at most kNoise times the error that the tolerance permits for a workspace that fills the whole range.
constexpr int kReliableDepth = 2;
constexpr double kNoise = 0.01;
// Tolerance of SmoothInterval::missed_at_ends, relative to the largest slice, if derivatives will be computed.
constexpr double kEndTolerance = 1e-7;

/// Polynomial through the measures of the slices at the nodes of kronrod_rule(), evaluated at t in [0, 1] by the
/// barycentric formula.
double through_nodes(const std::array<Slice, NestedRule::kNodes>& slices, double t) {
  static const std::array<double, NestedRule::kNodes> kWeights = [] {
    std::array<double, NestedRule::kNodes> weights;
    const auto& node = kronrod_rule().node;
    for (std::size_t i = 0; i < node.size(); ++i) {
      double product = 1;
      for (std::size_t j = 0; j < node.size(); ++j)
        if (j != i) product *= 4 * (node[i] - node[j]);
      weights[i] = 1 / product;
    }
    return weights;
  }();
  double above = 0, below = 0;
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
    const double term = kWeights[i] / (t - kronrod_rule().node[i]);
    above += term * slices[i].measure;
    below += term;
  }
  return above / below;
}

/// Maximum error, at the endpoints of an interval, of the polynomial through the measures of the slices at its nodes. A
/// square-root singularity just outside the interval hardly affects the integral, but it affects derivatives: that of
/// sqrt(t^2 + e) with respect to e is as large as 1/sqrt(e) between 0 and the first node.
double missed_at_ends(const SmoothInterval& part, const std::array<Slice, NestedRule::kNodes>& slices) {
  const auto& piece = part.piece;
  const double width = piece.upper - piece.lower, both = piece.sqrt_at_lower && piece.sqrt_at_upper ? 3 : 1;
  const double from = (part.below.at - piece.lower) / width, to = (piece.upper - part.above.at) / width;
  const double at_lower = through_nodes(slices, piece.sqrt_at_lower ? std::sqrt(from / both) : from);
  const double at_upper = through_nodes(slices, 1 - (piece.sqrt_at_upper ? std::sqrt(to / both) : to));
  return std::max(std::fabs(at_lower - part.below.measure), std::fabs(at_upper - part.above.measure));
}

/// The interval between two adjacent critical values, not yet integrated.
SmoothInterval interval_between(const CriticalValue& lower, const CriticalValue& upper) {
  const auto closing = [](const CriticalValue& at, const Slice& outside) {
    return at.is_box ? kBox : outside.hash == 0 ? outside.violated : kCriticalValue;
  };
  return {.piece = {lower.at, upper.at, lower.root, upper.root},
          .below = lower.above,
          .above = upper.below,
          .lower = closing(lower, lower.below),
          .upper = closing(upper, upper.above),
          .beyond_lower = lower.below.measure,
          .beyond_upper = upper.above.measure};
}

/// Whether one half of an interval contains nearly all of the change of the measure across it, as at a discontinuity.
/// At a square-root singularity at one end the half next to it contains 71 % of the change.
bool is_one_sided(const Slice& below, const Slice& middle, const Slice& above) {
  const double first = std::fabs(middle.measure - below.measure), second = std::fabs(above.measure - middle.measure);
  return std::max(first, second) > 0.95 * (first + second);
}

}  // namespace

NestedIntegral::NestedIntegral(SlicePlan plan, double tolerance)
    : innermost_(plan.order.v ? std::variant<PlanarSlice, Column>(PlanarSlice(std::move(plan)))
                              : std::variant<PlanarSlice, Column>(Column(std::move(plan)))),
      tolerance_(tolerance) {
  const SlicePlan& own = this->plan();
  const std::vector<std::uint32_t>& outputs = own.univariate.outputs();
  for (std::size_t i = 0; i < outputs.size(); i += 2) univariate_.push_back({outputs[i], outputs[i + 1]});
  // Columns with transcendental constraints are evaluated one by one, because these constraints depend on all preceding
  // stages.
  if (!ends_in_lines() || levels() == 0 || std::ranges::any_of(own.surfaces, &Surface::is_transcendental)) return;
  const auto stage = static_cast<int>(levels());
  const auto keep = [&](std::uint32_t at) {
    if (own.program.stage_of()[at] == stage && std::ranges::find(line_registers_, at) == line_registers_.end())
      line_registers_.push_back(at);
  };
  for (const Surface& surface : own.surfaces) std::ranges::for_each(surface.coefficients, keep);
  for (const CrankSigns& crank : own.formula.cranks) keep(crank.half_turn);
  for (const auto& ends : own.range) std::ranges::for_each(ends, keep);
  std::ranges::for_each(own.independent[levels()], keep);
  lines_.emplace(own.program, levels(), line_registers_);
}

Integral<double> NestedIntegral::measure(std::span<const double> inputs, IntegralScratch& scratch,
                                         const Budget& budget) const {
  scratch.for_gradient = false;
  return measure_all(inputs, scratch, budget);
}

Integral<double> NestedIntegral::measure_for_gradient(std::span<const double> inputs, IntegralScratch& scratch) const {
  scratch.for_gradient = true;
  return measure_all(inputs, scratch, {});
}

Integral<double> NestedIntegral::measure_all(std::span<const double> inputs, IntegralScratch& scratch,
                                             const Budget& budget) const {
  start(inputs, scratch, budget);
  const double unknown = find_univariate_changes(inputs, scratch);
  const Slice all = inside(0, scratch);
  const long evaluations = std::exchange(scratch.evaluations, 0);
  // The limit of evaluations applies to the search for critical values only; for_each_node() and add_gradient()
  // evaluate few nodes.
  scratch.max_evaluations = std::numeric_limits<long>::max();
  scratch.measured = true;
  return {all.measure, all.error + unknown, evaluations};
}

long NestedIntegral::operations_of_middle_slice(std::span<const double> inputs, IntegralScratch& scratch,
                                                long limit) const {
  start(inputs, scratch, {.operations = limit});
  scratch.levels[1].seen_count = 0;
  scratch.is_scanning = true;
  const auto [from, to] = plan().range[0];
  slice(0, 0.5 * (scratch.registers[from] + scratch.registers[to]), scratch);
  scratch.is_scanning = false;
  return scratch.column.operations;
}

void NestedIntegral::start(std::span<const double> inputs, IntegralScratch& scratch, const Budget& budget) const {
  const expression::Program& program = plan().program;
  scratch.registers.resize(program.registers());
  scratch.levels.resize(levels() + 1);
  scratch.evaluations = 0;
  scratch.max_evaluations = budget.evaluations > 0 ? budget.evaluations : levels() < 2 ? 100'000 : 20'000'000;
  for (IntegralScratch::Level& level : scratch.levels) level.largest = 0;
  program.start<double>(scratch.registers);
  program.run<double>(0, inputs, scratch.registers);
  scratch.column.operations = 0;
  scratch.column.max_operations = budget.operations;
  scratch.measured = scratch.has_hints = false;
  scratch.kept.clear();
}

void NestedIntegral::set(std::size_t level, double at, IntegralScratch& scratch) const {
  scratch.levels[level].at = at;
  for (const auto& input : plan().program.stages()[level + 1].inputs) scratch.registers[input.to] = at;
  plan().program.run<double>(level + 1, std::span<double>(scratch.registers));
}

bool NestedIntegral::is_exhausted(const IntegralScratch& scratch) const {
  return scratch.evaluations >= scratch.max_evaluations || scratch.column.operations >= scratch.column.max_operations;
}

double NestedIntegral::find_univariate_changes(std::span<const double> inputs, IntegralScratch& scratch) const {
  constexpr long kMaxEvaluations = 40'000;
  constexpr double kMaxUndecidedShare = 0.01;
  scratch.changes.found.clear();
  if (univariate_.empty()) return 0;
  const expression::Program& program = plan().univariate;
  scratch.univariate.resize(program.registers());
  program.start<double>(scratch.univariate);
  program.run<double>(0, inputs, scratch.univariate);
  const auto range = [&](std::size_t i) {
    return std::array{scratch.registers[plan().range[i][0]], scratch.registers[plan().range[i][1]]};
  };
  const auto [low, high] = range(0);
  if (!(high > low)) return 0;
  find_sign_changes(program, 1, univariate_, low, high, kMaxEvaluations, scratch.univariate, scratch.changes);
  double unknown = scratch.changes.undecided;
  // The undecided part of the range is so large that the measure remains unknown: do not search for critical values.
  if (unknown > kMaxUndecidedShare * (high - low)) scratch.max_evaluations = 0;
  for (std::size_t i = 1; i < plan().range.size() && unknown > 0; ++i) unknown *= std::fabs(range(i)[1] - range(i)[0]);
  return unknown;
}

Slice NestedIntegral::inside(std::size_t level, IntegralScratch& scratch) const {
  const auto& independent = plan().independent[level];
  for (std::size_t i = 0; i < independent.size(); ++i)
    if (!is_satisfied(scratch.registers[independent[i]])) return {.violated = static_cast<std::uint32_t>(i + 1)};
  if (level < levels()) return integrate(level, scratch);
  // Number of columns that are evaluated between two checks for a stop request; a column takes about a microsecond.
  constexpr long kColumnsPerCheck = 16;
  if (!ends_in_lines() || scratch.evaluations % kColumnsPerCheck == 0 || is_long(scratch.column)) check_stop();
  ++scratch.evaluations;
  if (const auto* const planar_slice = std::get_if<PlanarSlice>(&innermost_)) {
    const double area = planar_slice->measure(scratch.registers, scratch.planar_slice,
                                              levels() == 0 ? &scratch.changes.found : nullptr);
    return {.measure = area, .hash = scratch.planar_slice.type};
  }
  const double length = std::get<Column>(innermost_).measure(scratch.registers, scratch.column);
  return {.measure = length, .error = scratch.column.error, .hash = scratch.column.type};
}

Slice NestedIntegral::slice(std::size_t level, double at, IntegralScratch& scratch) const {
  set(level, at, scratch);
  if (level == 0 && scratch.has_hints) add_hints(at, scratch);
  return set_slice(level, at, scratch);
}

Slice NestedIntegral::set_slice(std::size_t level, double at, IntegralScratch& scratch) const {
  Slice found = inside(level + 1, scratch);
  found.at = at;
  if (!scratch.measured) scratch.levels[level].largest = std::max(scratch.levels[level].largest, found.measure);
  return found;
}

/// Computes the slices at the values `places` of the coordinate of `level`. If the slices are lines, those operations
/// of the program that differ between them are evaluated in SIMD batches.
void NestedIntegral::find_slices(std::size_t level, std::span<const double> places, std::span<Slice> slices,
                                 IntegralScratch& scratch) const {
  if (!lines_ || level + 1 < levels()) {
    for (std::size_t i = 0; i < places.size(); ++i) slices[i] = slice(level, places[i], scratch);
    return;
  }
  scratch.rows.resize(lines_->slots() * expression::kRow);
  for (std::size_t first = 0; first < places.size(); first += expression::kRow) {
    const auto now = places.subspan(first, std::min(expression::kRow, places.size() - first));
    const std::size_t count = (now.size() + kLanes - 1) / kLanes * kLanes;
    for (const std::uint32_t input : lines_->inputs()) {
      double* const row = &scratch.rows[input * expression::kRow];
      std::fill(std::copy(now.begin(), now.end(), row), row + count, now.back());
    }
    lines_->run(scratch.registers.data(), scratch.rows.data(), count);
    for (std::size_t i = 0; i < now.size(); ++i) {
      for (const std::uint32_t at : line_registers_)
        scratch.registers[at] = scratch.rows[lines_->operand(at).index * expression::kRow + i];
      slices[first + i] = set_slice(level, now[i], scratch);
    }
  }
}

Slice NestedIntegral::integrate(std::size_t level, IntegralScratch& scratch) const {
  IntegralScratch::Level& own = scratch.levels[level];
  own.parts.clear();
  own.irreducible_error = 0;
  own.scanned.clear();
  scratch.levels[level + 1].seen_count = 0;
  const auto [from, to] = plan().range[level];
  const double low = scratch.registers[from], high = scratch.registers[to], whole = high - low;
  if (!(whole > 0)) return {};
  CriticalValues& critical_values = own.critical_values[0];
  choose_samples(level, low, high, scratch);
  if (level == 0) add_samples_between_changes(low, high, scratch);
  if (level == 0) scratch.is_scanning = true;
  own.scanned.resize(own.places.size());
  find_slices(level, own.places, own.scanned, scratch);
  if (level == 0) search_empty_gaps(scratch);
  if (levels() == 1 && !ends_in_lines()) refine_support(scratch);
  if (level == 0) scratch.is_scanning = false;
  if (level + 1 < levels()) resample_changes(level, scratch);
  find_all_critical_values(level, low, high, critical_values, scratch);
  add_intervals(level, critical_values, whole, 0, scratch);
  refine(level, whole, scratch);

  std::sort(own.parts.begin(), own.parts.end(),
            [](const SmoothInterval& x, const SmoothInterval& y) { return x.piece.lower < y.piece.lower; });
  Slice sum;
  sum.error = own.irreducible_error;
  Fnv1a hash;
  std::uint64_t last = 0;
  for (const SmoothInterval& part : own.parts) {
    sum.measure += part.value;
    sum.error += part.error + part.irreducible_error;
    if (part.below.hash != last) hash.add(part.below.hash);
    last = part.below.hash;
    // If the independent constraint that bounds an interval is replaced by another one, the measure can be
    // discontinuous although the type of the interval's slices is unchanged: make the hash depend on the constraint.
    for (const IntervalBound closing : {part.lower, part.upper})
      if (closing != kCriticalValue) hash.add(closing);
  }
  if (!own.parts.empty()) {
    sum.hash = hash.value() | 1U;
    if (level > 0) record_intervals(scratch.levels[level - 1].at, own);
  }
  return sum;
}

/// Finds the critical values between the slices in Level::scanned, and adds the ends of the range.
void NestedIntegral::find_all_critical_values(std::size_t level, double low, double high,
                                              CriticalValues& critical_values, IntegralScratch& scratch) const {
  std::vector<Slice>& scanned = scratch.levels[level].scanned;
  critical_values.assign(1, {low, false, {}, scanned.front(), true});
  for (std::size_t i = 1; i < scanned.size(); ++i)
    find_critical_values(level, scanned[i - 1], scanned[i], high - low, critical_values, scratch);
  critical_values.push_back({high, false, scanned.back(), {}, true});
}

void NestedIntegral::add_intervals(std::size_t level, const CriticalValues& critical_values, double whole, int depth,
                                   IntegralScratch& scratch) const {
  for (std::size_t i = 1; i < critical_values.size(); ++i) {
    const CriticalValue &lower = critical_values[i - 1], &upper = critical_values[i];
    scratch.levels[level].irreducible_error += lower.missed_error;
    if (lower.above.hash == 0 && upper.below.hash == 0) continue;
    add_interval(level, interval_between(lower, upper), whole, depth, scratch);
  }
}

void NestedIntegral::place_nodes(std::span<const double> inputs, std::span<const double> critical_values,
                                 IntegralScratch& scratch) const {
  scratch.for_gradient = true;
  start(inputs, scratch, {});
  scratch.levels[0].parts.clear();
  const auto& independent = plan().independent[0];
  if (std::ranges::all_of(independent, [&](std::uint32_t at) { return is_satisfied(scratch.registers[at]); }))
    place_intervals(critical_values, scratch);
  scratch.measured = true;
}

/// Divides the range of the only outer coordinate at its critical values, given to an accuracy below kBeside: they are
/// bracketed between two slices beside them, because derivatives need more digits at roots of even order.
void NestedIntegral::place_intervals(std::span<const double> values, IntegralScratch& scratch) const {
  // Relative to the range of the coordinate: distance from a critical value of the two slices that bracket it, and
  // distance within which critical values are bracketed together.
  constexpr double kBeside = 1e-6, kTogether = 4 * kBeside;
  IntegralScratch::Level& own = scratch.levels[0];
  const auto [from, to] = plan().range[0];
  const double low = scratch.registers[from], high = scratch.registers[to], whole = high - low;
  if (!(whole > 0)) return;
  own.places.assign(1, low + kClearDistance * whole);
  const auto add = [&](double at) {
    if (at > own.places.back() && at < high - kClearDistance * whole) own.places.push_back(at);
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] - values[i - 1] > kTogether * whole) add(values[i] - kBeside * whole);
    if (i + 1 == values.size() || values[i + 1] - values[i] > kTogether * whole) add(values[i] + kBeside * whole);
  }
  own.places.push_back(high - kClearDistance * whole);
  own.scanned.resize(own.places.size());
  find_slices(0, own.places, own.scanned, scratch);
  CriticalValues& critical_values = own.critical_values[0];
  find_all_critical_values(0, low, high, critical_values, scratch);
  for (std::size_t i = 1; i < critical_values.size(); ++i) {
    const CriticalValue &lower = critical_values[i - 1], &upper = critical_values[i];
    if ((lower.above.hash != 0 || upper.below.hash != 0) && upper.at - lower.at >= kMinWidth * whole)
      own.parts.push_back(interval_between(lower, upper));
  }
}

/// Integrates over an interval by the Gauss-Kronrod rule. If its nodes differ in type, it is first divided at the
/// critical values between them; this is why this folder does not use refine() of math/quadrature.hpp.
void NestedIntegral::add_interval(std::size_t level, SmoothInterval part, double whole, int depth,
                                  IntegralScratch& scratch) const {
  IntegralScratch::Level& own = scratch.levels[level];
  const double width = part.piece.upper - part.piece.lower;
  if (width < kMinWidth * whole) {
    // The width is negative if slices next to a critical value lie beyond the next critical value: the overlap then
    // counts twice.
    own.irreducible_error += std::fabs(width) * std::max(part.below.measure, part.above.measure);
    return;
  }
  const NestedRule& rule = kronrod_rule();
  const NestedRule::Level& weights = rule.level.front();
  std::array<double, NestedRule::kNodes> jacobians;
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
    const auto [at, jacobian] = map_node(part.piece, rule.node[i]);
    part.at[i] = at;
    jacobians[i] = jacobian;
  }
  std::array<Slice, NestedRule::kNodes> slices;
  if (scratch.for_gradient && level == 0 && levels() == 2) {
    part.kept = scratch.kept.size();
    for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
      slices[i] = slice(level, part.at[i], scratch);
      scratch.kept.push_back(scratch.levels[1].parts);
    }
  } else {
    find_slices(level, part.at, slices, scratch);
  }
  double embedded = 0, spread = 0;
  bool same = part.below.hash == part.above.hash;
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
    const double jacobian = jacobians[i];
    part.weight[i] = jacobian * weights.weight[i];
    part.value += part.weight[i] * slices[i].measure;
    part.irreducible_error += part.weight[i] * slices[i].error;
    embedded += jacobian * weights.fewer[i] * slices[i].measure;
    same = same && slices[i].hash == part.below.hash;
  }
  // rule_error() would add the terms in another order, and rounding errors would then decide which of two symmetric
  // intervals is bisected first.
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i)
    spread += weights.weight[i] * std::fabs(slices[i].measure * part.weight[i] / weights.weight[i] - part.value);
  part.error = quadpack_error(std::fabs(part.value - embedded), spread);
  // Where the boundary has cusps, rounding errors change the type of an outer slice repeatedly.
  const bool is_noise =
      level + 1 < levels() && depth >= kReliableDepth && part.error <= kNoise * tolerance_ * own.largest * whole;
  if (!same && depth < kMaxDepth && !is_noise &&
      width > (ends_in_lines() ? kMinResolvableWidthInLines : kMinResolvableWidth) * whole && !is_exhausted(scratch)) {
    CriticalValues& critical_values = own.critical_values[static_cast<std::size_t>(depth) + 1];
    const Slice below{.measure = part.beyond_lower, .violated = part.lower};
    const Slice above{.measure = part.beyond_upper, .violated = part.upper};
    critical_values.assign(1, {part.piece.lower, part.piece.sqrt_at_lower, below, part.below, part.lower == kBox});
    Slice before = part.below;
    for (Slice& next : slices) {
      find_critical_values(level, before, next, whole, critical_values, scratch);
      before = next;
    }
    find_critical_values(level, before, part.above, whole, critical_values, scratch);
    critical_values.push_back({part.piece.upper, part.piece.sqrt_at_upper, part.above, above, part.upper == kBox});
    return add_intervals(level, critical_values, whole, depth + 1, scratch);
  }
  if (scratch.for_gradient && same) part.missed_at_ends = missed_at_ends(part, slices);
  if (!same && !is_noise) {
    const auto [least, largest] = std::ranges::minmax(slices, {}, &Slice::measure);
    part.irreducible_error += width * (largest.measure - least.measure);
  }
  own.parts.push_back(part);
}

/// Bisects the interval with the largest error until the total error is small enough; then bisects the intervals at
/// whose endpoints the polynomial through the nodes is inaccurate.
void NestedIntegral::refine(std::size_t level, double whole, IntegralScratch& scratch) const {
  IntegralScratch::Level& own = scratch.levels[level];
  // The error of an inner integral may be as large as the error that is accepted for the largest inner integral.
  const double share = level == 0 ? 1 : ends_in_lines() ? 0.5 : 0.1;
  const double least = level == 0 ? 0 : share * tolerance_ * scratch.levels[level - 1].largest;
  const double may_miss = std::max(kEndTolerance, 10 * tolerance_) * own.largest;
  const auto misses = [&](const SmoothInterval& part) {
    return part.missed_at_ends > may_miss && part.piece.upper - part.piece.lower > kMinWidth * whole;
  };
  while (own.parts.size() < kMaxIntervals && !is_exhausted(scratch)) {
    double value = 0, error = 0;
    for (const SmoothInterval& part : own.parts) {
      value += part.value;
      error += part.error;
    }
    const bool is_vague = error > std::max({least, share * tolerance_ * value, 1e-15 * value});
    const auto at = is_vague ? std::ranges::max_element(own.parts, {}, &SmoothInterval::error)
                             : std::ranges::find_if(own.parts, misses);
    if (at == own.parts.end()) return;
    const SmoothInterval part = *at;
    own.parts.erase(at);
    const auto [first, second] = halves(part.piece);
    const Slice middle = slice(level, first.upper, scratch);
    const double change = std::fabs(part.above.measure - part.below.measure);
    const bool may_be_jump = level + 1 < levels() && change > kDiscontinuity * own.largest;
    const int one_sided_bisections =
        may_be_jump && is_one_sided(part.below, middle, part.above) ? part.one_sided_bisections + 1 : 0;
    if (one_sided_bisections == kBisectionsOfJump) own.irreducible_error += change * whole / kSamplesOfLines;
    SmoothInterval low{.piece = first,
                       .below = part.below,
                       .above = middle,
                       .lower = part.lower,
                       .one_sided_bisections = one_sided_bisections};
    low.beyond_lower = part.beyond_lower;
    low.beyond_upper = middle.measure;
    SmoothInterval high{.piece = second,
                        .below = middle,
                        .above = part.above,
                        .upper = part.upper,
                        .one_sided_bisections = one_sided_bisections};
    high.beyond_lower = middle.measure;
    high.beyond_upper = part.beyond_upper;
    add_interval(level, low, whole, 0, scratch);
    add_interval(level, high, whole, 0, scratch);
  }
}

}  // namespace pkm::generic
