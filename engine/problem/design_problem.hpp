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
  /// Margins made from an objective: margin = value - least, or greatest - value. Neither: the value is the margin.
  std::optional<double> least, greatest;
};

struct ProblemParts {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;  ///< every parameter; those that vary are overwritten
  DesignSpace space;
  std::vector<std::size_t> varies;  ///< variable i is parameter varies[i]
  SurveyPlan plan;
  Demand demand;
  std::vector<NamedQuantity> objectives;
  std::vector<NamedQuantity> design_margins;  ///< need no survey: computed first
  std::vector<NamedQuantity> survey_margins;  ///< the others
  std::vector<NamedQuantity> reports;
};

/// All that is known of one design, for the command line and /final.
struct DesignReport {
  std::vector<double> parameters;
  std::vector<double> objectives, margins, reports;  ///< NaN where not computed
  Status status = Status::failed;
  std::string reason;  ///< why it failed; "" otherwise
  Survey<double> survey;
};

class DesignProblem final : public Problem {
 public:
  explicit DesignProblem(ProblemParts parts);

  const DesignSpace& space() const override { return parts_.space; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }  ///< design-level ones first
  const std::vector<ReportInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, EvaluationSlot result) const override;
  std::string no_derivatives() const override { return surveyor_->no_derivatives(); }

  const ProblemParts& parts() const { return parts_; }
  /// All parameters of a design given by its variables.
  std::vector<double> parameters(std::span<const double> design) const;
  /// Evaluates a full parameter vector (a baseline may lie outside the variables' bounds). Computes what it can even
  /// where a design-level margin is violated.
  DesignReport report(std::span<const double> parameters) const;
  /// Slopes of objectives and margins by any parameters, fixed ones included, laid out as in EvaluationShape::slopes.
  /// @param by  indices of parameters
  std::vector<double> slopes(std::span<const double> parameters, std::span<const std::size_t> by) const;

 private:
  Status compute(std::span<const double> parameters, Survey<double>& survey, EvaluationSlot result) const;
  /// Fills `slopes`; `survey` receives the survey's values.
  void differentiate(std::span<const double> parameters, std::span<const std::size_t> by, std::span<double> slopes,
                     Survey<double>& survey) const;

  ProblemParts parts_;
  std::unique_ptr<const Surveyor> surveyor_;
  std::vector<ObjectiveInfo> objectives_;
  std::vector<MarginInfo> margins_;
  std::vector<ReportInfo> reports_;
};

}  // namespace pkm
