// Incremental interval evaluation: which steps run, and enclosures of what they compute.
#include "engine/expression/interval_steps.hpp"

#include <gtest/gtest.h>

#include "engine/expression/changed_steps.hpp"
#include "engine/expression/formula_parser.hpp"

namespace pkm::expression {
namespace {

/// One formula in x and y, whose steps are run one version at a time.
class Steps {
 public:
  explicit Steps(const std::string& text) {
    Graph graph;
    const std::vector<Node> inputs = {graph.input(0), graph.input(1)};
    const Node root = read_formula(graph, text, {{"x", "y"}}, inputs);
    program_ = Program(graph, {&root, 1});
    registers_.resize(program_.registers());
    since_.resize(program_.registers());
    program_.start<Interval>(registers_);
  }
  void set(const Interval& x, const Interval& y) {
    for (const Program::Input& input : program_.stages()[0].inputs) registers_[input.to] = input.position == 0 ? x : y;
  }
  Interval run(std::uint64_t version) {
    run_steps(program_.stages()[0].steps, version, since_, registers_);
    return registers_[program_.outputs().front()];
  }
  /// Runs the steps that depend on changed inputs. @param changed  by set of inputs: version of the last change
  Interval run_changed(std::uint64_t version, const std::array<std::uint64_t, 4>& changed) {
    std::vector<InputSet> sets(program_.registers());
    for (const Program::Input& input : program_.stages()[0].inputs) sets[input.to] = input.position == 0 ? 1 : 2;
    for (const Program::Step& step : program_.stages()[0].steps)
      for (const std::uint32_t operand : step.operands()) sets[step.to] |= sets[operand];
    run_changed_steps(program_.stages()[0].steps, version, {sets, changed}, since_, registers_);
    return registers_[program_.outputs().front()];
  }

 private:
  Program program_;
  std::vector<Interval> registers_;
  std::vector<std::uint64_t> since_;
};

void expect_tight(const Interval& found, double lower, double upper) {
  EXPECT_LE(found.lower, lower);
  EXPECT_GE(found.upper, upper);
  EXPECT_NEAR(found.lower, lower, 1e-13);
  EXPECT_NEAR(found.upper, upper, 1e-13);
}

TEST(IntervalSteps, RunOncePerVersion) {
  Steps f("(x + y)*x");
  f.set({1, 2}, {3, 4});
  expect_tight(f.run(1), 4, 12);
  f.set({5, 6}, {7, 8});
  expect_tight(f.run(1), 4, 12);  // the version says that nothing has changed
  expect_tight(f.run(2), 60, 84);
}

TEST(IntervalSteps, RunIfTheirInputsHaveChanged) {
  Steps f("(x + 1)*(y + 1)");
  f.set({1, 2}, {3, 4});
  expect_tight(f.run_changed(1, {1, 1, 1, 1}), 8, 15);
  f.set({5, 6}, {7, 8});
  expect_tight(f.run_changed(2, {1, 1, 1, 1}), 8, 15);   // no input is said to have changed
  expect_tight(f.run_changed(3, {1, 3, 1, 3}), 24, 35);  // x has changed
  expect_tight(f.run_changed(4, {1, 3, 4, 4}), 48, 63);  // y has changed, too
}

TEST(IntervalSteps, ProductOfANodeWithItselfIsASquare) {
  Steps square("(x + y)*(x + y)"), product("(x + y)*(x - y)");
  square.set({-1, 2}, 0.0);
  expect_tight(square.run(1), 0, 4);
  product.set({-1, 2}, 0.0);
  expect_tight(product.run(1), -2, 4);
}

TEST(IntervalSteps, KnowWhereFormulasAreUndefinedOrDiscontinuous) {
  Steps root("sqrt(x) + y"), step("sign(x) + y");
  root.set({-1, 4}, 1.0);
  const Interval partial = root.run(1);
  EXPECT_FALSE(partial.is_defined());
  expect_tight(partial, 1, 3);
  root.set({-2, -1}, 1.0);
  EXPECT_TRUE(root.run(2).is_empty());
  root.set({1, 4}, 1.0);
  EXPECT_TRUE(root.run(3).is_continuous());
  step.set({-1, 1}, 0.0);
  EXPECT_TRUE(step.run(1).is_defined());
  EXPECT_FALSE(step.run(1).is_continuous());
}

}  // namespace
}  // namespace pkm::expression
