// Evaluates pose quantities that are given by formulas at the samples of a workspace analysis.
#pragma once

#include "engine/generic/pose_batch.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm::generic {

class SampleFormulas {
 public:
  /// @param fields  of a FieldRequest; those that are not formulas are ignored
  SampleFormulas(const Evaluation& evaluation, const std::vector<const PoseQuantity*>& fields,
                 const std::vector<int>& swept, std::size_t mode);

  /// Computes what does not depend on swept coordinates.
  /// @param inputs     of the design, with the fixed coordinates
  /// @param registers  scratch memory
  template <class S>
  void start(const std::vector<S>& inputs, std::vector<S>& registers) const {
    batch_.start<S>(inputs, registers);
  }
  /// Adds the values at a pose to the fields of an analysis; NaN where a formula is undefined.
  template <class S>
  void add(const Pose<S>& pose, std::vector<S>& registers, WorkspaceResult<S>& to) const {
    batch_.run<S>(pose, registers);
    for (std::size_t i = 0; i < quantities_.size(); ++i)
      to.find(*quantities_[i])->push_back(registers[batch_.outputs()[i]]);
  }

 private:
  std::vector<const PoseQuantity*> quantities_;
  PoseBatch batch_;
};

}  // namespace pkm::generic
