// Where the structure of an integral's slices changes along an outer coordinate: breaks that are closed in on.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/generic/columns/sections_integral.hpp"

namespace pkm::generic {
namespace {

// Of the range: how well breaks are known. Slices grow like roots from some breaks, and derivatives lack what a slice
// measures at the break: 3e-8 of it at 1e-15 of the range. Volumes lack the power 3/2: where sections are lines, 1e-11
// will do for them.
constexpr double kNear = 1e-15, kNearInLines = 1e-11;
constexpr double kFar = 1e-3;     // of the range: slices that are further from a break may differ in small parts
constexpr double kNextTo = 1e-8;  // of the range: breaks that are one
constexpr double kCloseBy = 64;   // steps from a break to the next one: where rounding may decide

/// Takes two breaks that are next to each other as one: where conics touch, labels change once more a little later,
/// when rounding no longer hides that they cross. It is at the one where the measure begins to behave like a root,
/// which the parts on both sides have to know to many digits: their derivatives are infinite there.
bool join(SliceBreak& first, const SliceBreak& second, double whole) {
  const double apart = second.at - first.at;
  if (first.is_box || apart > kNextTo * whole) return false;
  if (first.below.hash == 0 || first.above.hash == 0 || second.above.hash == 0) return false;
  const double soon = std::fabs(first.above.measure - first.below.measure),
               in_all = std::fabs(second.above.measure - first.below.measure);
  const double like_root = std::sqrt((first.above.at - first.at) / apart);
  if (!(soon > 0.5 * like_root * in_all)) first.at = second.at;
  first.above = second.above;
  return true;
}

}  // namespace

/// Measures go on where structures change, some like roots; if not, a condition that holds on one side alone explains
/// it, or something was overlooked there.
bool SectionsIntegral::jumps(const Slice& low, const Slice& high, std::size_t level, const IntegralRoom& room) const {
  return ends_in_lines() && low.broken == 0 && high.broken == 0 &&
         std::fabs(low.measure - high.measure) > kJump * room.levels[level].greatest;
}

/// Adds the breaks between two slices, in order.
void SectionsIntegral::find_breaks(std::size_t level, Slice from, Slice& to, double whole, Breaks& breaks,
                                   IntegralRoom& room) const {
  const double least = kSettled * whole;
  double step = least;
  for (int more = 0; more < 24 && from.hash != to.hash && room.sections < room.most; ++more) {
    Slice low = from, high = to;
    // Of many changes that rounding makes, halving meets any one, guesses each after the other.
    const bool guesses = more < 2;
    close_in(level, low, high, whole, guesses, room);
    for (int again = 0; again < 4 && level + 1 < levels() && jumps(low, high, level, room); ++again) {
      // A part that was overlooked on one side is found there now, and followed further on.
      const bool is_low = low.measure < high.measure;
      const Slice found = slice(level, is_low ? low.at : high.at, room);
      if (found.hash == (is_low ? low : high).hash) break;
      (is_low ? high : low) = found;
      (is_low ? low : high) = is_low ? from : to;
      if (low.hash == high.hash) break;
      close_in(level, low, high, whole, guesses, room);
    }
    if (high.at == to.at && level + 1 < levels()) {
      const Slice again = slice(level, to.at, room);
      const bool is_other = again.hash != to.hash;
      to = again;
      if (is_other) continue;
    }
    // Where rounding decides, structures change again and again close by; ever longer steps leave that behind.
    step = more > 0 && high.at - from.at < kCloseBy * step ? 8 * step : least;
    const double beyond = high.at + step;
    const Slice after = beyond < to.at ? slice(level, beyond, room) : to;
    SliceBreak found{high.at, true, low, after};
    if (level + 1 < levels() && jumps(low, high, level, room))
      found.overlooked = unexplained(level, found, room) * whole / kPlacesInLines;
    if (ends_in_lines() || breaks.empty() || !join(breaks.back(), found, whole)) breaks.push_back(found);
    from = after;
  }
}

void SectionsIntegral::find_marks(std::size_t level, Marks& marks, const IntegralRoom& room) const {
  marks.clear();
  if (level + 1 < levels()) {
    const std::vector<SlicePart>& parts = room.levels[level + 1].parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const SlicePart& part = parts[i];
      marks.push_back({2 * part.below.hash, 2 * i, part.piece.lower});
      marks.push_back({2 * part.below.hash + 1, 2 * i + 1, part.piece.upper});
    }
  } else if (const auto* const section = std::get_if<Section>(&innermost_)) {
    section->find_marks(room.section, marks);
  } else {
    for (const auto& [z, label] : room.column.ends)
      marks.push_back(
          {label, label >> 1U, z, 0, std::ranges::find(room.column.labels, label) != room.column.labels.end()});
  }
}

void SectionsIntegral::close_in(std::size_t level, Slice& low, Slice& high, double whole, bool guesses,
                                IntegralRoom& room) const {
  const double range = whole + std::fabs(low.at),
               near = (ends_in_lines() && !room.for_slopes ? kNearInLines : kNear) * range;
  IntegralRoom::Level& own = room.levels[level];
  const bool is_innermost = level + 1 == levels(), are_columns = is_innermost && ends_in_lines(),
             are_sections = is_innermost && !ends_in_lines();
  std::uint32_t closing = 0;  // 1 + the place of the plain condition that holds on one side alone
  own.guess.start(are_columns);
  const auto look = [&](double at) {
    const Slice found = slice(level, at, room);
    const bool is_upper = found.hash != low.hash;
    const std::uint32_t now = low.broken == 0 ? high.broken : high.broken == 0 ? low.broken : 0;
    if (now != closing) own.guess.start(are_columns);
    closing = now;
    if (closing != 0) {
      own.guess.see_size(at, is_upper, room.registers[plan().plain[level + 1][closing - 1]]);
    } else {
      find_marks(level, own.marks, room);
      own.guess.see(at, is_upper, found.hash, own.marks, [&](const Mark& mark, const Mark& other) {
        return are_sections ? Section::distance(mark, other, room.section) : std::numeric_limits<double>::infinity();
      });
    }
    return found;
  };
  if (are_columns) {
    look(low.at);
    look(high.at);
  }
  // What stays while the other side comes nearer may have been overlooked there: by now it is expected.
  const std::array<Slice, 2> outer{low, high};
  std::array<int, 2> stays{};
  const auto look_back = [&](bool has_upper_moved) {
    stays[has_upper_moved] = 0;
    int& steps = stays[!has_upper_moved];
    if (++steps % 4 != 0) return;
    Slice &other = has_upper_moved ? low : high, &moved = has_upper_moved ? high : low;
    const Slice again = slice(level, other.at, room);
    if (again.hash == other.hash) return;
    if (again.hash == moved.hash) {
      moved = again;
      other = outer[!has_upper_moved];
    } else {
      other = again;
    }
    own.guess.start(are_columns);
    stays = {};
  };
  while (high.at - low.at > near || (jumps(low, high, level, room) && high.at - low.at > kNear * range)) {
    const double wanted = high.at - low.at > near ? near : kNear * range;
    const double at = guesses ? own.guess.next(low.at, high.at, wanted) : 0.5 * (low.at + high.at);
    if (at <= low.at || at >= high.at) break;
    if (level == 0) room.is_scanning = high.at - low.at > kFar * whole;
    const Slice next = look(at);
    if (guesses && next.hash != low.hash && next.hash != high.hash) {  // rounding may decide here
      guesses = false;
      if (are_sections) {
        low = outer[0];
        high = outer[1];
        continue;
      }
    }
    (next.hash == low.hash ? low : high) = next;
    if (!is_innermost) look_back(next.hash != low.hash);
  }
  if (level == 0) room.is_scanning = false;
}

}  // namespace pkm::generic
