// A number computed from a surveyed design: what objectives, constraints and reports are made of, and the catalogues'
// entries that make them.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/options.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

/// What a quantity may look at.
template <class S>
struct DesignView {
  const Mechanism& mechanism;
  std::span<const S> parameters;  ///< all of the mechanism's parameters
  const Survey<S>* survey;        ///< null for design-level quantities
  Scratch& scratch;               ///< what quantities overwrite, from design to design
};

class Quantity {
 public:
  virtual ~Quantity() = default;
  /// What is stored, shown and compared.
  virtual double value(const DesignView<double>& design) const = 0;
  /// What gradient solvers are told: the value with derivatives, or a smooth stand-in for it (a worst case).
  virtual Dual4 smooth(const DesignView<Dual4>& design) const = 0;
  /// Why there is no `smooth`.
  virtual Refusal no_derivatives() const { return {}; }
  /// Why its value is not a finite number, where more can be said than that it is not; "" otherwise.
  virtual std::string why_undefined(const DesignView<double>&) const { return {}; }
};

/// Wraps generic functions `[](const auto& design) { ... }` of a DesignView: the value, and its smooth stand-in where
/// the value itself has kinks.
template <class F, class G>
std::unique_ptr<const Quantity> make_quantity(F function, G stand_in, Refusal no_derivatives = {}) {
  class Wrapped final : public Quantity {
   public:
    Wrapped(F f, G g, Refusal why) : function_(std::move(f)), smooth_(std::move(g)), no_derivatives_(std::move(why)) {}
    double value(const DesignView<double>& design) const override { return function_(design); }
    Dual4 smooth(const DesignView<Dual4>& design) const override { return smooth_(design); }
    Refusal no_derivatives() const override { return no_derivatives_; }

   private:
    F function_;
    G smooth_;
    Refusal no_derivatives_;
  };
  return std::make_unique<Wrapped>(std::move(function), std::move(stand_in), std::move(no_derivatives));
}
template <class F>
std::unique_ptr<const Quantity> make_quantity(F function) {
  return make_quantity(function, function);
}

/// A quantity without derivatives.
template <class F>
std::unique_ptr<const Quantity> make_plain_quantity(F function, const std::string& no_derivatives) {
  const auto none = [no_derivatives](const DesignView<Dual4>&) -> Dual4 { throw std::logic_error(no_derivatives); };
  return make_quantity(std::move(function), none, no_derivatives);
}

/// A part of the workspace that a study names: surveyed by a plan of its own.
struct Region {
  std::string name;
  SurveyPlan plan;
  Demand demand;  ///< of all quantities that read it
};

/// What an entry is given when a study asks for it.
struct EntryContext {
  const Mechanism& mechanism;
  const SurveyPlan& plan;  ///< of the survey that the entry reads
  const Options& options;
  std::span<const Region> regions = {};       ///< that the study names
  std::span<const NamedMotion> motions = {};  ///< the study's
};

/// What the values of a quantity can be, whatever the design.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
};
inline Range any_number(const EntryContext&) { return {}; }
inline Range not_negative(const EntryContext&) { return {.least = 0}; }

inline std::string no_unit(const EntryContext&) { return "1"; }
inline Refusal serves_all(const Mechanism&) { return {}; }
inline void needs_nothing(const EntryContext&, Demand&) {}
inline std::vector<OptionSpec> no_options(const MechanismInfo&) { return {}; }

/// An entry of the catalogue of objectives.
struct ObjectiveEntry {
  std::string name;
  std::string meaning;                        ///< one line
  Direction direction = Direction::maximise;  ///< the natural one
  std::vector<OptionSpec> options = {};
  std::function<std::string(const EntryContext&)> unit = no_unit;
  std::function<Refusal(const Mechanism&)> refusal = serves_all;  ///< why this mechanism cannot serve the objective
  /// Adds what the survey has to compute.
  std::function<void(const EntryContext&, Demand&)> demand = needs_nothing;
  std::function<std::unique_ptr<const Quantity>(const EntryContext&)> make = nullptr;
  /// What one with these options computes; none: `meaning`.
  std::function<std::string(const EntryContext&)> detail = nullptr;
  std::function<Range(const EntryContext&)> range = any_number;  ///< of its values
  bool reads_survey = true;  ///< of the workspace, or of the region that a study names; false: the design alone
  /// Whether one with these options reads the survey; none: as `reads_survey` says.
  bool (*needs_survey)(const EntryContext&) = nullptr;

  bool reads(const EntryContext& context) const { return needs_survey ? needs_survey(context) : reads_survey; }
};

/// An entry of the catalogue of constraints: pose-level ones set thresholds, the others give a margin, of the design
/// alone or of its survey.
struct ConstraintEntry {
  std::string name;
  std::string meaning;
  /// Options may depend on the mechanism (its limits' names).
  std::vector<OptionSpec> (*options)(const MechanismInfo&) = no_options;
  std::function<std::string(const EntryContext&)> unit = nullptr;  ///< not of pose-level ones
  std::function<Refusal(const Mechanism&)> refusal = serves_all;
  /// Pose-level only: thresholds this constraint sets, merged by the reader (the same threshold twice is an error).
  LimitSpec (*limits)(const MechanismInfo&, const Options&) = nullptr;
  /// Not of pose-level ones. Throws std::invalid_argument with a sentence when the options name something unknown.
  std::function<std::unique_ptr<const Quantity>(const EntryContext&)> make = nullptr;
  /// Whether one with these options reads the survey, and what it adds to what the survey has to compute; none: no.
  bool (*needs_survey)(const EntryContext&) = nullptr;
  void (*demand)(const EntryContext&, Demand&) = needs_nothing;
  /// What one with these options tests; none: `meaning`.
  std::string (*detail)(const EntryContext&) = nullptr;

  bool pose_level() const { return limits != nullptr; }
};

}  // namespace pkm
