// Symbolic differentiation: first and second derivatives of every operation against Taylor arithmetic, and enclosures
// of derivatives by intervals.
#include "engine/expression/derivative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "engine/expression/formula.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"

namespace pkm::expression {
namespace {

const std::vector<std::string> kVariables = {"x", "y"};

struct Computed {
  double value, first, second;
};

/// Symbolic derivatives of a formula by a parameter t with dx/dt = 0.7 and dy/dt = -1.3.
Computed symbolic(const std::string& text, double x, double y) {
  Graph graph;
  const Node inputs[2] = {graph.input(0), graph.input(1)};
  const Node f = read_formula(graph, text, kVariables, inputs);
  Rates along(graph);
  along.set_rate(inputs[0], graph.number(0.7));
  along.set_rate(inputs[1], graph.number(-1.3));
  const Node first = along.of(f).node(), second = along.of(first).node();
  const Program program(graph, std::array{f, first, second});
  std::vector<double> registers;
  program.run_all<double>(std::array{x, y}, registers);
  const auto& at = program.outputs();
  return {registers[at[0]], registers[at[1]], registers[at[2]]};
}

/// The same by Taylor arithmetic.
Taylor taylor(const std::string& text, double x, double y) {
  return Formula(text, kVariables).value<Taylor>(std::array{Taylor(x, 0.7, 0), Taylor(y, -1.3, 0)});
}

TEST(Derivative, EqualsTaylorArithmeticForEveryOperation) {
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
      const Computed found = symbolic(text, x, y);
      const Taylor expected = taylor(text, x, y);
      ASSERT_TRUE(std::isfinite(expected.dd)) << text;
      EXPECT_NEAR(found.value, expected.a, 1e-15 * std::fabs(expected.a)) << text;
      EXPECT_NEAR(found.first, expected.d, 1e-13 * (1 + std::fabs(expected.d))) << text;
      EXPECT_NEAR(found.second, expected.dd, 1e-12 * (1 + std::fabs(expected.dd))) << text;
    }
}

TEST(Derivative, OfAConstantIsTheConstantZero) {
  Graph graph;
  const Node x = graph.input(0), y = graph.input(1);
  Rates by_x(graph);
  by_x.set_rate(x, graph.number(1));
  EXPECT_TRUE(by_x.of(sqrt(Term(graph, y)) * 3.0).is(0));
  EXPECT_TRUE(by_x.of(Term(graph, x) + Term(graph, y)).is(1));
}

TEST(Derivative, UsesAGivenRateOfANode) {
  Graph graph;
  const Term x(graph, graph.input(0)), c = cos(x);
  Rates by_x(graph);
  by_x.set_rate(x.node(), graph.number(1));
  by_x.set_rate(c.node(), graph.number(5));
  EXPECT_TRUE(by_x.of(c).is(5));
}

TEST(Derivative, LiesInItsIntervalEnclosure) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.1, 0.9);
  for (const std::string text :
       {"x + y - 3*x", "x*y/(x + 2)", "x/y", "-x^3 + y^-2", "sqrt(x + y)*abs(x - y)", "sin(x)*cos(y) + tan(x*y)",
        "asin(x) + acos(y*x) + atan(x/y)", "atan2(x, y) - atan2(y, -x)", "sinh(x) + cosh(x*y) - tanh(y)",
        "exp(x*y) + log(x + y)", "min(x, y) + max(x*y, y)", "x < y ? x^2 : y*x", "x^y + y^2.5 + 2^x", "sign(x)*x*y",
        "log10(x*y + 3)"}) {
    Graph graph;
    const std::vector<Node> inputs = {graph.input(0), graph.input(1)};
    const Node f = read_formula(graph, text, kVariables, inputs);
    for (std::size_t by = 0; by < 2; ++by) {
      const Node d = derivative(graph, f, inputs[by]);
      const std::vector<Node> outputs = {f, d};
      const Program program(graph, outputs);
      for (int i = 0; i < 50; ++i) {
        std::vector<Taylor> at = {unit(random), unit(random)};
        at[by].d = 1;
        std::vector<Taylor> values;
        program.run_all<Taylor>(at, values);
        const double expected = values[program.outputs()[0]].d;
        EXPECT_NEAR(values[program.outputs()[1]].a, expected, 1e-12 * (1 + std::fabs(expected))) << text;

        const std::vector<Interval> box = {{at[0].a - 0.01, at[0].a + 0.01}, {at[1].a - 0.01, at[1].a + 0.01}};
        std::vector<Interval> registers;
        program.run_all<Interval>(box, registers);
        const Interval derivatives = registers[program.outputs()[1]];
        EXPECT_LE(derivatives.lower, expected + 1e-12 * std::fabs(expected)) << text;
        EXPECT_GE(derivatives.upper, expected - 1e-12 * std::fabs(expected)) << text;
      }
    }
  }
}

}  // namespace
}  // namespace pkm::expression
