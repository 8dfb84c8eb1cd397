// Hash-consing and constant folding of expression graphs, stages of programs, and batches against single values.
#include "engine/expression/graph.hpp"

#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/expression/batch_stage.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/expression/reverse_mode.hpp"

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

/// Three functions of a, b and x in two stages, at kRow values of x from -2 on: roots of negative numbers are included.
struct Batch {
  TestGraph c;
  const Node outputs[3] = {c.read("sqrt(a - x*x)/(b + x) - abs(x)"), c.read("min(x, a*x, b/x)"),
                           c.read("max(sin(x), -x) + (x < 0.5 ? a : cos(b*x))")};
  const Groups stages[2] = {kParameters, kCoordinate};
  const Program program{c.graph, outputs, stages};
  const BatchStage stage;
  std::vector<double> registers = std::vector<double>(program.registers());
  Rows rows = Rows(stage.slots() * kRow);

  enum class Retained { outputs, all_registers };
  static BatchStage stage_of(const Program& program, Retained retained) {
    if (retained == Retained::outputs) return {program, 1, program.outputs()};
    std::vector<std::uint32_t> all(program.registers());
    std::iota(all.begin(), all.end(), 0);
    return {program, 1, all};
  }
  static std::array<double, 3> inputs(std::size_t k) { return {2, 3, -2 + 0.1 * static_cast<double>(k)}; }

  explicit Batch(Retained retained) : stage(stage_of(program, retained)) {
    program.start<double>(registers);
    program.run<double>(0, inputs(0), registers);
    for (std::size_t k = 0; k < kRow; ++k) rows[stage.inputs().at(0) * kRow + k] = inputs(k)[2];
    stage.run(registers.data(), rows.data(), kRow);
  }
};

/// Calls test() with each instruction set that this processor supports.
void with_each_instruction_set(const std::function<void()>& test) {
  const InstructionSet before = instruction_set();
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (set > widest_instruction_set()) continue;
    use_instruction_set(set);
    SCOPED_TRACE(name_of(set));
    test();
  }
  use_instruction_set(before);
}

TEST(BatchStage, HasTheSameBitsAsSingleValues) {
  with_each_instruction_set([] {
    const Batch batch(Batch::Retained::outputs);
    for (std::size_t k = 0; k < kRow; ++k) {
      std::vector<double> alone;
      batch.program.run_all<double>(Batch::inputs(k), alone);
      for (const std::uint32_t output : batch.program.outputs()) {
        const double value = batch.rows[batch.stage.operand(output).index * kRow + k];
        EXPECT_TRUE(value == alone[output] || (std::isnan(value) && std::isnan(alone[output]))) << k;
      }
    }
  });
}

TEST(BatchStage, SweepsBackwardAsSingleValuesDo) {
  with_each_instruction_set([] {
    const Batch batch(Batch::Retained::all_registers);
    const auto weight = [](std::size_t output, std::size_t k) { return std::cos(static_cast<double>(3 * k + output)); };
    Rows by_rows(batch.rows.size());
    std::vector<double> by_registers(batch.program.registers()), expected(batch.program.registers());
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < kRow; ++k)
        by_rows[batch.stage.operand(batch.program.outputs()[i]).index * kRow + k] = weight(i, k);
    batch.stage.backward_sweep(batch.registers.data(), batch.rows.data(), kRow, {by_rows.data(), by_registers.data()});
    const std::uint32_t x = batch.program.stages()[1].inputs.at(0).to;
    for (std::size_t k = 0; k < kRow; ++k) {
      std::vector<double> alone, by(batch.program.registers());
      batch.program.run_all<double>(Batch::inputs(k), alone);
      for (std::size_t i = 0; i < 3; ++i) by[batch.program.outputs()[i]] = weight(i, k);
      backward_sweep(batch.program, 1, alone, by);
      EXPECT_EQ(by_rows[batch.stage.operand(x).index * kRow + k], by[x]) << k;
      by[x] = 0;
      for (std::size_t r = 0; r < by.size(); ++r) expected[r] += by[r];
    }
    double largest = 0;
    for (std::size_t r = 0; r < expected.size(); ++r) {
      EXPECT_NEAR(by_registers[r], expected[r], 1e-13 * (1 + std::fabs(expected[r]))) << r;
      largest = std::max(largest, std::fabs(expected[r]));
    }
    EXPECT_GT(largest, 0.1);
    // only the input's adjoints remain
    for (std::size_t k = 0; k < kRow; ++k) by_rows[batch.stage.operand(x).index * kRow + k] = 0;
    EXPECT_EQ(std::ranges::count(by_rows, 0.0), static_cast<std::ptrdiff_t>(by_rows.size()));
  });
}

}  // namespace
}  // namespace pkm::expression
