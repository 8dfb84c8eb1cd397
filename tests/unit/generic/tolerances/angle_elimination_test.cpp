// Sines and cosines of angles that are given by inverse functions.
#include "engine/generic/tolerances/angle_elimination.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::generic {
namespace {

using expression::Graph, expression::Node;

double value_of(const Graph& graph, Node node, const std::vector<double>& inputs) {
  std::vector<double> registers;
  const expression::Program program(graph, {&node, 1});
  program.run_all<double>(inputs, registers);
  return registers[program.outputs().front()];
}
/// Names of the operations that a node depends on.
std::vector<std::string> operations(const Graph& graph, Node node) {
  std::vector<std::string> names;
  for (const Node each : graph.reachable({&node, 1}))
    if (graph[each].operation) names.push_back(graph[each].operation->name);
  return names;
}

TEST(AngleElimination, KeepsValuesWithoutInverseFunctions) {
  for (const std::string angle :
       {"atan2(y, x)", "acos(z)", "asin(z)", "atan2(y, x) - acos(z)", "acos(z) + 2*x", "y - (-asin(z/2))"})
    for (const std::string function : {"sin", "cos"}) {
      SCOPED_TRACE(function + " " + angle);
      bounds::Formulas formulas("xyz");
      std::vector<Node> roots = {formulas.read("1 + " + function + "(" + angle + ")")};
      const Node before = roots.front();
      eliminate_angles(
          formulas.graph, [](Node) { return false; }, roots);
      EXPECT_NE(roots.front(), before);
      for (const std::string inverse : {"atan2", "acos", "asin"})
        EXPECT_THAT(operations(formulas.graph, roots.front()), ::testing::Not(::testing::Contains(inverse)));
      for (const std::vector<double>& inputs :
           {std::vector{0.4, 1.2, -0.3}, std::vector{-0.7, 0.1, 0.9}, std::vector{-0.7, -1e-9, 0.0}})
        EXPECT_NEAR(value_of(formulas.graph, roots.front(), inputs), value_of(formulas.graph, before, inputs), 1e-14);
    }
}

TEST(AngleElimination, RemovesFullTurnsAndSigns) {
  bounds::Formulas formulas("xyzs");
  Graph& graph = formulas.graph;
  const expression::Term centre(graph, formulas.read("z")),
      angle(graph, formulas.read("atan2(y, x) + s*acos(x/sqrt(x^2 + y^2)/3)"));
  std::vector<Node> roots = {sin(centre + call(expression::angle_wrapping(), angle - centre)).node()};
  const Node before = roots.front(), sign = formulas.nodes[3];
  eliminate_angles(
      graph, [&](Node node) { return node == sign; }, roots);
  EXPECT_THAT(operations(graph, roots.front()), ::testing::Not(::testing::Contains("acos")));
  for (const double s : {-1.0, 1.0}) {
    const std::vector<double> inputs = {-0.7, -0.1, 2, s};
    EXPECT_NEAR(value_of(graph, roots.front(), inputs), value_of(graph, before, inputs), 1e-14);
  }
  // a factor that is not a sign
  std::vector<Node> scaled = {formulas.read("sin(s*acos(x))")};
  const Node kept = scaled.front();
  eliminate_angles(
      graph, [](Node) { return false; }, scaled);
  EXPECT_EQ(scaled.front(), kept);
}

}  // namespace
}  // namespace pkm::generic
