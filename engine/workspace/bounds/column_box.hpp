// A box of the outer coordinates, and what is known of the columns over it: along the innermost coordinate z, lengths
// that are feasible for certain, and segments with conditions that are still open.
//
// Where the only open condition f rises or falls along a segment for certain, it has one root z*(x) there. With c the
// box's centre, z_c near the root over it, and slopes that hold over box and segment (the mean value theorem),
//   z*(x) in z_c - (f(c, z_c) + f_x (x - c)) / f_z,
// so that beyond this zone the sign of f is certain; and where the zone is inside of the segment, the root is there
// over all of the box. Its mean over the box is that over the centre, but for half the width of its gradient's
// enclosure: what is linear integrates to 0. So a root's error falls with the square of the box's width.
//
// Heights of segments are whole numbers of a grid over the range of z.
#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

#include "engine/workspace/bounds/conditions.hpp"

namespace pkm::bounds {

inline constexpr std::size_t kMostConditions = 128;
inline constexpr std::size_t kMostOuter = 2;

using Open = std::bitset<kMostConditions>;

/// The range of z as 2^30 steps.
struct Heights {
  static constexpr std::int64_t kSteps = std::int64_t{1} << 30;

  double lower, upper;

  double at(std::int64_t step) const {
    if (step == kSteps) return upper;
    return lower + (upper - lower) * (static_cast<double>(step) / static_cast<double>(kSteps));
  }
  Interval between(std::int64_t from, std::int64_t to) const { return {at(from), at(to)}; }
  Interval length(std::int64_t from, std::int64_t to) const { return Interval(at(to)) - Interval(at(from)); }
  /// The last step below a height and the first above it, of those in [from, to], as well as there are such.
  std::int64_t below(double height, std::int64_t from, std::int64_t to) const;
  std::int64_t above(double height, std::int64_t from, std::int64_t to) const;
};

struct Segment {
  std::int64_t from, to;
  Open open;
};

/// What was found of the next segment, for the proof: it is outside because a condition fails; the condition holds; it
/// has a root only in [from, to], as the mean value theorem says with z_c = guess; the segment is split there into up
/// to three; it has one root over all of the box; it stays open.
struct Step {
  enum class Kind : char { fails = 'x', holds = 'h', trims = 't', splits = 's', has_root = 'r', stays = 'n' };
  Kind kind;
  std::size_t condition = 0;
  std::int64_t from = 0, to = 0, guess = 0;
};

struct ColumnBox {
  std::array<std::array<double, 2>, kMostOuter> side{};
  Interval inside{0.0};  ///< length that is feasible all over the box
  std::vector<Segment> open;
  Interval volume{0.0};  ///< of the feasible set over the box
};

/// Looks at the open segments again, over sides that may have been narrowed since.
class ColumnExamination {
 public:
  ColumnExamination(const Conditions& conditions, const Heights& heights,
                    const std::array<std::array<double, 2>, kMostOuter>& whole)
      : conditions_(conditions), heights_(heights), whole_(whole) {}

  /// For one worker.
  struct Room {
    Conditions::Room over, centre;  ///< of the box, of its centre
    std::vector<Segment> left;
  };
  Room room() const { return {conditions_.room(), conditions_.room(), {}}; }

  /// @param steps    what was found is appended; null: nobody asks
  /// @param skipped  the search has been stopped: all open segments stay open
  void examine(ColumnBox& box, Room& room, std::vector<Step>* steps, bool skipped) const;

 private:
  struct Root {
    bool is_continuous = false;  ///< the condition, over box and segment
    bool is_known = false;       ///< it rises or falls all over them
    bool rises = false;
    Interval zone, mean;
    std::int64_t guess = 0;  ///< where the root over the centre is, about
  };

  /// @param place  box and segment
  /// @param centre  of the box
  Root root_of(std::size_t condition, const Segment& segment, const Place& place, const Place& centre,
               Room& room) const;
  bool changes_at_centre(std::size_t condition, const Interval& along, Room& room) const;
  double margin_of(std::size_t condition, std::int64_t guess, const Place& place, Room& room) const;

  const Conditions& conditions_;
  const Heights heights_;
  const std::array<std::array<double, 2>, kMostOuter> whole_;
};

}  // namespace pkm::bounds
