// Constraints of a feasible pose in a form for which interval arithmetic gives tight enclosures.
#pragma once

#include <span>
#include <vector>

#include "engine/generic/model.hpp"
#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::generic {

struct IntervalConstraints {
  Graph graph;
  std::vector<bounds::NamedConstraint> all;  ///< the constraints, as nodes of `graph`
  std::optional<std::size_t> balance;        ///< index of the constraint that Model::balance describes
};

/// Rewrites the domains and margins of a model. The resulting constraints are all satisfied if and only if those of the
/// model are, but contain fewer roots and inverse functions, and their roots are defined on whole boxes. In the table,
/// c depends on the design only.
///
///     c - sqrt(a) >= 0, c >= 0             c^2 - a >= 0
///     sqrt(a) - c >= 0, c >= 0             a - c^2 >= 0
///     c - acos(u) >= 0, 0 <= c <= pi       u - cos(c) >= 0
///     acos(u) - c >= 0, 0 <= c <= pi       cos(c) - u >= 0
///     sqrt(u), if u >= 0 is a constraint   sqrt(max(u, 0))
///     acos(u), asin(u), if -1 <= u <= 1    acos(min(max(u, -1), 1)), asin(..)
///
/// The last row applies to u = k / h if h - k >= 0 and h + k >= 0 are constraints, and to any u if 1 - |u| >= 0 is one.
/// @param inputs  values of the graph's inputs for the design, as intervals
/// @param reach   further constraints of the limbs, which follow from the domains
IntervalConstraints interval_constraints(const Model& model, const std::vector<Interval>& inputs,
                                         std::span<const Node> reach = {});

}  // namespace pkm::generic
