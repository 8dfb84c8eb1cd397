// Evaluates pose quantities that are given by formulas, at the samples of a workspace analysis, in SIMD batches.
#pragma once

#include "engine/generic/pose_batch.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm::generic {

/// Scratch memory of SampleFormulas.
struct FormulaScratch {
  PoseBatchScratch poses;
  std::vector<Dual4> dual_registers;
};

class SampleFormulas {
 public:
  /// @param fields  fields of a FieldRequest; those that are not given by formulas are ignored
  SampleFormulas(const Evaluation& evaluation, const std::vector<const PoseQuantity*>& fields,
                 const std::vector<int>& swept, std::size_t mode);

  /// Evaluates the operations that do not depend on the swept coordinates, for one design, and empties the batch.
  void start(const std::vector<double>& inputs, FormulaScratch& scratch) const { batch_.start(inputs, scratch.poses); }
  /// Adds a pose to the batch. Its values, NaN where a formula is undefined, are appended to the fields of the result
  /// when the batch is full or finish() is called.
  void add(const Pose<double>& pose, FormulaScratch& scratch, WorkspaceResult<double>& to) const;
  void finish(FormulaScratch& scratch, WorkspaceResult<double>& to) const;
  /// Overloads of start(), add() and finish() for poses with derivatives. They evaluate the poses one after the other,
  /// without SIMD.
  void start(const std::vector<Dual4>& inputs, FormulaScratch& scratch) const {
    batch_.start<Dual4>(inputs, scratch.dual_registers);
  }
  void add(const Pose<Dual4>& pose, FormulaScratch& scratch, WorkspaceResult<Dual4>& to) const;
  void finish(FormulaScratch&, WorkspaceResult<Dual4>&) const {}

 private:
  std::vector<const PoseQuantity*> quantities_;
  PoseBatch batch_;
};

}  // namespace pkm::generic
