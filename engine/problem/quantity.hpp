// A number computed from a surveyed design: what objectives, constraints and reports are made of, and the catalogues'
// entries that make them.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/problem/problem.hpp"
#include "engine/workspace/mechanism.hpp"

namespace pkm {

/// What a quantity may look at.
template <class S>
struct DesignView {
  const Mechanism& mechanism;
  std::span<const S> parameters;  ///< all of the mechanism's parameters
  const Survey<S>* survey;        ///< null for design-level quantities
};

class Quantity {
 public:
  virtual ~Quantity() = default;
  virtual double value(const DesignView<double>& design) const = 0;
};

/// Wraps one generic function `[](const auto& design) { ... }` of a DesignView.
template <class F>
std::unique_ptr<const Quantity> make_quantity(F function) {
  class Wrapped final : public Quantity {
   public:
    explicit Wrapped(F f) : function_(std::move(f)) {}
    double value(const DesignView<double>& design) const override { return function_(design); }

   private:
    F function_;
  };
  return std::make_unique<Wrapped>(std::move(function));
}

/// What an entry is given when a study asks for it.
struct EntryContext {
  const Mechanism& mechanism;
  const SurveyPlan& plan;
  const Options& options;
};

/// An entry of the catalogue of objectives.
struct ObjectiveEntry {
  std::string name;
  std::string meaning;  ///< one line
  Direction direction;  ///< the natural one
  std::vector<OptionSpec> options;
  std::string (*unit)(const EntryContext&);
  /// "" or one sentence saying why this mechanism cannot serve the objective.
  std::string (*refusal)(const MechanismInfo&);
  void (*demand)(const EntryContext&, Demand&);  ///< adds what the survey has to compute
  std::unique_ptr<const Quantity> (*make)(const EntryContext&);
};

/// An entry of the catalogue of constraints: pose-level ones set thresholds, design-level ones give a margin.
struct ConstraintEntry {
  std::string name;
  std::string meaning;
  bool pose_level = false;
  /// Options may depend on the mechanism (its limits' names).
  std::vector<OptionSpec> (*options)(const MechanismInfo&);
  std::string (*unit)(const EntryContext&);  ///< design-level only
  std::string (*refusal)(const MechanismInfo&);
  /// Pose-level only: thresholds this constraint sets, merged by the reader (the same threshold twice is an error).
  LimitSpec (*limits)(const MechanismInfo&, const Options&);
  /// Design-level only. Throws std::invalid_argument with a sentence when the options name something unknown.
  std::unique_ptr<const Quantity> (*make)(const EntryContext&);
};

}  // namespace pkm
