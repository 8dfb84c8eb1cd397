// Interval branch and prune for components that the sampled slices missed. Boxes proven empty by interval arithmetic
// are discarded, the quadratic constraints contract v and z, and the remaining boxes are bisected.
#pragma once

#include "engine/generic/slice_plan.hpp"
#include "engine/geometry/pose.hpp"
#include "engine/math/interval.hpp"

namespace pkm::generic {

/// Scratch memory of ComponentSearch.
struct SearchScratch {
  struct Box {
    /// Range of each outer coordinate, followed by the ranges of v (if the slices are planar) and z.
    std::array<Interval, kMaxCoordinates> side;
    Signs open = ~Signs{0};  ///< set of the constraints that are not known to be satisfied in the whole box

    const Interval& outermost() const { return side[0]; }
  };
  std::vector<Box> boxes;  ///< boxes that can contain feasible points
  std::size_t examined = 0;

  Box whole;  ///< box with the whole range of each coordinate
  /// For each stage, the interval of the stage's coordinate for which `registers` were computed last.
  std::array<Interval, kMaxCoordinates + 1> evaluated;
  std::vector<Interval> registers;
  /// Boxes in which remove_containing() has found a non-empty slice; `boxes` does not contain them.
  std::vector<Box> non_empty;
  std::vector<Box> halves;
  std::vector<std::array<double, 2>> uncovered;
};

class ComponentSearch {
 public:
  explicit ComponentSearch(const SlicePlan& plan) : plan_(plan) {}

  /// Begins a search with an empty list of boxes.
  /// @param registers  values of the registers after the stage of the design
  void start(std::span<const double> registers, SearchScratch& scratch) const;
  /// Adds a box to be searched: the interval [from, to] of the outermost coordinate, and the whole ranges of the
  /// others.
  void add(double from, double to, SearchScratch& scratch) const;
  /// Discards the boxes that are proven to have no feasible point, and reduces the others to parts with all feasible
  /// points.
  void examine(SearchScratch& scratch) const;
  /// Whether bisect() will divide this box along the outermost coordinate.
  bool bisects_outermost(const SearchScratch::Box& box, const SearchScratch& scratch) const {
    return longest(box, scratch) == 0;
  }
  void bisect(SearchScratch& scratch) const;
  /// Removes the boxes that contain the value `at` of the outermost coordinate. To be called if the slice there is not
  /// empty: the refinement of the integral around this slice covers these boxes.
  void remove_containing(double at, SearchScratch& scratch) const;
  /// Adds samples of the coordinate with index `side` in Box::side to `places`. Each interval that is covered by
  /// adjacent boxes receives as many samples as it has boxes, but at least `count`.
  /// @param at  only boxes that contain this value of the outermost coordinate are used; std::nullopt: all boxes
  void add_samples(std::size_t side, std::optional<double> at, int count, std::vector<double>& places,
                   SearchScratch& scratch) const;
  /// Volume of the boxes that remain, without those adjacent to a non-empty slice.
  double undecided_volume(SearchScratch& scratch) const;

 private:
  struct BoxQuadratic;

  std::size_t outer() const { return plan_.order.outer.size(); }
  std::size_t sides() const { return outer() + (plan_.order.v ? 2 : 1); }
  bool may_be_feasible(SearchScratch::Box& box, SearchScratch& scratch) const;
  bool evaluate(const SearchScratch::Box& box, SearchScratch& scratch) const;
  BoxQuadratic in_box(const Surface& surface, const SearchScratch::Box& box, std::span<const Interval> registers) const;
  double volume(const SearchScratch::Box& box) const;
  std::size_t longest(const SearchScratch::Box& box, const SearchScratch& scratch) const;

  const SlicePlan& plan_;
};

}  // namespace pkm::generic
