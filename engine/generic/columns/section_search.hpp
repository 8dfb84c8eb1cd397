// Where a workspace may be that no section has met: boxes of the coordinates of which intervals cannot tell that they
// are empty. What surfaces say narrows v and z; what is left is halved.
#pragma once

#include "engine/generic/columns/section_plan.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/interval.hpp"

namespace pkm::generic {

/// What a search overwrites.
struct SearchRoom {
  struct Box {
    std::array<Interval, kMaxCoordinates> side;  ///< each outer coordinate, v and z, as far as there are such
    Signs open = ~Signs{0};                      ///< surfaces that may be below 0 there

    const Interval& outermost() const { return side[0]; }
  };
  std::vector<Box> boxes;  ///< that may not be empty
  std::size_t examined = 0;

  Box whole;                                          ///< the ranges
  std::array<Interval, kMaxCoordinates + 1> entered;  ///< by stage: the side that the registers are of
  std::vector<Interval> registers;
  std::vector<Box> met;  ///< boxes with a section that is not empty
  std::vector<Box> halves;
  std::vector<std::array<double, 2>> stretches;
};

class SectionSearch {
 public:
  explicit SectionSearch(const SectionPlan& plan) : plan_(plan) {}

  /// Without any boxes. @param registers  after the design's stage
  void start(std::span<const double> registers, SearchRoom& room) const;
  /// A range of the outermost coordinate, and all of the others'.
  void add(double from, double to, SearchRoom& room) const;
  /// Leaves out boxes that are empty for certain.
  void examine(SearchRoom& room) const;
  /// Whether halve() will halve the outermost coordinate.
  bool halves_outermost(const SearchRoom::Box& box, const SearchRoom& room) const { return longest(box, room) == 0; }
  void halve(SearchRoom& room) const;
  /// A section there is not empty: who looks at its neighbours finds the rest.
  void leave_out(double at, SearchRoom& room) const;
  /// Adds places on a side of the boxes: to each stretch that they cover without a gap as many as there are boxes
  /// beside each other, at least `count`.
  /// @param at  boxes that are there along the outermost coordinate; none: all of them
  void spread(std::size_t side, std::optional<double> at, int count, std::vector<double>& places,
              SearchRoom& room) const;
  /// The volume of boxes that are left, but for those that reach as far as what was met.
  double unknown(SearchRoom& room) const;

 private:
  struct Square;

  std::size_t outer() const { return plan_.order.outer.size(); }
  std::size_t sides() const { return outer() + (plan_.order.v ? 2 : 1); }
  bool may_hold(SearchRoom::Box& box, SearchRoom& room) const;
  bool enter(const SearchRoom::Box& box, SearchRoom& room) const;
  Square in_square(const Surface& surface, const SearchRoom::Box& box, std::span<const Interval> registers) const;
  double volume(const SearchRoom::Box& box) const;
  std::size_t longest(const SearchRoom::Box& box, const SearchRoom& room) const;

  const SectionPlan& plan_;
};

}  // namespace pkm::generic
