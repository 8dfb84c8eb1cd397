// Quantities that a study writes as formulas: `expression = "volume / (pi * b * (l_u + l_d))"`.
//
// An expression names parameters of the mechanism (those that vary and those that are fixed), the thresholds in force,
// the mechanism's size and results of the survey, all in SI and radians. Its derivatives are theirs by the chain rule.
#pragma once

#include <string>
#include <vector>

#include "engine/graph/formula.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// A number that an expression may name.
struct ExpressionName {
  enum class Origin { parameter, threshold, size, survey };

  std::string name;
  std::string unit;
  std::string meaning;
  Origin origin = Origin::parameter;
  std::size_t index = 0;  ///< among the mechanism's parameters or limits, or in survey_results()
};

/// A number that a survey gives.
struct SurveyResult {
  std::string name;
  std::string meaning;
  const PoseQuantity* quantity = nullptr;  ///< null: the volume
  std::string statistic = {};              ///< of PoseResult

  /// With derivatives, a worst case by its smooth stand-in of that sharpness.
  template <class S>
  S value(const Survey<S>& survey, double sharpness, Scratch& scratch) const;
};

/// The volume, and those of every quantity of poses.
const std::vector<SurveyResult>& survey_results();

/// Every name that the expressions of a mechanism know; `pi` and the functions are the formula's own.
std::vector<ExpressionName> expression_names(const Mechanism& mechanism, const SurveyPlan& plan);

/// The options of every entry made of an expression.
std::vector<OptionSpec> expression_options();

/// The expression that an entry's options describe.
class Expression {
 public:
  /// Throws std::invalid_argument with a sentence when the options make no sense.
  explicit Expression(const EntryContext& context);

  bool needs_survey() const;
  /// Adds what the survey has to compute.
  void add_demand(const EntryContext& context, Demand& demand) const;
  /// With derivatives: a worst case by its smooth stand-in. The survey may be null where none is needed.
  template <class S>
  S value(const DesignView<S>& design) const;

 private:
  bool uses(ExpressionName::Origin origin) const;
  void refuse_idle_options(const Options& options, const Demand& demand) const;

  std::vector<ExpressionName> names_;
  Formula formula_;
  LimitSpec limits_;
  double sharpness_;
};

/// The unit of an expression's value, as the study says.
std::string expression_unit(const EntryContext& context);
/// An expression on one line, for listings.
std::string expression_text(const EntryContext& context);

}  // namespace pkm
