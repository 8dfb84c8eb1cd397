// Everything an optimiser may ask about a problem.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/core/refusal.hpp"
#include "engine/core/scratch.hpp"
#include "engine/problem/evaluation.hpp"

namespace pkm {

enum class Direction { minimise, maximise };

struct ObjectiveInfo {
  std::string name;
  std::string unit;
  std::string meaning;
  Direction direction = Direction::minimise;
};

/// A number that must be >= 0.
struct MarginInfo {
  std::string name;
  std::string unit;
  std::string meaning;
};

/// A number that is computed and stored, but not optimised.
using ReportInfo = MarginInfo;

/// A design problem. Immutable after construction, so threads share one.
class Problem {
 public:
  virtual ~Problem() = default;

  virtual const DesignSpace& space() const = 0;
  virtual const std::vector<ObjectiveInfo>& objectives() const = 0;
  virtual const std::vector<MarginInfo>& margins() const = 0;
  virtual const std::vector<ReportInfo>& reports() const = 0;

  /// Evaluates one design (dimension() values in the space's units). Thread-safe where each thread has a scratch of its
  /// own. Neither an exception nor a NaN leaves it unmarked: whatever cannot be used has status `failed`.
  ///
  /// result.detail says how much is wanted. Under Detail::enough a broken design-level margin may save the rest.
  virtual void evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const = 0;
  /// Why there are no derivatives (Detail::derivatives must then not be asked for).
  virtual Refusal no_derivatives() const { return "the problem gives no derivatives"; }

  EvaluationShape shape(Detail detail = Detail::enough) const {
    return {space().dimension(), objectives().size(), margins().size(), reports().size(), detail};
  }
};

/// Sum of max(0, -margin); a margin that was not computed (NaN) counts nothing, because the status says so already.
inline double violation(std::span<const double> margins) {
  double sum = 0;
  for (const double margin : margins)
    if (margin < 0) sum -= margin;
  return sum;
}

}  // namespace pkm
