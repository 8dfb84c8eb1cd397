// Interval branch and prune along the columns over one box of the outer coordinates x. The range of the column
// coordinate z is divided into segments; constraints that hold everywhere, and segments where one is violated
// everywhere, are removed.
//
// A constraint g that is continuous and strictly monotonic in z on a segment has at most one root z*(x) there. With the
// centre c of the box, a point z_c near the root over c, and enclosures G_i and G_z of the partial derivatives over box
// and segment, the mean value theorem gives
//   z*(x) in R = z_c - g(c, z_c) / G_z - sum_i (G_i / G_z) (x_i - c_i).
// Outside of R the sign of g is known (contraction). If R lies inside the segment, there is exactly one root over every
// x. The mean of z* over the box is that over the centre, up to half the width of the gradient's enclosure, because the
// linear part of z*(x) - z*(c) has the mean 0: the error is of second order in the width of the box. README.md has an
// example.
#pragma once

#include <bitset>
#include <cstdint>
#include <vector>

#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::bounds {

inline constexpr std::size_t kMaxConstraints = 128;
inline constexpr std::size_t kMaxOuterAxes = 2;

using OpenConstraints = std::bitset<kMaxConstraints>;

/// Grid of 2^30 steps over the range of z. Ends of segments are integers, so that they are exact in a proof.
struct ColumnGrid {
  static constexpr std::int64_t kSteps = std::int64_t{1} << 30;

  double lower, upper;

  double at(std::int64_t step) const {
    if (step == kSteps) return upper;
    return lower + (upper - lower) * (static_cast<double>(step) / static_cast<double>(kSteps));
  }
  Interval between(std::int64_t from, std::int64_t to) const { return {at(from), at(to)}; }
  /// Enclosure of the length of a segment.
  Interval length(std::int64_t from, std::int64_t to) const { return Interval(at(to)) - Interval(at(from)); }
  /// The last step in [from, to] with at(step) <= z, or, due to rounding, an earlier one next to it; `from` if there is
  /// none.
  std::int64_t step_below(double z, std::int64_t from, std::int64_t to) const;
  /// The first step in [from, to] with at(step) >= z, or one slightly after it due to rounding; `to` if there is none.
  std::int64_t step_above(double z, std::int64_t from, std::int64_t to) const;
};

/// An interval of the column coordinate z, over a box of the outer coordinates.
struct Segment {
  std::int64_t from, to;
  /// Indices of the constraints that are undecided on the segment; all others are satisfied on it.
  OpenConstraints open;
};

/// One step of the proof that the columns over a box are decided correctly. It refers to the first open segment.
struct Step {
  enum class Kind : char {
    violated = 'x',    ///< `constraint` is violated on the segment, which is infeasible
    satisfied = 'h',   ///< `constraint` is satisfied on the segment
    contracted = 't',  ///< all roots of `constraint` lie in [from, to], by the mean value theorem about `expansion`
    split = 's',       ///< the segment is divided at `from` and `to` into up to three segments
    /// The only undecided constraint has exactly one root over every x, by the mean value theorem about `expansion`.
    one_root = 'r',
    open = 'n',  ///< the segment remains undecided
  };
  Kind kind;
  std::size_t constraint = 0;
  std::int64_t from = 0, to = 0, expansion = 0;  ///< positions on the z axis, as numbers of steps of the ColumnGrid
};

/// A box of the outer coordinates x, with the segments of the column coordinate z over it.
struct ColumnBox {
  std::array<std::array<double, 2>, kMaxOuterAxes> side{};
  Interval feasible_length{0.0};  ///< total length of the z segments that are feasible over the whole box
  std::vector<Segment> open;      ///< undecided segments
  Interval volume{0.0};           ///< enclosure of the volume over the box
};

/// Decides on which parts of the columns over a box the constraints are satisfied or violated.
class ColumnPruner {
 public:
  ColumnPruner(const Constraints& constraints, const ColumnGrid& grid,
               const std::array<std::array<double, 2>, kMaxOuterAxes>& whole)
      : constraints_(constraints), grid_(grid), whole_(whole) {}

  /// Scratch memory of one worker.
  struct Scratch {
    Constraints::Scratch box, centre;
    std::vector<Segment> pending;
  };
  Scratch make_scratch() const { return {constraints_.make_scratch(), constraints_.make_scratch(), {}}; }

  /// Examines the open segments of a box, whose sides may have been bisected since the last call.
  /// @param steps    receives the steps of the proof; null: not requested
  /// @param skipped  true if the search has been stopped: all segments stay open
  void prune(ColumnBox& box, Scratch& scratch, std::vector<Step>* steps, bool skipped) const;

 private:
  /// The root z*(x) of a constraint along z, for all x in a box.
  struct Root {
    bool is_continuous = false;  ///< true: the constraint is continuous on the box and the segment
    bool is_enclosed = false;    ///< true: the constraint is strictly monotonic in z on the box and the segment;
                                 ///< `range` and `mean` are valid
    bool is_increasing = false;  ///< true: the constraint increases with z
    Interval range;              ///< R: contains z*(x) for all x of the box
    Interval mean;               ///< contains the mean of z* over the box
    std::int64_t expansion = 0;  ///< z_c, a step of the grid: approximately the root over the centre
  };

  /// Encloses the root of a constraint along z on a segment, for all x in a box.
  /// @param sides   sides of the box along each axis; the last one is the segment
  /// @param centre  centre of the box
  Root enclose_root(std::size_t constraint, const Segment& segment, const IntervalBox& sides, const IntervalBox& centre,
                    Scratch& scratch) const;
  bool changes_sign_at_centre(std::size_t constraint, const Interval& segment, Scratch& scratch) const;
  double root_displacement(std::size_t constraint, std::int64_t expansion, const IntervalBox& sides,
                           Scratch& scratch) const;

  const Constraints& constraints_;
  const ColumnGrid grid_;
  const std::array<std::array<double, 2>, kMaxOuterAxes> whole_;
};

}  // namespace pkm::bounds
