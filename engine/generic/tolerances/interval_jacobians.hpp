// Jacobians of the loop-closure equations as formulas of the pose for interval arithmetic, and formulas of a motion in
// place of the pose.
#pragma once

#include <vector>

#include "engine/core/unsupported.hpp"
#include "engine/generic/model.hpp"
#include "engine/motion/motion.hpp"
#include "engine/workspace/bounds/pose_box.hpp"

namespace pkm::generic {

/// Throws std::invalid_argument with a message if a limit in force has no formula, which interval arithmetic needs.
void refuse_limits_without_formula(const Model& model, const LimitSpec& limits);

/// Jacobians of the loop-closure equations by the coordinates (G) and by the joints (Jq), as functions of the pose.
/// @param graph   receives the graph of the entries, in which inputs replace all constants
/// @param inputs  the values of these inputs are appended
std::vector<bounds::NamedMatrix> jacobians(const Model& model, Graph& graph, std::vector<Interval>& inputs);

/// Why singularities are not examined; empty if they are.
Unsupported refuse_jacobians(const Inputs& at);

/// Substitutes the formulas of a motion for the coordinates. @return index of the time among the inputs
std::size_t substitute_motion(const Motion& motion, const Inputs& at, Graph& graph, std::vector<Interval>& inputs,
                              std::vector<Node>& roots);

}  // namespace pkm::generic
