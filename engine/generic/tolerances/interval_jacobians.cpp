#include "engine/generic/tolerances/interval_jacobians.hpp"

#include <algorithm>

#include "engine/expression/derivative.hpp"
#include "engine/generic/clearance.hpp"
#include "engine/generic/report_limits.hpp"
#include "engine/motion/time_graph.hpp"

namespace pkm::generic {

void refuse_limits_without_formula(const Model& model, const LimitSpec& limits) {
  refuse_clearance(model, limits,
                   "has no certified bounds with a clearance limit (clearance_min), because the distance of two links "
                   "is not given by a formula; use voxels, or remove the limit");
  refuse_report_limits(model, limits, "certified bounds");
}

std::vector<bounds::NamedMatrix> jacobians(const Model& model, Graph& graph, std::vector<Interval>& inputs) {
  const Inputs& at = model.inputs;
  std::vector<Node> roots = model.closures;
  roots.insert(roots.end(), model.joints.begin(), model.joints.end());
  std::vector<double> numbers;
  graph = expression::without_numbers(
      model.graph, inputs.size(), [](std::size_t) { return Groups{1}; }, numbers, roots);
  inputs.insert(inputs.end(), numbers.begin(), numbers.end());
  const std::span<const Node> closures = std::span(roots).first(model.closures.size());
  const std::string det_G = at.joints == at.coordinates ? "det G" : "det(G^T G)";
  std::vector<bounds::NamedMatrix> matrices = {
      {"the parallel singularity (" + det_G + " = 0)", at.joints, at.coordinates, {}},
      {"the serial singularity (det Jq = 0)", at.joints, at.joints, {}}};
  std::vector<Node> entries;
  for (bounds::NamedMatrix& matrix : matrices)
    for (const Node closure : closures)
      for (std::size_t j = 0; j < matrix.columns; ++j) {
        const bool by_pose = &matrix == &matrices.front();
        const Node variable = graph.input(by_pose ? at.coordinate(j) : at.joint(j));
        matrix.entries.push_back(expression::derivative(graph, closure, variable));
        entries.push_back(matrix.entries.back());
      }
  // Substitute the joint coordinates by functions of the pose.
  std::vector<std::optional<Node>> joints(at.count());
  for (std::size_t i = 0; i < at.joints; ++i) joints[at.joint(i)] = roots[closures.size() + i];
  graph = expression::substitute_nodes(graph, joints, entries);
  auto entry = entries.begin();
  for (bounds::NamedMatrix& matrix : matrices)
    for (Node& node : matrix.entries) node = *entry++;
  return matrices;
}

std::size_t substitute_motion(const Motion& motion, const Inputs& at, Graph& graph, std::vector<Interval>& inputs,
                              std::vector<Node>& roots) {
  TimeGraph time(graph, inputs);
  const std::vector<Node> pose = motion.write(time);
  std::vector<std::optional<Node>> coordinates(at.coordinate(0) + pose.size());
  std::ranges::copy(pose, coordinates.begin() + static_cast<std::ptrdiff_t>(at.coordinate(0)));
  graph = expression::substitute_nodes(graph, coordinates, roots);
  return time.position;
}

Unsupported refuse_jacobians(const Inputs& at) {
  if (at.joints >= at.coordinates) return {};
  return "the mechanism has fewer joints (" + std::to_string(at.joints) + ") than coordinates (" +
         std::to_string(at.coordinates) + "), so that every pose is singular";
}

}  // namespace pkm::generic
