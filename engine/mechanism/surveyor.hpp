// A survey whose plan is fixed.
#pragma once

#include <span>
#include <string>

#include "engine/core/scratch.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

class SlopeSurveyor;

/// What does not depend on the design is computed once, when it is made. Immutable, shared by threads.
class Surveyor {
 public:
  virtual ~Surveyor() = default;
  /// @param parameters  all parameters of the design, order of MechanismInfo::parameters
  /// @param survey      overwritten; reuse one per thread
  virtual void survey(std::span<const double> parameters, Scratch& scratch, Survey<double>& survey) const = 0;
  /// The same surveys with derivatives; null: there are none, for the reason below.
  virtual const SlopeSurveyor* slopes() const { return nullptr; }
  /// Why surveys of this plan have no derivatives, where they have none.
  virtual std::string why_no_slopes() const { return "the mechanism's surveys give no derivatives"; }
};

class SlopeSurveyor {
 public:
  virtual ~SlopeSurveyor() = default;
  /// The same survey with derivatives by up to four variables. Values have the bits of the survey without them.
  virtual void survey(std::span<const Dual4> parameters, Scratch& scratch, Survey<Dual4>& survey) const = 0;
};

/// Of a plan by voxels, whose cells it can show, too.
class VoxelSurveyor : public Surveyor {
 public:
  /// The cells of one design, box as in a survey.
  virtual VoxelMap map(std::span<const double> parameters) const = 0;
  std::string why_no_slopes() const final {
    return "the study surveys voxels, whose sums have none; take workspace.method = \"columns\"";
  }
};

/// A survey of either kind.
template <class S>
void run_survey(const Surveyor& surveyor, std::span<const S> parameters, Scratch& scratch, Survey<S>& survey) {
  if constexpr (std::is_same_v<S, double>)
    surveyor.survey(parameters, scratch, survey);
  else
    surveyor.slopes()->survey(parameters, scratch, survey);
}

/// With scratch of its own, for those who need no second survey.
template <class S>
void survey_once(const Surveyor& surveyor, std::span<const S> parameters, Survey<S>& survey) {
  Scratch scratch;
  run_survey(surveyor, parameters, scratch, survey);
}

}  // namespace pkm
