// Nodes at the poses of a survey, 64 poses at a time: what depends on a swept coordinate is computed in rows.
#pragma once

#include <optional>

#include "engine/expression/batch_stage.hpp"
#include "engine/generic/evaluation.hpp"

namespace pkm::generic {

/// What a worker overwrites.
struct PoseRowsRoom {
  std::vector<double> registers;
  expression::Rows rows;
  std::size_t count = 0;  ///< poses that wait
};

class PoseRows {
 public:
  /// @param outputs  nodes of the model's graph
  PoseRows(const Model& model, std::vector<Node> outputs, const std::vector<int>& swept, std::size_t mode);

  /// Computes what no swept coordinate changes. @param inputs  of the design, with held coordinates
  void start(const std::vector<double>& inputs, PoseRowsRoom& room) const;
  /// @return  whether the row is full
  bool add(const Pose<double>& pose, PoseRowsRoom& room) const;
  /// Computes the poses that wait, of which there are some; lanes beyond the last pose are like it. The caller sets
  /// room.count to 0 when it has read them. @return  whole lanes
  std::size_t run(PoseRowsRoom& room) const;

  /// The same of one pose after the other, for any scalar: the outputs are in these registers.
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

  /// Where an output is.
  expression::Operand operand(std::size_t output) const { return stage_->operand(program_.outputs()[output]); }
  static double value(const expression::Operand& of, std::size_t pose, const PoseRowsRoom& room) {
    return of.row ? room.rows[of.index * expression::kRow + pose] : room.registers[of.index];
  }

 private:
  struct Coordinate {
    std::size_t number;
    std::uint32_t slot;
  };
  expression::Program program_;
  std::optional<expression::BatchStage> stage_;
  std::vector<Coordinate> coordinates_;  ///< swept ones that the program uses
};

}  // namespace pkm::generic
