// A graph's nodes in the order of computation, split over nested loops: what depends on parameters alone is computed
// once, what depends on the outer coordinate once for each of its values, and so on.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/graph/graph.hpp"

namespace pkm::graph {

/// Immutable, shared by threads. Every node in use has a register.
class Program {
 public:
  struct Step {
    const Operation* operation;
    std::uint32_t to;
    std::array<std::uint32_t, kMostArguments> from;
    std::uint8_t count;
    Code code;  ///< the operation's
  };
  struct Input {
    std::uint32_t position;  ///< among the graph's inputs
    std::uint32_t to;
  };
  struct Stage {
    std::vector<Input> inputs;  ///< that this stage brings
    std::vector<Step> steps;
  };

  Program() = default;
  /// @param stages  the groups of inputs that each nested loop brings, the outermost first; those that no one names
  ///                come with the last
  Program(const Graph& graph, std::span<const Node> outputs, std::span<const Groups> stages = {});

  std::size_t registers() const { return registers_; }
  const std::vector<Stage>& stages() const { return stages_; }
  const std::vector<std::uint32_t>& outputs() const { return outputs_; }  ///< the register of each
  const std::vector<int>& stage_of() const { return stage_of_; }          ///< by register; -1: a number

  /// Sets the registers of numbers; they stay. @param registers  as many as registers()
  template <class S>
  void start(std::span<S> registers) const {
    for (const auto& [to, value] : numbers_) registers[to] = S(value);
  }
  /// Computes a stage after those before it. S is double, Dual4, Taylor or Interval.
  /// @param inputs  one number per input of the graph; those that the stage does not bring are not looked at
  template <class S>
  void run(std::size_t stage, std::span<const S> inputs, std::span<S> registers) const {
    for (const Input& input : stages_[stage].inputs) registers[input.to] = inputs[input.position];
    run(stage, registers);
  }
  /// The same with inputs in their registers.
  template <class S>
  void run(std::size_t stage, std::span<S> registers) const;
  /// All of it.
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
  std::vector<std::pair<std::uint32_t, double>> numbers_;
  std::vector<std::uint32_t> outputs_;
  std::vector<int> stage_of_;
  std::size_t registers_ = 0;
};

}  // namespace pkm::graph
