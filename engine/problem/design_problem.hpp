// The design problem of a study: a mechanism, what varies, objectives, constraints, reports.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// One objective, margin or report of a problem, ready to be computed.
struct NamedQuantity {
  std::string name;
  std::string unit;
  std::string meaning;
  Direction direction = Direction::maximise;  ///< objectives only
  std::shared_ptr<const Quantity> quantity;
  std::size_t survey = 0;  ///< which one it reads: 0 the workspace's, k the k-th region's
  bool reads_survey = true;
  Range range = {};  ///< of the quantity's values
  /// Margins made from an objective: margin = value - least, or greatest - value. Neither: the value is the margin.
  std::optional<double> least, greatest;
};

/// A motion along which a constraint keeps every limit of a pose.
struct FollowedMotion {
  std::string name;
  std::shared_ptr<const Motion> motion;
  std::string mode;  ///< one of MechanismInfo::modes
};

struct ProblemParts {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;  ///< every parameter; those that vary are overwritten
  DesignSpace space;
  std::vector<std::size_t> varies;  ///< variable i is parameter varies[i]
  SurveyPlan plan;
  Demand demand;
  std::vector<Region> regions;
  std::vector<NamedQuantity> objectives;
  std::vector<NamedQuantity> design_margins;  ///< need no survey: computed first
  std::vector<NamedQuantity> survey_margins;  ///< the others
  std::vector<NamedQuantity> reports;
  std::vector<FollowedMotion> followed;
};

/// All that is known of one design, for the command line and /final.
struct DesignReport {
  std::vector<double> parameters;
  std::vector<double> objectives, margins, reports;  ///< NaN where not computed
  Status status = Status::failed;
  std::string reason;  ///< why a number is missing, also of a rejected design; "" otherwise
  Survey<double> survey;
};

class DesignProblem final : public Problem {
 public:
  /// Throws std::invalid_argument where the mechanism cannot serve a survey's plan.
  explicit DesignProblem(ProblemParts parts);

  const DesignSpace& space() const override { return parts_.space; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }  ///< design-level ones first
  const std::vector<ReportInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const override;
  /// A survey that is read or a quantity lacks them.
  Refusal no_derivatives() const override;

  const ProblemParts& parts() const { return parts_; }
  /// All parameters of a design given by its variables.
  std::vector<double> parameters(std::span<const double> design) const;
  /// One survey alone: of the workspace, or of the k-th region.
  Survey<double> workspace(std::span<const double> parameters, std::size_t k = 0) const;
  /// Evaluates a full parameter vector (a baseline may lie outside the variables' bounds). Computes what it can even
  /// where a design-level margin is violated.
  DesignReport report(std::span<const double> parameters) const;
  /// Why a design failed that was evaluated in that detail: the first thing without a finite value, and its reason.
  std::string why_failed(std::span<const double> design, Detail detail) const;
  /// Slopes of objectives and margins by any parameters, fixed ones included, laid out as in EvaluationShape::slopes.
  /// @param by  indices of parameters
  std::vector<double> slopes(std::span<const double> parameters, std::span<const std::size_t> by) const;

 private:
  /// The surveys of a design: of the workspace, then of the regions. Empty where no quantity reads it.
  template <class S>
  using Surveys = std::vector<Survey<S>>;

  struct Room;  ///< what evaluations overwrite

  Status compute(std::span<const double> parameters, Scratch& scratch, EvaluationSlot result) const;
  DesignReport empty_report(std::span<const double> parameters) const;
  std::string why_failed(const DesignReport& report) const;
  /// Fills `slopes`; the surveys of the scratch receive the values.
  void differentiate(std::span<const double> parameters, std::span<const std::size_t> by, std::span<double> slopes,
                     Scratch& scratch) const;
  template <class S>
  void survey(std::span<const S> parameters, bool all, Scratch& scratch, Surveys<S>& surveys) const;

  ProblemParts parts_;
  std::vector<std::unique_ptr<const Surveyor>> surveyors_;
  std::vector<bool> used_;  ///< whether a quantity reads the survey
  std::vector<ObjectiveInfo> objectives_;
  std::vector<MarginInfo> margins_;
  std::vector<ReportInfo> reports_;
};

}  // namespace pkm
