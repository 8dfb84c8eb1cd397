// Batched evaluation of nodes at the poses of a workspace analysis: poses are collected until the batch of
// expression::kRow poses is full, and then evaluated with SIMD instructions. Operations that do not depend on the swept
// coordinates are evaluated once.
#pragma once

#include <optional>

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// Scratch memory of PoseBatch.
struct PoseBatchScratch {
  std::vector<double> registers;
  expression::Rows rows;
  std::size_t count = 0;  ///< number of poses in the batch
};

/// Evaluates nodes of the model's graph at batches of poses. The object is immutable; threads can share it if each has
/// its own scratch memory.
class PoseBatch {
 public:
  /// @param outputs  nodes of the model's graph to be evaluated
  PoseBatch(const Model& model, std::vector<Node> outputs, const std::vector<int>& swept, std::size_t mode);

  /// Evaluates the operations that do not depend on the swept coordinates, and empties the batch.
  /// @param inputs  values of the graph's inputs, including the fixed coordinates
  void start(const std::vector<double>& inputs, PoseBatchScratch& scratch) const;
  /// Adds a pose to the batch. @return true if the batch is full
  bool add(const Pose<double>& pose, PoseBatchScratch& scratch) const;
  /// Evaluates the batch, which must contain at least one pose and is padded with copies of its last pose. The caller
  /// then reads the results and sets scratch.count to 0.
  /// @return number of poses with the padding, a multiple of kLanes
  std::size_t run(PoseBatchScratch& scratch) const;

  /// Evaluates a single pose without SIMD, for any scalar type S. The results are in the registers outputs().
  template <class S>
  void start(std::span<const S> inputs, std::vector<S>& registers) const {
    registers.resize(program_.registers());
    program_.start<S>(registers);
    program_.run<S>(0, inputs, registers);
  }
  template <class S>
  void run(const Pose<S>& pose, std::span<S> registers) const {
    const auto& inputs = program_.stages()[1].inputs;
    for (std::size_t i = 0; i < inputs.size(); ++i) registers[inputs[i].to] = pose[coordinates_[i].number];
    program_.run<S>(1, registers);
  }
  const std::vector<std::uint32_t>& outputs() const { return program_.outputs(); }

  /// Where the value of an output of the program is after run(): a row with one number per pose, or a single number.
  expression::Operand operand(std::size_t output) const { return stage_->operand(program_.outputs()[output]); }
  /// Value of an output at a pose of the batch.
  static double value(const expression::Operand& operand, std::size_t pose, const PoseBatchScratch& scratch) {
    return operand.row ? scratch.rows[operand.index * expression::kRow + pose] : scratch.registers[operand.index];
  }

 private:
  struct Coordinate {
    std::size_t number;
    std::uint32_t slot;
  };
  expression::Program program_;
  std::optional<expression::BatchStage> stage_;
  std::vector<Coordinate> coordinates_;  ///< those swept coordinates on which the program depends
};

}  // namespace pkm::generic
