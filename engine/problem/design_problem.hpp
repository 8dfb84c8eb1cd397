// The design optimisation problem of a study: a mechanism, the design variables, objectives, constraints and outputs.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/problem/built_machines.hpp"

#include "engine/problem/choice.hpp"
#include "engine/problem/external_functions.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// One objective, constraint or output of a problem, ready for evaluation.
struct NamedQuantity {
  std::string name;
  std::string unit;
  std::string meaning;
  Direction direction = Direction::maximise;  ///< direction of optimisation; used for objectives only
  std::shared_ptr<const Quantity> quantity;
  std::size_t analysis = 0;  ///< workspace analysis that the quantity uses; 0: that of the whole workspace, k: that of
                             ///< the k-th region
  bool uses_workspace = true;
  Range range = {};  ///< possible values of the quantity
  /// Bound of a constraint on a quantity: its margin is value - lower_bound, or upper_bound - value. If neither is set,
  /// the margin is the value itself.
  std::optional<double> lower_bound, upper_bound;
  /// Statistic over built machines that replaces the value of the quantity; the bounds then apply to the statistic.
  std::optional<SampledValue> sampled = {};

  /// Whether the value needs the workspace analysis of the design itself. A statistic over built machines needs those
  /// of the machines instead.
  bool uses_analysis_of_design() const { return uses_workspace && !sampled; }
};

/// A motion along which a constraint requires every pose to satisfy its limits.
struct FollowedMotion {
  DesignMotion motion;
  std::string mode;  ///< working mode, one of MechanismInfo::modes
};

class DesignProblem;

struct ProblemParts {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;  ///< values of all parameters of the mechanism; a design replaces those that vary
  DesignSpace space;
  std::vector<std::size_t> varies;  ///< design variable i is parameter varies[i] of the mechanism
  WorkspacePlan plan;
  FieldRequest request;
  std::vector<Region> regions;
  std::vector<NamedQuantity> objectives;
  std::vector<NamedQuantity> design_margins;     ///< constraints that need no workspace analysis; they are evaluated
                                                 ///< first
  std::vector<NamedQuantity> workspace_margins;  ///< all other constraints, including those on external functions
  std::vector<NamedQuantity> reports;
  std::vector<FollowedMotion> followed;
  std::vector<Choice> choices;       ///< variables that are choices of a row from a catalogue
  std::vector<std::size_t> rows;     ///< the chosen row of each catalogue, which determines the mechanism
  std::vector<std::size_t> of_rows;  ///< indices of the parameters whose values come from the chosen rows
  /// Makes the problem of the same study with other rows of the catalogues; variables, objectives and constraints are
  /// the same. Null without catalogues.
  std::function<std::shared_ptr<const DesignProblem>(const std::vector<std::size_t>& rows)> with_rows = nullptr;
  std::shared_ptr<ExternalFunctions> functions = std::make_shared<ExternalFunctions>();
  /// Built machines, if a quantity is a statistic over them; otherwise null.
  std::shared_ptr<const BuiltMachines> built = nullptr;
  /// Parameters of single limbs that are tied to a parameter that all limbs share: derivatives with respect to
  /// the shared parameter include their change.
  std::vector<LimbCopy> copies = {};
};

/// Complete evaluation of one design, for the command line and the group /final of the study file.
struct DesignReport {
  std::vector<double> parameters;
  std::vector<double> objectives, margins, reports;  ///< values of the design; NaN: not computed
  Status status = Status::failed;
  std::string reason;  ///< why a value is missing (also for a rejected design); "" if no value is missing
  WorkspaceResult<double> workspace;
  /// Yield over the built machines; std::nullopt: the problem has none, or it was not computed.
  std::optional<Yield> yield = {};
};

class DesignProblem final : public Problem {
 public:
  /// Throws std::invalid_argument if the mechanism does not support the plan of a workspace analysis.
  explicit DesignProblem(ProblemParts parts);

  const DesignSpace& space() const override { return parts_.space; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override {
    return margins_;
  }  ///< margins of all constraints,
     ///< design-level ones first
  const std::vector<OutputInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const override;
  void complete(std::span<EvaluatedDesign> rows) const override;
  bool needs_completion() const override { return !calls_.empty(); }
  /// The external functions that the quantities call, each listed once.
  const std::vector<std::string>& external_calls() const { return calls_; }
  /// The reason why the problem has no derivatives, if a workspace analysis in use or a quantity has none; empty if the
  /// problem has derivatives.
  Unsupported why_no_derivatives() const override;

  const ProblemParts& parts() const { return parts_; }
  /// The problem with the rows of the catalogues that `parameters` selects; this problem if there are no catalogues.
  /// The reference is valid as long as this object. Throws DesignError if there is no such problem.
  const DesignProblem& of(std::span<const double> parameters) const;
  /// The full parameter vector of a design. @param design  one value per variable
  std::vector<double> parameters(std::span<const double> design) const;
  /// Performs a single workspace analysis. @param k  0: the workspace; otherwise the k-th region, from 1
  WorkspaceResult<double> workspace(std::span<const double> parameters, std::size_t k = 0) const;
  /// Evaluates a full parameter vector, which may violate the bounds of the variables (as a baseline may). Continues
  /// if a design-level constraint is violated.
  DesignReport report(std::span<const double> parameters) const;
  /// Evaluates a failed design again and returns the reason: the first quantity without a finite value, and why.
  /// @param detail  level of detail of the evaluation that failed
  std::string failure_reason(std::span<const double> design, Detail detail) const;
  /// Derivatives of objectives and margins with respect to any parameters, also those that are not variables.
  /// @param by  indices of the parameters
  /// @return (objectives + margins) rows of 1 + by.size() numbers: the value, then its derivatives
  std::vector<double> derivatives(std::span<const double> parameters, std::span<const std::size_t> by) const;

 private:
  /// Cache of the problems that differ from this one only in the rows chosen from the catalogues.
  struct OtherRows;
  /// Results of the workspace analyses of a design: first that of the workspace, then one for each region. The result
  /// of an analysis that no quantity uses is empty.
  template <class S>
  using WorkspaceResults = std::vector<WorkspaceResult<S>>;

  struct Buffers;  ///< scratch memory of evaluations

  /// Evaluates a design. @param is_report  true: analyse the workspace even if no quantity uses it
  Status compute(std::span<const double> parameters, Scratch& scratch, EvaluationSlot result,
                 bool is_report = false) const;
  /// Evaluates all built machines of a design, in parallel, and writes their values to the buffers in `scratch`.
  /// @param by  indices of the parameters with respect to which derivatives are computed; std::nullopt: no derivatives
  void evaluate_machines(std::span<const double> parameters, std::optional<std::span<const std::size_t>> by,
                         Scratch& scratch) const;
  /// Evaluates one built machine and sets all values that can be computed.
  void evaluate_machine(std::span<const double> parameters, std::optional<std::span<const std::size_t>> by,
                        Scratch& scratch, std::span<double> objectives, std::span<double> margins,
                        std::span<double> derivatives) const;
  /// Value of a statistic over the built machines, whose values are in the buffers of `scratch`.
  double statistic(const SampledValue& sampled, Scratch& scratch) const;
  /// Statistic of the smooth approximations of the machines' values, with derivatives.
  /// @param first, count  the derivatives are with respect to the parameters with indices first to first + count - 1
  /// @param directions    number of parameters with respect to which derivatives of the values are known
  Dual4 smooth_statistic(const SampledValue& sampled, std::size_t first, std::size_t count, std::size_t directions,
                         Scratch& scratch) const;
  /// Reason why a built machine of this design cannot be evaluated; "" if all can.
  std::string why_machine_fails(std::span<const double> parameters) const;
  /// Computes the values of external functions of a design, after compute(). @return the reason why a call failed; ""
  /// if none failed
  std::string complete(std::span<const double> parameters, const EvaluationSlot& result) const;
  /// Calls an external function for the designs whose parameters are the rows of `parameters`.
  void evaluate_external(const std::string& call, std::span<const double> parameters,
                         std::span<ExternalValue> values) const;
  /// Stores the values of external functions and updates the status. @return the reason of the first failed call; "" if
  /// none failed
  std::string store(std::span<const ExternalValue> values, const EvaluationSlot& result) const;
  DesignReport empty_report(std::span<const double> parameters) const;
  std::string failure_reason(const DesignReport& report) const;
  /// Forward-mode automatic differentiation with respect to the parameters `by`, in blocks of four. Writes the
  /// derivatives to `derivatives`, and the values of the workspace analyses to the buffers in `scratch`.
  void differentiate(std::span<const double> parameters, std::span<const std::size_t> by, std::span<double> derivatives,
                     Scratch& scratch) const;
  /// Runs the workspace analyses that quantities use.
  /// @param all  true: also that of the workspace if no quantity uses it
  template <class S>
  void analyse(std::span<const S> parameters, bool all, Scratch& scratch, WorkspaceResults<S>& results) const;

  ProblemParts parts_;
  std::vector<std::unique_ptr<const WorkspaceEvaluator>> workspace_evaluators_;
  std::vector<std::string> calls_;
  std::vector<bool> used_;  ///< for each workspace analysis, whether a quantity uses it
  std::vector<ObjectiveInfo> objectives_;
  std::vector<MarginInfo> margins_;
  std::vector<OutputInfo> reports_;
  std::shared_ptr<OtherRows> others_;
};

}  // namespace pkm
