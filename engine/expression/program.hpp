// Straight-line programs compiled from an expression graph, with loop-invariant code motion.
//
// The nodes that the outputs depend on become steps in topological order, each of which writes one register. The steps
// are split into stages, one per nested loop (parameters, outer coordinate, ..., innermost coordinate): a step belongs
// to the outermost stage that provides all inputs it depends on. Steps that depend on the parameters alone are
// therefore executed once, steps that depend on the outer coordinate once per value of that coordinate, and so on.
//
// One program serves all scalars: double, dual numbers, Taylor coefficients, intervals; batch_stage.hpp evaluates a
// stage with SIMD instructions.
//
// Reference: Aho, Lam, Sethi, Ullman, "Compilers", 2nd ed., section 9.1.7 (loop-invariant code motion).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/expression/graph.hpp"

namespace pkm::expression {

/// A compiled program. It is immutable and thread-safe, because the registers belong to the caller. Every node that an
/// output depends on has its own register.
class Program {
 public:
  /// A system of equations with the registers of its operands.
  struct SolveStep {
    std::shared_ptr<const ImplicitSystem> system;
    std::vector<std::uint32_t> from;
  };
  struct Step {
    const Operation* operation;
    std::uint32_t to;                               ///< register of the result
    std::array<std::uint32_t, kMaxArguments> from;  ///< registers of the arguments
    std::uint8_t count;                             ///< number of arguments
    Code code;                                      ///< code of `operation`
    /// The system that the step solves, if code is Code::solve; it then writes `to` and the registers that follow it,
    /// one per unknown. It belongs to the program and its copies.
    const SolveStep* solve = nullptr;

    std::span<const std::uint32_t> operands() const;
    std::size_t results() const;  ///< number of registers that the step writes
  };
  struct Input {
    std::uint32_t position;  ///< index of the input among the inputs of the graph
    std::uint32_t to;        ///< register that receives the value of the input
  };
  struct Stage {
    std::vector<Input> inputs;  ///< inputs whose values become available in this stage
    std::vector<Step> steps;

    /// The steps that compute needed registers, in the order of `steps`.
    /// @param needed  for each register, whether its value is needed; registers that these steps read are added
    std::vector<Step> steps_for(std::vector<bool>& needed) const;
  };

  Program() = default;
  /// Compiles the nodes that `outputs` depend on.
  /// @param stages  groups of inputs that each nested loop provides, outermost loop first; inputs of other groups
  ///                belong to the last stage. Empty: one stage
  Program(const Graph& graph, std::span<const Node> outputs, std::span<const Groups> stages = {});

  std::size_t registers() const { return registers_; }
  const std::vector<Stage>& stages() const { return stages_; }
  /// For each output, the register that holds its value.
  const std::vector<std::uint32_t>& outputs() const { return outputs_; }
  /// For each register, the stage that computes it; -1 if it holds a constant.
  const std::vector<int>& stage_of() const { return stage_of_; }

  /// Writes the constants to their registers; running stages does not change them.
  /// @param registers  scratch memory with registers() elements
  template <class S>
  void start(std::span<S> registers) const {
    for (const auto& [to, value] : numbers_) registers[to] = S(value);
  }
  /// Runs a stage; start() and all earlier stages must have been run. S is double, Dual4, Taylor or Interval.
  /// @param inputs  one value per input of the graph; only those of this stage are read
  template <class S>
  void run(std::size_t stage, std::span<const S> inputs, std::span<S> registers) const {
    for (const Input& input : stages_[stage].inputs) registers[input.to] = inputs[input.position];
    run(stage, registers);
  }
  /// Runs a stage whose inputs are in their registers already.
  template <class S>
  void run(std::size_t stage, std::span<S> registers) const;
  /// Runs the whole program: start(), followed by all stages.
  template <class S>
  void run_all(std::span<const S> inputs, std::span<S> registers) const {
    start<S>(registers);
    for (std::size_t stage = 0; stage < stages_.size(); ++stage) run<S>(stage, inputs, registers);
  }
  template <class S>
  void run_all(std::span<const S> inputs, std::vector<S>& registers) const {
    registers.resize(registers_);
    run_all<S>(inputs, std::span<S>(registers));
  }

 private:
  std::vector<Stage> stages_;
  std::vector<std::pair<std::uint32_t, double>> numbers_;  ///< for each constant, its register and its value
  std::vector<std::uint32_t> outputs_;
  std::vector<int> stage_of_;
  std::vector<std::shared_ptr<const SolveStep>> systems_;  ///< systems that the steps solve
  std::size_t registers_ = 0;
};

}  // namespace pkm::expression
