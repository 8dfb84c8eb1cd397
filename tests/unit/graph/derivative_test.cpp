#include "engine/graph/derivative.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/graph/formula_reader.hpp"
#include "engine/graph/program.hpp"

namespace pkm::graph {
namespace {

const std::vector<std::string> kNames = {"x", "y"};

TEST(Derivative, EqualsThatOfDerivativeNumbersAndLiesInItsInterval) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0.1, 0.9);
  for (const std::string text :
       {"x + y - 3*x", "x*y/(x + 2)", "x/y", "-x^3 + y^-2", "sqrt(x + y)*abs(x - y)", "sin(x)*cos(y) + tan(x*y)",
        "asin(x) + acos(y*x) + atan(x/y)", "atan2(x, y) - atan2(y, -x)", "sinh(x) + cosh(x*y) - tanh(y)",
        "exp(x*y) + log(x + y)", "min(x, y) + max(x*y, y)", "x < y ? x^2 : y*x", "x^y + y^2.5 + 2^x", "sign(x)*x*y"}) {
    Graph graph;
    const std::vector<Node> inputs = {graph.input(0), graph.input(1)};
    const Node f = read_formula(graph, text, kNames, inputs);
    for (std::size_t by = 0; by < 2; ++by) {
      const auto d = derivative(graph, f, inputs[by]);
      ASSERT_TRUE(d) << text;
      const std::vector<Node> outputs = {f, *d};
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

TEST(Derivative, IsNoneWhereAnOperationHasNone) {
  Graph graph;
  const std::vector<Node> inputs = {graph.input(0), graph.input(1)};
  EXPECT_FALSE(derivative(graph, read_formula(graph, "log10(x)", kNames, inputs), inputs[0]));
  const auto flat = derivative(graph, read_formula(graph, "log10(x)", kNames, inputs), inputs[1]);
  ASSERT_TRUE(flat);
  EXPECT_EQ(graph[*flat].number, 0);
}

}  // namespace
}  // namespace pkm::graph
