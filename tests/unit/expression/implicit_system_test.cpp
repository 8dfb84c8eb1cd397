// Systems of equations in programs: an intersection of two circles, whose unknowns are known in closed form, with every
// scalar.
#include "engine/expression/implicit_system.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/expression/batch_stage.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::expression {
namespace {

/// The system u^2 + v^2 = a, (u - c)^2 + v^2 = b, whose coefficients are a, b, c.
std::shared_ptr<const ImplicitSystem> circles() {
  Graph graph;
  std::vector<Node> inputs;
  for (std::size_t i = 0; i < 5; ++i) inputs.push_back(graph.input(i, i < 2 ? 2 : 1));
  const Names names({"u", "v", "a", "b", "c"});
  std::vector<Node> equations = {read_formula(graph, "u*u + v*v - a", names, inputs),
                                 read_formula(graph, "(u - c)*(u - c) + v*v - b", names, inputs)};
  return std::make_shared<const ImplicitSystem>(std::move(graph), std::move(equations), 3);
}

/// The status, u, v, and u*v + a of the system as a program of a, b, c, followed by the closed form.
struct Circles {
  Graph graph;
  std::vector<Node> inputs, outputs;

  /// @param start  of v, as a formula of a, b, c; that of u is 0.5
  explicit Circles(const std::string& start = "1") {
    for (std::size_t i = 0; i < 3; ++i) inputs.push_back(graph.input(i));
    const Names names({"a", "b", "c"});
    std::vector<Node> operands = inputs;
    operands.insert(operands.end(), {graph.number(0.5), read_formula(graph, start, names, inputs)});
    outputs = graph.solve(circles(), operands);
    const Term u(graph, outputs[1]), v(graph, outputs[2]), a(graph, inputs[0]);
    outputs.push_back((u * v + a).node());
    const Term x = (a - Term(graph, inputs[1]) + Term(graph, inputs[2]) * Term(graph, inputs[2])) /
                   (Term(graph, inputs[2]) * 2.0),
               y = sqrt(a - x * x);
    outputs.insert(outputs.end(), {x.node(), y.node(), (x * y + a).node()});
  }

  template <class S>
  std::vector<S> at(const std::vector<S>& values) const {
    const Program program(graph, outputs);
    std::vector<S> registers, found;
    program.run_all<S>(values, registers);
    for (const std::uint32_t output : program.outputs()) found.push_back(registers[output]);
    return found;
  }
};

/// Values of a, b, c for which the circles intersect.
std::vector<std::vector<double>> right_values() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> squares(1, 2), distance(0.6, 1.5);
  std::vector<std::vector<double>> all;
  for (int i = 0; i < 100; ++i) all.push_back({squares(random), squares(random), distance(random)});
  return all;
}

TEST(ImplicitSystem, IsSolvedToRounding) {
  const Circles circles;
  for (const auto& values : right_values()) {
    const auto found = circles.at(values);
    EXPECT_EQ(found[0], 1);
    for (const std::size_t i : {1, 2, 3}) EXPECT_NEAR(found[i], found[i + 3], 5e-15);
  }
}

TEST(ImplicitSystem, IsNotSolvedWithoutASolutionOrOnAnotherBranch) {
  for (const auto& [start, values] : {std::pair("1", std::vector{1.0, 1.0, 2.1}),     // no intersection
                                      std::pair("0", std::vector{1.0, 1.0, 1.0}),     // singular start
                                      std::pair("1", std::vector{1.0, 1.0, 0.0})}) {  // concentric circles
    const auto found = Circles(start).at(values);
    EXPECT_EQ(found[0], -1) << start;
    EXPECT_TRUE(std::isnan(found[1]) && std::isnan(found[2]) && std::isnan(found[3]));
  }
  // the sign of the start selects the branch
  EXPECT_NEAR(Circles("-0.1").at<double>({1, 1, 1})[2], -std::sqrt(0.75), 1e-15);
}

TEST(ImplicitSystem, HasTheDerivativesOfItsClosedForm) {
  const Circles circles;
  for (const auto& values : right_values()) {
    const std::vector<double> plain = circles.at(values);
    std::vector<Dual4> duals;
    for (int i = 0; i < 3; ++i) duals.push_back(Dual4::variable(values[static_cast<std::size_t>(i)], i));
    const auto gradient = circles.at(duals);
    const auto curve = circles.at<Taylor>({{values[0], 0.3, 1.2}, {values[1], -0.7, 0.4}, {values[2], 0.5, -0.9}});
    for (const std::size_t k : {1, 2, 3}) {
      EXPECT_EQ(gradient[k].a, plain[k]);
      EXPECT_EQ(curve[k].a, plain[k]);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(gradient[k].v[i], gradient[k + 3].v[i], 1e-13);
      EXPECT_NEAR(curve[k].d, curve[k + 3].d, 1e-13);
      EXPECT_NEAR(curve[k].dd, curve[k + 3].dd, 1e-12 * (1 + std::fabs(curve[k + 3].dd)));
    }
  }
}

TEST(ImplicitSystem, IsDifferentiatedSymbolicallyAndInReverse) {
  Circles circles;
  const std::vector<Node> outputs = circles.outputs;
  for (const std::size_t k : {1, 2, 3})
    for (const Node by : circles.inputs) {
      const Node first = derivative(circles.graph, outputs[k], by);
      circles.outputs.insert(
          circles.outputs.end(),
          {first, derivative(circles.graph, first, circles.inputs[2]), derivative(circles.graph, outputs[k + 3], by),
           derivative(circles.graph, derivative(circles.graph, outputs[k + 3], by), circles.inputs[2])});
    }
  for (const auto& values : right_values()) {
    const auto found = circles.at(values);
    for (std::size_t i = outputs.size(); i < found.size(); i += 4) {
      EXPECT_NEAR(found[i], found[i + 2], 1e-13);
      EXPECT_NEAR(found[i + 1], found[i + 3], 1e-12 * (1 + std::fabs(found[i + 3])));
    }
    const Program program(circles.graph, {&outputs[3], 1});
    std::vector<double> registers, adjoints(program.registers());
    program.run_all<double>(values, registers);
    adjoints[program.outputs()[0]] = 1;
    backward_sweep(program, 0, registers, adjoints);
    for (const Program::Input& input : program.stages()[0].inputs) {
      const std::size_t derivative_of_product = outputs.size() + 4 * (6 + input.position);
      EXPECT_NEAR(adjoints[input.to], found[derivative_of_product], 1e-13);
    }
  }
}

TEST(ImplicitSystem, HasTheSameBitsInABatch) {
  const Circles circles;
  const Program program(circles.graph, circles.outputs);
  std::vector<std::uint32_t> retained(program.outputs().begin(), program.outputs().begin() + 4);
  const BatchStage stage(program, 0, retained);
  const auto values = right_values();
  std::vector<double> registers(program.registers());
  program.start<double>(registers);
  Rows rows(stage.slots() * kRow);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < kRow; ++k)
      rows[stage.inputs()[i] * kRow + k] = values[k][program.stages()[0].inputs[i].position];
  stage.run(registers.data(), rows.data(), kRow);
  for (std::size_t k = 0; k < kRow; ++k) {
    const auto found = circles.at(values[k]);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rows[stage.operand(retained[i]).index * kRow + k], found[i]);
  }
}

TEST(ImplicitSystem, IsEnclosedByIntervals) {
  const Circles circles;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int verified = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<double> values = {1 + unit(random), 1 + unit(random), 0.6 + 0.9 * unit(random)};
    std::vector<Interval> box;
    const double width = 0.01 * unit(random);
    for (const double value : values) box.push_back({value, value + width});
    const auto enclosures = circles.at(box);
    if (enclosures[0].lower < 1) {
      EXPECT_EQ(enclosures[0].lower, -1);
      EXPECT_FALSE(enclosures[1].is_defined());
      continue;
    }
    ++verified;
    for (int i = 0; i < 50; ++i) {
      std::vector<double> inside = values;
      for (double& value : inside) value += width * unit(random);
      const auto found = circles.at(inside);
      EXPECT_EQ(found[0], 1);
      for (const std::size_t k : {1, 2, 3}) EXPECT_TRUE(enclosures[k].holds(found[k]));
    }
    EXPECT_TRUE(enclosures[1].is_continuous());
    EXPECT_LT(enclosures[1].width(), 6 * width);
  }
  EXPECT_GT(verified, 40);
  // boxes of points are enclosed to rounding
  const auto thin = circles.at<Interval>({1.3, 1.3, 1.0});
  EXPECT_EQ(thin[0].lower, 1);
  EXPECT_LT(thin[2].width(), 1e-14);
}

TEST(ImplicitSystem, IsUnsolvedForBoxesInWhichAnEquationCannotVanish) {
  const auto found = Circles().at<Interval>({{-1.1, -1}, {1, 1.1}, {1, 1.1}});  // u^2 + v^2 = a < 0
  EXPECT_EQ(found[0].upper, -1);
  EXPECT_TRUE(found[1].is_empty());
}

TEST(ImplicitSystem, IsUndecidedForBoxesInWhichASolutionIsMissing) {
  for (const double c : {1.9, 2.0, 2.1}) {
    const auto found = Circles().at<Interval>({{1, 1.1}, {1, 1.1}, {c, c + 0.3}});
    EXPECT_LE(found[0].lower, -1);
    EXPECT_FALSE(found[1].is_defined());
  }
}

}  // namespace
}  // namespace pkm::expression
