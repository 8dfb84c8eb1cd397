#include "engine/problem/expression.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/graph/formula_words.hpp"
#include "engine/problem/no_conditioning.hpp"
#include "engine/problem/pose_statistic.hpp"

namespace pkm {
namespace {

template <class S>
struct Room {
  std::vector<S> values, thresholds, stack;
};

/// Whether a formula has the word.
bool has_word(const std::string& formula, const std::string& word) {
  const auto is_letter = [&](std::size_t i) {
    return i < formula.size() && (std::isalnum(static_cast<unsigned char>(formula[i])) || formula[i] == '_');
  };
  for (std::size_t at = formula.find(word); at != std::string::npos; at = formula.find(word, at + 1))
    if (!(at > 0 && is_letter(at - 1)) && !is_letter(at + word.size())) return true;
  return false;
}

/// The expression's formula. Throws std::invalid_argument with a sentence where it names a result of the survey that
/// the mechanism does not have.
const std::string& formula_text(const EntryContext& context) {
  const std::string& formula = context.options.word("expression");
  for (const SurveyResult& result : survey_results()) {
    if (!result.quantity || !has_word(formula, result.name)) continue;
    if (const Refusal reason = unavailable(context.mechanism, *result.quantity))
      throw std::invalid_argument("the formula \"" + formula + "\" names " + result.name + ", and " + *reason);
  }
  return formula;
}

}  // namespace

using Origin = ExpressionName::Origin;

template <class S>
S SurveyResult::value(const Survey<S>& survey, double sharpness, Scratch& scratch) const {
  if (!quantity) return survey.volume;
  if (statistic == "worst") return PoseStatistic{*quantity, "mean", "worst"}(survey, scratch);
  return PoseStatistic{*quantity, statistic, statistic == "mean" ? "mean" : "worst", sharpness}(survey, scratch);
}

template double SurveyResult::value(const Survey<double>&, double, Scratch&) const;
template Dual4 SurveyResult::value(const Survey<Dual4>&, double, Scratch&) const;

const std::vector<SurveyResult>& survey_results() {
  static const std::vector<SurveyResult> list = [] {
    std::vector<SurveyResult> all = {{"volume", "measure of the feasible poses over the swept coordinates"}};
    for (const PoseQuantity* const quantity : pose_quantities())
      for (const auto& [statistic, meaning] : quantity->results)
        if (statistic)
          all.push_back(
              {quantity->name + std::string("_") + statistic, meaning + where_empty(*quantity), quantity, statistic});
    return all;
  }();
  return list;
}

std::vector<ExpressionName> expression_names(const Mechanism& mechanism, const SurveyPlan& plan) {
  const MechanismInfo& info = mechanism.info();
  std::vector<ExpressionName> names;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    if (find_named(info.limits, parameter.name)) continue;  // known as the threshold in force
    if (!graph::may_be_name(parameter.name)) continue;      // of one limb: "arm2.l_b"
    names.push_back({parameter.name, parameter.unit, parameter.meaning, Origin::parameter, i});
  }
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& limit = info.limits[i];
    names.push_back({limit.name, limit.unit, "threshold in force: " + limit.meaning, Origin::threshold, i});
  }
  if (const Size* const size = mechanism.size())
    names.push_back({"size", size->unit(), size->meaning(), Origin::size, 0});
  for (std::size_t i = 0; i < survey_results().size(); ++i) {
    const auto& [name, meaning, quantity, statistic] = survey_results()[i];
    if (!quantity || !unavailable(mechanism, *quantity))
      names.push_back({name, quantity ? quantity->unit : volume_unit(info, plan), meaning, Origin::survey, i});
  }
  return names;
}

std::vector<OptionSpec> expression_options() {
  return {
      {.name = "expression",
       .kind = OptionKind::word,
       .required = true,
       .meaning = "a formula in SI and radians of the names that `pkmopt list mechanisms NAME` shows; it may hold " +
                  formula_help()},
      {.name = "unit",
       .kind = OptionKind::word,
       .initial = std::string("1"),
       .meaning = "SI unit of the value, to show and to read bounds in"},
      characteristic_length_option(),
      sharpness_option("conditioning_min"),
  };
}

Expression::Expression(const EntryContext& context)
    : names_(expression_names(context.mechanism, context.plan)),
      formula_(formula_text(context), names_of(names_)),
      limits_(context.plan.limits),
      sharpness_(context.options.number("sharpness")) {
  Demand demand;
  add_demand(context, demand);
  refuse_idle_options(context.options, demand);
}

bool Expression::uses(Origin origin) const {
  return std::ranges::any_of(formula_.used(), [&](std::size_t i) { return names_[i].origin == origin; });
}

bool Expression::needs_survey() const { return uses(Origin::survey); }

void Expression::add_demand(const EntryContext& context, Demand& demand) const {
  for (const std::size_t i : formula_.used())
    if (names_[i].origin == Origin::survey)
      if (const auto* const quantity = survey_results()[names_[i].index].quantity)
        demand_field(*quantity, context, demand);
}

/// An option without effect was most likely meant for something that the expression does not name.
void Expression::refuse_idle_options(const Options& options, const Demand& demand) const {
  if (options.has("characteristic_length") && !demand.needs_jacobian())
    throw std::invalid_argument("characteristic_length has no effect: the expression names no conditioning");
  const bool softens = std::ranges::any_of(formula_.used(), [&](std::size_t i) {
    if (names_[i].origin != Origin::survey) return false;
    const std::string& statistic = survey_results()[names_[i].index].statistic;
    return statistic == "min" || statistic == "max";
  });
  if (options.values().at("sharpness") != sharpness_option("").initial && !softens)
    throw std::invalid_argument("sharpness has no effect: the expression names no conditioning_min");
}

template <class S>
S Expression::value(const DesignView<S>& design) const {
  auto& [values, thresholds, stack] = design.scratch.template get<Room<S>>();
  values.resize(names_.size());
  thresholds.resize(limits_.given.size());
  if (uses(Origin::threshold)) design.mechanism.thresholds(design.parameters, limits_, thresholds);
  for (const std::size_t i : formula_.used()) {
    const auto& [name, unit, meaning, origin, index] = names_[i];
    switch (origin) {
      case Origin::parameter:
        values[i] = design.parameters[index];
        break;
      case Origin::threshold:
        values[i] = thresholds[index];
        break;
      case Origin::size:
        values[i] = design.mechanism.size()->of(design.parameters);
        break;
      case Origin::survey:
        values[i] = survey_results()[index].value(*design.survey, sharpness_, design.scratch);
    }
  }
  return formula_.value(std::span<const S>(values), stack);
}

template double Expression::value(const DesignView<double>&) const;
template Dual4 Expression::value(const DesignView<Dual4>&) const;

std::string expression_unit(const EntryContext& context) {
  const std::string& unit = context.options.word("unit");
  if (!is_si_unit(unit))
    throw std::invalid_argument("the unit \"" + unit +
                                "\" is no product of SI units; expected one such as \"m^2 rad\", or \"1\"");
  return unit;
}

std::string expression_text(const EntryContext& context) {
  std::istringstream words(context.options.word("expression"));
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace pkm
