#include "engine/generic/columns/sections_integral.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/math/hash.hpp"
#include "engine/math/lanes.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {
namespace {

constexpr double kNarrow = 1e-12;  // of the range: parts that are not looked at
constexpr double kBlurred = 1e-6;  // of the range: parts whose structures rounding may mix
constexpr double kBlurredInLines = 1e-4;
constexpr std::size_t kMostParts = 3000;
constexpr int kHalvingsOfJump = 5;  // in a row that leave nearly all of a change in one half
constexpr double kEndsMeet = 1e-7;  // of the greatest slice: where derivatives will be asked for

/// The value of the polynomial through the nodes of kronrod_rule() at t in [0, 1], by the barycentric formula.
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

/// How far the polynomial through the nodes of a part misses the slices next to its ends. A root that begins just
/// outside the part hardly changes the integral, but its derivative: that of sqrt(t^2 + e) by e is as large as
/// 1/sqrt(e) between 0 and the first node.
double missed_at_ends(const SlicePart& part, const std::array<Slice, NestedRule::kNodes>& slices) {
  const auto& piece = part.piece;
  const double width = piece.upper - piece.lower, both = piece.sqrt_at_lower && piece.sqrt_at_upper ? 3 : 1;
  const double from = (part.below.at - piece.lower) / width, to = (piece.upper - part.above.at) / width;
  const double at_lower = through_nodes(slices, piece.sqrt_at_lower ? std::sqrt(from / both) : from);
  const double at_upper = through_nodes(slices, 1 - (piece.sqrt_at_upper ? std::sqrt(to / both) : to));
  return std::max(std::fabs(at_lower - part.below.measure), std::fabs(at_upper - part.above.measure));
}

/// Whether nearly all of a change is in one half, as that of a jump is; of a root it is 71 %.
bool is_one_sided(const Slice& below, const Slice& middle, const Slice& above) {
  const double first = std::fabs(middle.measure - below.measure), second = std::fabs(above.measure - middle.measure);
  return std::max(first, second) > 0.95 * (first + second);
}

}  // namespace

SectionsIntegral::SectionsIntegral(SectionPlan plan, double tolerance)
    : innermost_(plan.order.v ? std::variant<Section, Column>(Section(std::move(plan)))
                              : std::variant<Section, Column>(Column(std::move(plan)))),
      tolerance_(tolerance) {
  const SectionPlan& own = this->plan();
  // curves are computed from whatever was before them
  if (!ends_in_lines() || levels() == 0 || std::ranges::any_of(own.surfaces, &Surface::is_curve)) return;
  const auto stage = static_cast<int>(levels());
  const auto keep = [&](std::uint32_t at) {
    if (own.program.stage_of()[at] == stage && std::ranges::find(line_registers_, at) == line_registers_.end())
      line_registers_.push_back(at);
  };
  for (const Surface& surface : own.surfaces) std::ranges::for_each(surface.coefficients, keep);
  for (const CrankSigns& crank : own.formula.cranks) keep(crank.half_turn);
  for (const auto& ends : own.range) std::ranges::for_each(ends, keep);
  std::ranges::for_each(own.plain[levels()], keep);
  lines_.emplace(own.program, levels(), line_registers_);
}

Integral<double> SectionsIntegral::measure(std::span<const double> inputs, IntegralRoom& room, long most) const {
  room.for_slopes = false;
  return measure_all(inputs, room, most);
}

Integral<double> SectionsIntegral::measure_for_slopes(std::span<const double> inputs, IntegralRoom& room) const {
  room.for_slopes = true;
  return measure_all(inputs, room, 0);
}

Integral<double> SectionsIntegral::measure_all(std::span<const double> inputs, IntegralRoom& room, long most) const {
  const expression::Program& program = plan().program;
  room.registers.resize(program.registers());
  room.levels.resize(levels() + 1);
  room.sections = 0;
  room.most = most > 0 ? most : levels() < 2 ? 100'000 : 20'000'000;
  for (IntegralRoom::Level& level : room.levels) level.greatest = 0;
  program.start<double>(room.registers);
  program.run<double>(0, inputs, room.registers);
  room.measured = room.has_hints = false;
  room.kept.clear();
  const Slice all = inside(0, room);
  room.measured = true;
  return {all.measure, all.error, room.sections};
}

void SectionsIntegral::set(std::size_t level, double at, IntegralRoom& room) const {
  room.levels[level].at = at;
  for (const auto& input : plan().program.stages()[level + 1].inputs) room.registers[input.to] = at;
  plan().program.run<double>(level + 1, std::span<double>(room.registers));
}

Slice SectionsIntegral::inside(std::size_t level, IntegralRoom& room) const {
  const auto& plain = plan().plain[level];
  for (std::size_t i = 0; i < plain.size(); ++i)
    if (!is_satisfied(room.registers[plain[i]])) return {.broken = static_cast<std::uint32_t>(i + 1)};
  if (level < levels()) return integrate(level, room);
  constexpr long kColumnsPerCheck = 16;  // a column takes a microsecond
  if (!ends_in_lines() || room.sections % kColumnsPerCheck == 0 || is_long(room.column)) check_stop();
  ++room.sections;
  const auto measured = [&](const auto& innermost, auto& own) {
    const double measure = innermost.measure(room.registers, own);
    return Slice{.measure = measure, .hash = own.structure};
  };
  const auto* const section = std::get_if<Section>(&innermost_);
  return section ? measured(*section, room.section) : measured(std::get<Column>(innermost_), room.column);
}

Slice SectionsIntegral::slice(std::size_t level, double at, IntegralRoom& room) const {
  set(level, at, room);
  if (level == 0 && room.has_hints) give_hints(at, room);
  return set_slice(level, at, room);
}

Slice SectionsIntegral::set_slice(std::size_t level, double at, IntegralRoom& room) const {
  Slice found = inside(level + 1, room);
  found.at = at;
  if (!room.measured) room.levels[level].greatest = std::max(room.levels[level].greatest, found.measure);
  return found;
}

/// What differs between lines is computed for many of them side by side.
void SectionsIntegral::find_slices(std::size_t level, std::span<const double> places, std::span<Slice> slices,
                                   IntegralRoom& room) const {
  if (!lines_ || level + 1 < levels()) {
    for (std::size_t i = 0; i < places.size(); ++i) slices[i] = slice(level, places[i], room);
    return;
  }
  room.rows.resize(lines_->slots() * expression::kRow);
  for (std::size_t first = 0; first < places.size(); first += expression::kRow) {
    const auto now = places.subspan(first, std::min(expression::kRow, places.size() - first));
    const std::size_t count = (now.size() + kLanes - 1) / kLanes * kLanes;
    for (const std::uint32_t input : lines_->inputs()) {
      double* const row = &room.rows[input * expression::kRow];
      std::fill(std::copy(now.begin(), now.end(), row), row + count, now.back());
    }
    lines_->run(room.registers.data(), room.rows.data(), count);
    for (std::size_t i = 0; i < now.size(); ++i) {
      for (const std::uint32_t at : line_registers_)
        room.registers[at] = room.rows[lines_->operand(at).index * expression::kRow + i];
      slices[first + i] = set_slice(level, now[i], room);
    }
  }
}

Slice SectionsIntegral::integrate(std::size_t level, IntegralRoom& room) const {
  IntegralRoom::Level& own = room.levels[level];
  own.parts.clear();
  own.unresolved = 0;
  own.scanned.clear();
  room.levels[level + 1].seen_count = 0;
  const auto [from, to] = plan().range[level];
  const double low = room.registers[from], high = room.registers[to], whole = high - low;
  if (!(whole > 0)) return {};
  Breaks& breaks = own.breaks[0];
  breaks.clear();
  find_places(level, low, high, room);
  if (level == 0) room.is_scanning = true;
  own.scanned.resize(own.places.size());
  find_slices(level, own.places, own.scanned, room);
  if (level == 0) look_between(room);
  if (levels() == 1 && !ends_in_lines()) look_closer(room);
  if (level == 0) room.is_scanning = false;
  if (level + 1 < levels()) look_again(level, room);
  breaks.push_back({low, false, {}, own.scanned.front(), true});
  for (std::size_t i = 1; i < own.scanned.size(); ++i)
    find_breaks(level, own.scanned[i - 1], own.scanned[i], whole, breaks, room);
  breaks.push_back({high, false, own.scanned.back(), {}, true});
  add_parts(level, breaks, whole, 0, room);
  refine(level, whole, room);

  std::sort(own.parts.begin(), own.parts.end(),
            [](const SlicePart& x, const SlicePart& y) { return x.piece.lower < y.piece.lower; });
  Slice sum;
  sum.error = own.unresolved;
  Fnv1a hash;
  std::uint64_t last = 0;
  for (const SlicePart& part : own.parts) {
    sum.measure += part.value;
    sum.error += part.error + part.unresolved;
    if (part.below.hash != last) hash.add(part.below.hash);
    last = part.below.hash;
    // What bounds a part may change, and the measure jump, while the parts stay the same.
    for (const Closing closing : {part.lower, part.upper})
      if (closing != kChange) hash.add(closing);
  }
  if (!own.parts.empty()) {
    sum.hash = hash.value() | 1U;
    if (level > 0) remember(room.levels[level - 1].at, own);
  }
  return sum;
}

void SectionsIntegral::add_parts(std::size_t level, const Breaks& breaks, double whole, int depth,
                                 IntegralRoom& room) const {
  const auto closing = [](const SliceBreak& at, const Slice& outside) {
    return at.is_box ? kBox : outside.hash == 0 ? outside.broken : kChange;
  };
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const SliceBreak &lower = breaks[i - 1], &upper = breaks[i];
    room.levels[level].unresolved += lower.overlooked;
    if (lower.above.hash == 0 && upper.below.hash == 0) continue;
    add_part(level,
             {.piece = {lower.at, upper.at, lower.root, upper.root},
              .below = lower.above,
              .above = upper.below,
              .lower = closing(lower, lower.below),
              .upper = closing(upper, upper.above),
              .beyond_lower = lower.below.measure,
              .beyond_upper = upper.above.measure},
             whole, depth, room);
  }
}

/// Integrates over a part; where its nodes have several structures, over the parts between their breaks.
void SectionsIntegral::add_part(std::size_t level, SlicePart part, double whole, int depth, IntegralRoom& room) const {
  IntegralRoom::Level& own = room.levels[level];
  const double width = part.piece.upper - part.piece.lower;
  if (width < kNarrow * whole) {
    own.unresolved += width * std::max(part.below.measure, part.above.measure);
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
  if (room.for_slopes && level == 0 && levels() == 2) {
    part.kept = room.kept.size();
    for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
      slices[i] = slice(level, part.at[i], room);
      room.kept.push_back(room.levels[1].parts);
    }
  } else {
    find_slices(level, part.at, slices, room);
  }
  double less = 0, spread = 0;
  bool same = part.below.hash == part.above.hash;
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
    const double jacobian = jacobians[i];
    part.weight[i] = jacobian * weights.weight[i];
    part.value += part.weight[i] * slices[i].measure;
    part.unresolved += part.weight[i] * slices[i].error;
    less += jacobian * weights.fewer[i] * slices[i].measure;
    same = same && slices[i].hash == part.below.hash;
  }
  if (!same && depth < kDeepest && width > (ends_in_lines() ? kBlurredInLines : kBlurred) * whole &&
      room.sections < room.most) {
    Breaks& breaks = own.breaks[static_cast<std::size_t>(depth) + 1];
    const Slice below{.measure = part.beyond_lower, .broken = part.lower};
    const Slice above{.measure = part.beyond_upper, .broken = part.upper};
    breaks.assign(1, {part.piece.lower, part.piece.sqrt_at_lower, below, part.below, part.lower == kBox});
    Slice before = part.below;
    for (Slice& next : slices) {
      find_breaks(level, before, next, whole, breaks, room);
      before = next;
    }
    find_breaks(level, before, part.above, whole, breaks, room);
    breaks.push_back({part.piece.upper, part.piece.sqrt_at_upper, part.above, above, part.upper == kBox});
    return add_parts(level, breaks, whole, depth + 1, room);
  }
  for (std::size_t i = 0; i < NestedRule::kNodes; ++i)
    spread += weights.weight[i] * std::fabs(slices[i].measure * part.weight[i] / weights.weight[i] - part.value);
  part.error = quadpack_error(std::fabs(part.value - less), spread);
  if (room.for_slopes && same) part.missed = missed_at_ends(part, slices);
  if (!same) {
    const auto [least, greatest] = std::ranges::minmax(slices, {}, &Slice::measure);
    part.unresolved += width * (greatest.measure - least.measure);
  }
  own.parts.push_back(part);
}

/// Halves the part with the greatest error until the sum is small enough, then those that miss their ends.
void SectionsIntegral::refine(std::size_t level, double whole, IntegralRoom& room) const {
  IntegralRoom::Level& own = room.levels[level];
  // An inner integral need not be better than what the greatest one allows.
  const double share = level == 0 ? 1 : ends_in_lines() ? 0.5 : 0.1;
  const double least = level == 0 ? 0 : share * tolerance_ * room.levels[level - 1].greatest;
  const double may_miss = std::max(kEndsMeet, 10 * tolerance_) * own.greatest;
  const auto misses = [&](const SlicePart& part) {
    return part.missed > may_miss && part.piece.upper - part.piece.lower > kNarrow * whole;
  };
  while (own.parts.size() < kMostParts && room.sections < room.most) {
    double value = 0, error = 0;
    for (const SlicePart& part : own.parts) {
      value += part.value;
      error += part.error;
    }
    const bool is_vague = error > std::max({least, share * tolerance_ * value, 1e-15 * value});
    const auto at =
        is_vague ? std::ranges::max_element(own.parts, {}, &SlicePart::error) : std::ranges::find_if(own.parts, misses);
    if (at == own.parts.end()) return;
    const SlicePart part = *at;
    own.parts.erase(at);
    const auto [first, second] = halves(part.piece);
    const Slice middle = slice(level, first.upper, room);
    const double change = std::fabs(part.above.measure - part.below.measure);
    const bool may_be_jump = level + 1 < levels() && change > kJump * own.greatest;
    const int one_sided = may_be_jump && is_one_sided(part.below, middle, part.above) ? part.one_sided + 1 : 0;
    if (one_sided == kHalvingsOfJump) own.unresolved += change * whole / kPlacesInLines;
    SlicePart low{.piece = first, .below = part.below, .above = middle, .lower = part.lower, .one_sided = one_sided};
    low.beyond_lower = part.beyond_lower;
    low.beyond_upper = middle.measure;
    SlicePart high{.piece = second, .below = middle, .above = part.above, .upper = part.upper, .one_sided = one_sided};
    high.beyond_lower = middle.measure;
    high.beyond_upper = part.beyond_upper;
    add_part(level, low, whole, 0, room);
    add_part(level, high, whole, 0, room);
  }
}

}  // namespace pkm::generic
