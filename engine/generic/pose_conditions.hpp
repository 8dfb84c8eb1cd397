// The conditions of a feasible pose in the form that intervals decide soonest.
#pragma once

#include <vector>

#include "engine/generic/model.hpp"
#include "engine/workspace/bounds/conditions.hpp"

namespace pkm::generic {

struct PoseConditions {
  Graph graph;
  std::vector<bounds::NamedCondition> all;  ///< of the graph
};

/// Margins and domains, which hold together where the model's do:
/// - c - sqrt(a) >= 0 of a design's c >= 0 is c^2 - a >= 0, sqrt(a) - c >= 0 is a - c^2 >= 0;
/// - c - acos(u) >= 0 of a design's c in [0, pi] is u - cos(c) >= 0, acos(u) - c >= 0 is cos(c) - u >= 0;
/// - sqrt(u), where u >= 0 is a condition by itself, is sqrt(max(u, 0)), so that it is defined beyond;
/// - acos(k / h) and asin(k / h), where h - k >= 0 and h + k >= 0 are conditions, or 1 - |k / h| >= 0, take k / h
/// within
///   [-1, 1].
/// @param inputs  of the graph, for the design
PoseConditions pose_conditions(const Model& model, const std::vector<Interval>& inputs);

}  // namespace pkm::generic
