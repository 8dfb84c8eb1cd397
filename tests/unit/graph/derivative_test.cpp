// Derivatives as nodes against those of Taylor numbers, first and second, for every operation.
#include "engine/graph/derivative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "engine/graph/formula.hpp"
#include "engine/graph/formula_reader.hpp"
#include "engine/graph/program.hpp"

namespace pkm::graph {
namespace {

const std::vector<std::string> kPlane = {"x", "y"};

struct Computed {
  double value, first, second;
};

/// Of a formula while x moves at the rate 0.7 and y at -1.3.
Computed by_nodes(const std::string& text, double x, double y) {
  Graph graph;
  const Node inputs[2] = {graph.input(0), graph.input(1)};
  const Node f = read_formula(graph, text, kPlane, inputs);
  Rates along(graph);
  along.move(inputs[0], graph.number(0.7));
  along.move(inputs[1], graph.number(-1.3));
  const Node first = along.of(f).node(), second = along.of(first).node();
  const Program program(graph, std::array{f, first, second});
  std::vector<double> registers;
  program.run_all<double>(std::array{x, y}, registers);
  const auto& at = program.outputs();
  return {registers[at[0]], registers[at[1]], registers[at[2]]};
}

Taylor by_taylor(const std::string& text, double x, double y) {
  return Formula(text, kPlane).value<Taylor>(std::array{Taylor(x, 0.7, 0), Taylor(y, -1.3, 0)});
}

TEST(Derivative, EqualsThatOfTaylorNumbersForEveryOperation) {
  std::vector<std::string> texts;
  for (const Operation& function : functions()) {
    const std::string& name = function.name;
    if (function.arguments == 1) texts.push_back(name + "(0.2 + 0.3*x*y)");
    if (function.arguments == 2) texts.push_back(name + "(x*y, 1 + x)");
    if (function.arguments == 0) texts.push_back(name + "(x*y, x - 0.1*y, x*x)");
  }
  for (const char* each : {"+", "-", "*", "/", "^"}) texts.push_back("(x*y) " + std::string(each) + " (y + x*x)");
  for (const char* each : {"<", "<=", ">", ">=", "==", "!=", "&&", "||"})
    texts.push_back("(x " + std::string(each) + " y) * x*y");
  texts.insert(texts.end(), {"-x*y", "x > y ? x*y : y/x", "x^3", "x^2.5", "2.5^x", "abs(x - 2*y)"});
  for (const std::string& text : texts)
    for (const auto& [x, y] : {std::pair{0.8, 1.1}, std::pair{1.3, 0.6}, std::pair{0.5, 0.9}}) {
      const Computed ours = by_nodes(text, x, y);
      const Taylor theirs = by_taylor(text, x, y);
      ASSERT_TRUE(std::isfinite(theirs.dd)) << text;
      EXPECT_NEAR(ours.value, theirs.a, 1e-15 * std::fabs(theirs.a)) << text;
      EXPECT_NEAR(ours.first, theirs.d, 1e-13 * (1 + std::fabs(theirs.d))) << text;
      EXPECT_NEAR(ours.second, theirs.dd, 1e-12 * (1 + std::fabs(theirs.dd))) << text;
    }
}

TEST(Derivative, OfWhatDoesNotMoveIsTheNumberZero) {
  Graph graph;
  const Node x = graph.input(0), y = graph.input(1);
  Rates by_x(graph);
  by_x.move(x, graph.number(1));
  EXPECT_TRUE(by_x.of(sqrt(Term(graph, y)) * 3.0).is(0));
  EXPECT_TRUE(by_x.of(Term(graph, x) + Term(graph, y)).is(1));
}

TEST(Derivative, TakesARateThatItIsToldForANode) {
  Graph graph;
  const Term x(graph, graph.input(0)), c = cos(x);
  Rates by_x(graph);
  by_x.move(x.node(), graph.number(1));
  by_x.move(c.node(), graph.number(5));
  EXPECT_TRUE(by_x.of(c).is(5));
}

TEST(Derivative, ByOneInputLiesInItsInterval) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.1, 0.9);
  for (const std::string text :
       {"x + y - 3*x", "x*y/(x + 2)", "x/y", "-x^3 + y^-2", "sqrt(x + y)*abs(x - y)", "sin(x)*cos(y) + tan(x*y)",
        "asin(x) + acos(y*x) + atan(x/y)", "atan2(x, y) - atan2(y, -x)", "sinh(x) + cosh(x*y) - tanh(y)",
        "exp(x*y) + log(x + y)", "min(x, y) + max(x*y, y)", "x < y ? x^2 : y*x", "x^y + y^2.5 + 2^x", "sign(x)*x*y",
        "log10(x*y + 3)"}) {
    Graph graph;
    const std::vector<Node> inputs = {graph.input(0), graph.input(1)};
    const Node f = read_formula(graph, text, kPlane, inputs);
    for (std::size_t by = 0; by < 2; ++by) {
      const Node d = derivative(graph, f, inputs[by]);
      const std::vector<Node> outputs = {f, d};
      const Program program(graph, outputs);
      for (int i = 0; i < 50; ++i) {
        std::vector<Taylor> at = {unit(random), unit(random)};
        at[by].d = 1;
        std::vector<Taylor> taylor;
        program.run_all<Taylor>(at, taylor);
        const double expected = taylor[program.outputs()[0]].d;
        EXPECT_NEAR(taylor[program.outputs()[1]].a, expected, 1e-12 * (1 + std::fabs(expected))) << text;

        const std::vector<Interval> box = {{at[0].a - 0.01, at[0].a + 0.01}, {at[1].a - 0.01, at[1].a + 0.01}};
        std::vector<Interval> registers;
        program.run_all<Interval>(box, registers);
        const Interval slopes = registers[program.outputs()[1]];
        EXPECT_LE(slopes.lower, expected + 1e-12 * std::fabs(expected)) << text;
        EXPECT_GE(slopes.upper, expected - 1e-12 * std::fabs(expected)) << text;
      }
    }
  }
}

}  // namespace
}  // namespace pkm::graph
