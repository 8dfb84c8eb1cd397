// A survey whose plan is fixed.
#pragma once

#include <span>
#include <string>

#include "engine/core/scratch.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

class GradientEvaluator;

/// What does not depend on the design is computed once, when it is made. Immutable, shared by threads.
class WorkspaceEvaluator {
 public:
  virtual ~WorkspaceEvaluator() = default;
  /// @param parameters  all parameters of the design, order of MechanismInfo::parameters
  /// @param survey      overwritten; reuse one per thread
  virtual void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const = 0;
  /// The same surveys with derivatives; null: there are none, for the reason below.
  virtual const GradientEvaluator* slopes() const { return nullptr; }
  /// Why surveys of this plan have no derivatives, where they have none.
  virtual std::string why_no_gradients() const { return "the mechanism's surveys give no derivatives"; }
};

class GradientEvaluator {
 public:
  virtual ~GradientEvaluator() = default;
  /// The same survey with derivatives by up to four variables. Values have the bits of the survey without them.
  virtual void survey(std::span<const Dual4> parameters, Scratch& scratch, Survey<Dual4>& survey) const = 0;
};

/// Of a plan by voxels, whose cells it can show, too.
class VoxelEvaluator : public WorkspaceEvaluator {
 public:
  /// The cells of one design, box as in a survey.
  virtual VoxelMap map(std::span<const double> parameters) const = 0;
  std::string why_no_gradients() const final {
    return "the study surveys voxels, whose sums have none; take workspace.method = \"columns\"";
  }
};

/// A survey of either kind.
template <class S>
void evaluate_workspace(const WorkspaceEvaluator& surveyor, std::span<const S> parameters, Scratch& scratch,
                        Survey<S>& survey) {
  if constexpr (std::is_same_v<S, double>)
    surveyor.survey(parameters, scratch, survey);
  else
    surveyor.slopes()->survey(parameters, scratch, survey);
}

/// With scratch of its own, for those who need no second survey.
template <class S>
void evaluate_once(const WorkspaceEvaluator& surveyor, std::span<const S> parameters, Survey<S>& survey) {
  Scratch scratch;
  evaluate_workspace(surveyor, parameters, scratch, survey);
}

}  // namespace pkm
