// Joint-space inertia at the samples of a workspace analysis, in SIMD batches.
#pragma once

#include "engine/generic/pose_batch.hpp"

namespace pkm::generic {

/// Scratch memory of InertiaBatch.
struct InertiaScratch {
  PoseBatchScratch poses;
  std::vector<double> found;
  expression::Rows M_q, indices;
  std::vector<Dual4> dual_registers;
};

class InertiaBatch {
 public:
  /// @param evaluation  evaluation of a model with bodies
  /// @param rotors      inertia of the drive train of each joint, reflected to the joint; empty: none
  InertiaBatch(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
               const std::vector<double>& rotors);

  /// Evaluates the operations that do not depend on the swept coordinates, for one design, and empties the batch.
  void start(const std::vector<double>& inputs, InertiaScratch& scratch) const;
  /// Adds a pose to the batch. Its values are appended to the fields of the result when the batch is full or finish()
  /// is called.
  void add(const Pose<double>& pose, InertiaScratch& scratch, WorkspaceResult<double>& to) const;
  void finish(InertiaScratch& scratch, WorkspaceResult<double>& to) const;
  /// Overloads of start(), add() and finish() for poses with derivatives. They evaluate the poses one after the other,
  /// without SIMD.
  void start(const std::vector<Dual4>& inputs, InertiaScratch& scratch) const;
  void add(const Pose<Dual4>& pose, InertiaScratch& scratch, WorkspaceResult<Dual4>& to) const;
  void finish(InertiaScratch&, WorkspaceResult<Dual4>&) const {}

 private:
  /// Joint-space inertia matrix M_q of a single pose. @param output  output(i) returns the value of output i of batch_
  template <class S, class OutputOf>
  AxisMatrix<S> inertia_of(const OutputOf& output) const;

  std::size_t n_;
  std::vector<double> rotors_;
  PoseBatch batch_;
  std::vector<expression::Operand> J_, M_X_;
};

}  // namespace pkm::generic
