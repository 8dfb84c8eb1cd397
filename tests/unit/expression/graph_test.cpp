// Hash-consing and constant folding of expression graphs, stages of programs, and batches against single values.
#include "engine/expression/graph.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/expression/batch_stage.hpp"
#include "engine/expression/formula_parser.hpp"

namespace pkm::expression {
namespace {

const std::vector<std::string> kSymbols = {"a", "b", "x"};
constexpr Groups kParameters = 1, kCoordinate = 2;

/// A graph with the inputs a and b in the group of the design, and x in another one.
struct TestGraph {
  Graph graph;
  std::vector<Node> inputs = {graph.input(0, kParameters), graph.input(1, kParameters), graph.input(2, kCoordinate)};

  Node read(const std::string& text) { return read_formula(graph, text, kSymbols, inputs); }
};

TEST(Graph, SharesCommonSubexpressions) {
  TestGraph c;
  EXPECT_EQ(c.read("sqrt(a*x + b)"), c.read("sqrt(b + x*a)"));
  EXPECT_NE(c.read("a - b"), c.read("b - a"));
  EXPECT_EQ(c.read("sqrt(a*x + b)^2"), c.read("sqrt(b + x*a)*sqrt(a*x + b)"));
}

TEST(Graph, FoldsConstantsAndExpandsIntegerPowers) {
  TestGraph c;
  EXPECT_TRUE(c.graph[c.read("2*sin(pi/6)^2")].is_number());
  EXPECT_EQ(c.read("x^3"), c.read("x*(x*x)"));
  EXPECT_EQ(c.read("x^-2"), c.read("1/(x*x)"));
  EXPECT_EQ(c.read("x^0"), c.read("1"));
}

TEST(Graph, RecordsTheGroupsThatANodeDependsOn) {
  TestGraph c;
  EXPECT_EQ(c.graph[c.read("a*b + 1")].groups, kParameters);
  EXPECT_EQ(c.graph[c.read("x < 2 ? a : 1")].groups, kParameters | kCoordinate);
  EXPECT_EQ(c.graph[c.read("3")].groups, 0u);
}

TEST(Graph, TermsAreSimplified) {
  TestGraph c;
  const Term x(c.graph, c.inputs[2]), one(c.graph, 1.0), none(c.graph, 0.0);
  EXPECT_EQ((x * one + none).node(), x.node());
  EXPECT_TRUE((x * none).is(0));
  EXPECT_EQ((none - x).node(), (-x).node());
}

TEST(Program, EvaluatesEachNodeInTheOutermostPossibleStage) {
  TestGraph c;
  const Node outputs[] = {c.read("sqrt(a) + b"), c.read("(sqrt(a) + b)*x")};
  const Groups stages[] = {kParameters, kCoordinate};
  const Program program(c.graph, outputs, stages);
  EXPECT_EQ(program.stages()[0].steps.size(), 2u);
  EXPECT_EQ(program.stages()[1].steps.size(), 1u);
  std::vector<double> registers(program.registers());
  const double inputs[] = {4, 1, 5};
  program.start<double>(registers);
  program.run<double>(0, inputs, registers);
  EXPECT_EQ(registers[program.outputs()[0]], 3);
  program.run<double>(1, inputs, registers);
  EXPECT_EQ(registers[program.outputs()[1]], 15);
}

TEST(Program, TaylorDerivativesEqualDifferences) {
  TestGraph c;
  const Node output = c.read("atan2(x, a)*sin(b*x) + (x > a ? x^2 : x)");
  const Program program(c.graph, {&output, 1});
  std::vector<Taylor> registers;
  const Taylor inputs[] = {1.0, 2.0, Taylor::variable(1.5)};
  program.run_all<Taylor>(inputs, registers);
  const Taylor got = registers[program.outputs()[0]];
  const auto at = [](double x) { return std::atan2(x, 1) * std::sin(2 * x) + x * x; };
  const double h = 1e-4;
  EXPECT_NEAR(got.a, at(1.5), 1e-14);
  EXPECT_NEAR(got.d, (at(1.5 + h) - at(1.5 - h)) / (2 * h), 1e-7);
  EXPECT_NEAR(got.dd, (at(1.5 + h) - 2 * at(1.5) + at(1.5 - h)) / (h * h), 1e-5);
}

TEST(BatchStage, HasTheSameBitsAsSingleValues) {
  TestGraph c;
  const Node outputs[] = {c.read("sqrt(a - x*x)/(b + x) - abs(x)"), c.read("min(x, a*x, b/x)"),
                          c.read("max(sin(x), -x) + (x < 0.5 ? a : cos(b*x))")};
  const Groups stages[] = {kParameters, kCoordinate};
  const Program program(c.graph, outputs, stages);
  const BatchStage rows(program, 1, program.outputs());
  std::vector<double> registers(program.registers()), row(rows.slots() * kRow);
  const double inputs[] = {2, 3, 0};
  program.start<double>(registers);
  program.run<double>(0, inputs, registers);
  // from -2 on, so that roots of negative numbers are included
  const auto x_of = [](std::size_t k) { return -2 + 0.1 * static_cast<double>(k); };
  for (const auto set : {InstructionSet::baseline, widest_instruction_set()}) {
    const InstructionSet before = instruction_set();
    use_instruction_set(set);
    for (std::size_t k = 0; k < kRow; ++k) row[rows.inputs().at(0) * kRow + k] = x_of(k);
    rows.run(registers.data(), row.data(), kRow);
    use_instruction_set(before);
    for (std::size_t k = 0; k < kRow; ++k) {
      const double one[] = {2, 3, x_of(k)};
      std::vector<double> alone;
      program.run_all<double>(one, alone);
      for (const std::uint32_t output : program.outputs()) {
        const double value = row[rows.operand(output).index * kRow + k];
        EXPECT_TRUE(value == alone[output] || (std::isnan(value) && std::isnan(alone[output]))) << k;
      }
    }
  }
}

}  // namespace
}  // namespace pkm::expression
