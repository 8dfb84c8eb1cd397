// Bounding box of the poses that satisfy constraints g >= 0, by interval branch and prune.
//
// First, each unbounded range is cut: the slab of all poses beyond a large bound, with all other coordinates free, has
// to be proven infeasible. Then the box is bisected. Of the boxes that are not proven infeasible, those that define a
// face of the common bounding box are bisected next, until they are small. All poses outside the result are proven
// infeasible.
//
// Reference: L. Jaulin, M. Kieffer, O. Didrit, E. Walter, "Applied Interval Analysis", Springer, 2001, chapter 4.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/expression/interval_steps.hpp"
#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::bounds {

/// Computes boxes that contain all feasible poses. Immutable and thread-safe.
class FeasibleHull {
 public:
  /// @param constraints  nodes of the graph
  /// @param axes         indices of the graph's inputs that are the axes
  /// @param inputs       number of inputs of the graph
  FeasibleHull(expression::Graph graph, std::vector<expression::Node> constraints, std::vector<std::size_t> axes,
               std::size_t inputs);

  /// @param inputs  values of all inputs of the graph; those of the axes are ignored
  /// @param start   range of each axis, which may be unbounded or a single number
  /// @param scale   positive length [m]: unbounded ranges are cut at large multiples of it
  /// @return a box that contains all feasible poses; its sides are infinite if no bounds are proven. If no pose is
  ///         feasible, the box that bound() returns
  IntervalBox find(std::span<const Interval> inputs, const IntervalBox& start, double scale) const;
  /// The first step of find(): cuts unbounded ranges where the poses beyond the cut are proven infeasible.
  IntervalBox bound(std::span<const Interval> inputs, const IntervalBox& start, double scale) const;

 private:
  class Search;
  struct Constraint {
    std::uint32_t output;                          ///< register that holds the value of the constraint
    std::vector<expression::Program::Step> steps;  ///< program steps that depend on the axes
  };

  std::vector<std::size_t> axes_;
  std::size_t inputs_;
  std::vector<double> numbers_;  ///< constants of the formulas: inputs of the program after those of the graph
  expression::Program program_;
  /// By axis: the register of its input; std::nullopt: no constraint depends on the axis.
  std::vector<std::optional<std::uint32_t>> registers_;
  std::vector<Constraint> constraints_;
};

}  // namespace pkm::bounds
