// Workspace analysis of many designs under one plan.
#pragma once

#include <span>
#include <string>

#include "engine/core/scratch.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm {

class GradientEvaluator;

/// Analyses the workspaces of designs under one plan. The constructor computes everything that does not depend on the
/// design. Immutable and thread-safe.
class WorkspaceEvaluator {
 public:
  virtual ~WorkspaceEvaluator() = default;
  /// @param parameters  all parameters of the design, in the order of MechanismInfo::parameters
  /// @param result      its content is overwritten; one object per thread should be reused
  virtual void evaluate(std::span<const double> parameters, Scratch& scratch,
                        WorkspaceResult<double>& result) const = 0;
  /// Returns the same analysis with derivatives; null if there is none (why_no_derivatives() returns the reason).
  virtual const GradientEvaluator* gradients() const { return nullptr; }
  virtual std::string why_no_derivatives() const { return "workspace analyses of the mechanism have no derivatives"; }
};

class GradientEvaluator {
 public:
  virtual ~GradientEvaluator() = default;
  /// Analyses the workspace with derivatives with respect to up to four variables. Values are bit-identical to those of
  /// WorkspaceEvaluator::evaluate().
  virtual void evaluate(std::span<const Dual4> parameters, Scratch& scratch, WorkspaceResult<Dual4>& result) const = 0;
};

/// Interface of a workspace evaluator for plans with voxels.
class VoxelEvaluator : public WorkspaceEvaluator {
 public:
  /// Finds the feasible cells of a design. Coordinates that are integrated over are fixed at the centre of their first
  /// cell.
  virtual VoxelMap map(std::span<const double> parameters) const = 0;
  std::string why_no_derivatives() const final {
    return "voxel counts are piecewise constant and have no derivatives; set workspace.method = \"columns\"";
  }
};

/// Analyses a workspace by that overload of evaluate() which computes results of the scalar type S.
/// @param evaluator  its gradients() must not be null if S is Dual4
template <class S>
void evaluate_workspace(const WorkspaceEvaluator& evaluator, std::span<const S> parameters, Scratch& scratch,
                        WorkspaceResult<S>& result) {
  if constexpr (std::is_same_v<S, double>)
    evaluator.evaluate(parameters, scratch, result);
  else
    evaluator.gradients()->evaluate(parameters, scratch, result);
}

/// Calls evaluate_workspace() with temporary scratch memory, for a single analysis.
template <class S>
void evaluate_once(const WorkspaceEvaluator& evaluator, std::span<const S> parameters, WorkspaceResult<S>& result) {
  Scratch scratch;
  evaluate_workspace(evaluator, parameters, scratch, result);
}

}  // namespace pkm
