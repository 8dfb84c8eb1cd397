// Jacobians of the loop-closure equations as formulas of the pose for interval arithmetic, and the replacement of the
// pose by formulas of a motion.
#pragma once

#include <vector>

#include "engine/core/unsupported.hpp"
#include "engine/generic/model.hpp"
#include "engine/motion/motion.hpp"
#include "engine/workspace/bounds/pose_box.hpp"

namespace pkm::generic {

/// Throws std::invalid_argument with a message if a limit in force has no formula, which interval arithmetic needs.
void refuse_limits_without_formula(const Model& model, const LimitSpec& limits);

/// Jacobians of the loop-closure equations with respect to the coordinates (G) and to the joint coordinates (Jq), as
/// functions of the pose.
/// @param graph   receives the formulas of the elements, in which inputs replace all constant numbers
/// @param inputs  values of the graph's inputs, to which those numbers are appended
std::vector<bounds::NamedMatrix> jacobians(const Model& model, Graph& graph, std::vector<Interval>& inputs);

/// Reason why singularities cannot be examined; empty if they can.
Unsupported refuse_jacobians(const Inputs& at);

/// Replaces the coordinates in the formulas `roots` by formulas of a motion, i.e. functions of the time.
/// @return index of the time among the inputs of the graph
std::size_t substitute_motion(const Motion& motion, const Inputs& at, Graph& graph, std::vector<Interval>& inputs,
                              std::vector<Node>& roots);

}  // namespace pkm::generic
