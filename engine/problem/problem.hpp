// Interface of an optimisation problem as the optimisers see it: design space, objectives, constraints, evaluation.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/core/scratch.hpp"
#include "engine/core/unsupported.hpp"
#include "engine/problem/evaluation.hpp"

namespace pkm {

enum class Direction { minimise, maximise };

struct ObjectiveInfo {
  std::string name;
  std::string unit;
  std::string meaning;
  Direction direction = Direction::minimise;
};

/// A constraint g >= 0; its value g is called margin.
struct MarginInfo {
  std::string name;
  std::string unit;
  std::string meaning;
};

/// An output: a value that is computed and stored, but neither optimised nor constrained.
using OutputInfo = MarginInfo;

/// A design whose evaluation has been begun by Problem::evaluate() and has to be completed by Problem::complete().
struct EvaluatedDesign {
  std::span<const double> design;
  EvaluationSlot slot;
  double seconds = 0;  ///< time [s] that Problem::complete() spends on this design
  bool is_complete = false;
};

/// A constrained, possibly multi-objective design problem. Immutable after construction; threads may share it.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual const DesignSpace& space() const = 0;
  virtual const std::vector<ObjectiveInfo>& objectives() const = 0;
  virtual const std::vector<MarginInfo>& margins() const = 0;
  virtual const std::vector<OutputInfo>& reports() const = 0;

  /// Evaluates one design. Thread-safe if each thread passes its own scratch memory. A design whose evaluation
  /// throws DesignError or gives NaN gets the status `failed`; other exceptions are errors of the program and end the
  /// run.
  /// @param design  one value per variable, in the units of space()
  /// @param result  receives the values; result.detail selects what is computed. With Detail::enough, the evaluation
  ///                may end as soon as a design-level constraint is violated.
  virtual void evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const = 0;
  /// Completes designs after evaluate(): computes the values that are computed for a batch of designs at a time, i.e.
  /// those of external functions. Thread-safe.
  /// @param rows  the designs; is_complete is set for each design whose values are complete. If Stopped is thrown, some
  ///              may be incomplete
  virtual void complete([[maybe_unused]] std::span<EvaluatedDesign> rows) const {}
  /// Whether evaluate() must be followed by complete().
  virtual bool needs_completion() const { return false; }
  /// The reason why the problem does not support Detail::derivatives; empty if it does.
  virtual Unsupported why_no_derivatives() const { return "the problem gives no derivatives"; }

  EvaluationShape shape(Detail detail = Detail::enough) const {
    return {space().dimension(), objectives().size(), margins().size(), reports().size(), detail};
  }
};

/// Total constraint violation: the sum of max(0, -margin). Margins that were not computed (NaN) are skipped: the
/// status of the design reflects them.
inline double violation(std::span<const double> margins) {
  double sum = 0;
  for (const double margin : margins)
    if (margin < 0) sum -= margin;
  return sum;
}

}  // namespace pkm
