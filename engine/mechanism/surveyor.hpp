// A survey whose plan is fixed.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "engine/math/dual.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm {

class SlopeSurveyor;

/// What does not depend on the design is computed once, when it is made. Immutable, shared by threads.
class Surveyor {
 public:
  /// Room that a survey works in: one per thread, reused from design to design, so that nothing is allocated for one.
  class Scratch {
   public:
    virtual ~Scratch() = default;
  };

  virtual ~Surveyor() = default;
  virtual std::unique_ptr<Scratch> make_scratch() const { return std::make_unique<Scratch>(); }
  /// @param parameters  all parameters of the design, order of MechanismInfo::parameters
  /// @param scratch     made by this surveyor
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
  virtual void survey(std::span<const Dual4> parameters, Surveyor::Scratch& scratch, Survey<Dual4>& survey) const = 0;
};

/// What every voxel surveyor answers when asked for derivatives.
inline std::string voxels_have_no_derivatives() {
  return "the study surveys voxels, whose sums have none; take workspace.method = \"columns\"";
}

/// One survey with scratch of its own, for those who need no second.
template <class S>
void survey_once(const Surveyor& surveyor, std::span<const S> parameters, Survey<S>& survey) {
  const auto scratch = surveyor.make_scratch();
  if constexpr (std::is_same_v<S, double>)
    surveyor.survey(parameters, *scratch, survey);
  else
    surveyor.slopes()->survey(parameters, *scratch, survey);
}

}  // namespace pkm
