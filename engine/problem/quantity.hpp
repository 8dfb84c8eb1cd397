// Quantities: scalar functions of a design and its workspace analysis, from which objectives, constraints and outputs
// are made; and the catalogue entries that create them from the options of a study.
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
#include "engine/motion/design_motion.hpp"
#include "engine/problem/problem.hpp"

namespace pkm {

class LargestSolidFinder;

/// Input of a quantity: a design and the analysis of its workspace.
template <class S>
struct DesignView {
  const Mechanism& mechanism;
  std::span<const S> parameters;        ///< all of the mechanism's parameters
  const WorkspaceResult<S>* workspace;  ///< null for design-level quantities
  Scratch& scratch;                     ///< scratch memory, reused from design to design
};

class Quantity {
 public:
  virtual ~Quantity() = default;
  /// The value that is stored, printed and compared.
  virtual double value(const DesignView<double>& design) const = 0;
  /// The value with derivatives for gradient solvers; for a non-smooth value (a worst case), a smooth approximation.
  virtual Dual4 smooth(const DesignView<Dual4>& design) const = 0;
  /// The reason why smooth() is not supported; empty if it is supported.
  virtual Unsupported why_no_derivatives() const { return {}; }
  /// The reason why the value is not finite; "" if no specific reason is known.
  virtual std::string why_undefined(const DesignView<double>&) const { return {}; }
  /// The external function that computes the value, in which case value() must not be called; null if the quantity is
  /// not computed by an external function.
  virtual const std::string* external_call() const { return nullptr; }
  /// The finder of the solid that the value measures; null if the value does not measure a largest solid.
  virtual const LargestSolidFinder* largest_solid() const { return nullptr; }
};

/// Creates a quantity from generic functions `[](const auto& design) { ... }` of a DesignView.
/// @param function       the value
/// @param approximation  its smooth approximation, if the value has kinks; called with Dual4 only
template <class F, class G>
std::unique_ptr<const Quantity> make_quantity(F function, G approximation, Unsupported why_no_derivatives = {}) {
  class Wrapped final : public Quantity {
   public:
    Wrapped(F f, G g, Unsupported why)
        : function_(std::move(f)), smooth_(std::move(g)), why_no_derivatives_(std::move(why)) {}
    double value(const DesignView<double>& design) const override { return function_(design); }
    Dual4 smooth(const DesignView<Dual4>& design) const override { return smooth_(design); }
    Unsupported why_no_derivatives() const override { return why_no_derivatives_; }

   private:
    F function_;
    G smooth_;
    Unsupported why_no_derivatives_;
  };
  return std::make_unique<Wrapped>(std::move(function), std::move(approximation), std::move(why_no_derivatives));
}
template <class F>
std::unique_ptr<const Quantity> make_quantity(F function) {
  return make_quantity(function, function);
}

/// Creates a quantity without derivatives from a function of a DesignView<double>.
template <class F>
std::unique_ptr<const Quantity> make_quantity_without_derivatives(F function, const std::string& why_no_derivatives) {
  const auto none = [why_no_derivatives](const DesignView<Dual4>&) -> Dual4 {
    throw std::logic_error(why_no_derivatives);
  };
  return make_quantity(std::move(function), none, why_no_derivatives);
}

/// A named part of the workspace, `[[region]]` of a study, with its own workspace analysis.
struct Region {
  std::string name;
  WorkspacePlan plan;
  FieldRequest request;  ///< fields of the workspace analysis that the quantities of the region need
};

/// Data of a study from which a catalogue entry (objective, constraint) creates a quantity.
struct EntryContext {
  const Mechanism& mechanism;
  const WorkspacePlan& plan;  ///< plan of the workspace analysis that the entry uses
  const Options& options;
  std::span<const Region> regions = {};        ///< regions of the study
  std::span<const DesignMotion> motions = {};  ///< motions of the study
};

/// Bounds on the values of a quantity, for any design.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};
inline Range unbounded(const EntryContext&) { return {}; }
inline Range nonnegative(const EntryContext&) { return {.lower = 0}; }

inline std::string unit_one(const EntryContext&) { return "1"; }
inline Unsupported supports_every_mechanism(const Mechanism&) { return {}; }
inline void no_request(const EntryContext&, FieldRequest&) {}
inline std::vector<OptionSpec> no_options(const MechanismInfo&) { return {}; }

/// An entry of the catalogue of objectives.
struct ObjectiveEntry {
  std::string name;
  std::string meaning;                        ///< description of the objective, one line
  Direction direction = Direction::maximise;  ///< direction of optimisation unless the study sets another one
  std::vector<OptionSpec> options = {};
  std::function<std::string(const EntryContext&)> unit = unit_one;
  std::function<Unsupported(const Mechanism&)> refusal =
      supports_every_mechanism;  ///< reason why a mechanism does not support the objective; empty if it does
  /// Adds to a FieldRequest the fields of the workspace analysis that the objective uses.
  std::function<void(const EntryContext&, FieldRequest&)> request = no_request;
  std::function<std::unique_ptr<const Quantity>(const EntryContext&)> make = nullptr;
  /// Description of the objective with given options; nullptr: `meaning`.
  std::function<std::string(const EntryContext&)> detail = nullptr;
  std::function<Range(const EntryContext&)> range = unbounded;  ///< range of the objective's values
  bool uses_workspace = true;  ///< true: the objective uses the analysis of the workspace or of a region; false: it
                               ///< depends on the design only
  /// Whether the objective with given options uses the workspace analysis; nullptr: `uses_workspace` holds for all.
  bool (*needs_workspace)(const EntryContext&) = nullptr;

  bool reads(const EntryContext& context) const { return needs_workspace ? needs_workspace(context) : uses_workspace; }
};

/// An entry of the catalogue of constraints. Pose-level constraints set thresholds of the workspace analysis; the
/// others compute a margin from the design or from its workspace analysis.
struct ConstraintEntry {
  std::string name;
  std::string meaning;
  /// The options may depend on the mechanism (names of its limits).
  std::vector<OptionSpec> (*options)(const MechanismInfo&) = no_options;
  std::function<std::string(const EntryContext&)> unit = nullptr;  ///< unit of the margin; nullptr for pose-level
                                                                   ///< constraints
  std::function<Unsupported(const Mechanism&)> refusal = supports_every_mechanism;
  /// Pose-level only: the thresholds that the constraint sets. The reader of studies merges the thresholds of all
  /// constraints; setting one twice is an error.
  LimitSpec (*limits)(const MechanismInfo&, const Options&) = nullptr;
  /// Creates the constraint; nullptr for pose-level constraints. Throws std::invalid_argument with a sentence if an
  /// option has an unknown name.
  std::function<std::unique_ptr<const Quantity>(const EntryContext&)> make = nullptr;
  /// Whether the constraint, with the given options, needs the workspace analysis; nullptr: never.
  bool (*needs_workspace)(const EntryContext&) = nullptr;
  /// Requests the fields of the workspace analysis that the constraint uses.
  void (*request)(const EntryContext&, FieldRequest&) = no_request;
  /// Description of the constraint with given options; nullptr: `meaning`.
  std::string (*detail)(const EntryContext&) = nullptr;

  bool pose_level() const { return limits != nullptr; }
};

}  // namespace pkm
