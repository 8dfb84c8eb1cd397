#include "engine/problem/expression.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/conditioning_options.hpp"
#include "engine/problem/survey_results.hpp"

namespace pkm {
namespace {

template <class S>
struct Room {
  std::vector<S> values, thresholds, stack;
};

}  // namespace

using Origin = ExpressionName::Origin;

std::vector<ExpressionName> expression_names(const Mechanism& mechanism, const SurveyPlan& plan) {
  const MechanismInfo& info = mechanism.info();
  std::vector<ExpressionName> names;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    if (find_named(info.limits, parameter.name)) continue;  // known as the threshold in force
    names.push_back({parameter.name, parameter.unit, parameter.meaning, Origin::parameter, i});
  }
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& limit = info.limits[i];
    names.push_back({limit.name, limit.unit, "threshold in force: " + limit.meaning, Origin::threshold, i});
  }
  if (const Size* const size = mechanism.size())
    names.push_back({"size", size->unit(), size->meaning(), Origin::size, 0});
  for (std::size_t i = 0; i < survey_results().size(); ++i) {
    const SurveyResult& result = survey_results()[i];
    if (result.available(mechanism))
      names.push_back({result.name, result.unit(info, plan), result.meaning, Origin::survey, i});
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
      formula_(context.options.word("expression"), names_of(names_)),
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
    if (names_[i].origin == Origin::survey) survey_results()[names_[i].index].demand(context, demand);
}

/// An option without effect was most likely meant for something that the expression does not name.
void Expression::refuse_idle_options(const Options& options, const Demand& demand) const {
  if (options.has("characteristic_length") && !demand.conditioning)
    throw std::invalid_argument("characteristic_length has no effect: the expression names no conditioning");
  const bool softens = std::ranges::any_of(formula_.used(), [&](std::size_t i) {
    return names_[i].origin == Origin::survey && survey_results()[names_[i].index].has_stand_in;
  });
  if (options.values().at("sharpness") != sharpness_option("").initial && !softens)
    throw std::invalid_argument("sharpness has no effect: the expression names no conditioning_min");
}

template <class S>
S Expression::value(const DesignView<S>& design) const {
  auto& [values, thresholds, stack] = design.scratch.template get<Room<S>>();
  values.resize(names_.size());
  thresholds.resize(limits_.given.size());
  if (uses(Origin::threshold)) find_thresholds<S>(design.mechanism, design.parameters, limits_, thresholds);
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
        values[i] = size_of<S>(design.mechanism, design.parameters);
        break;
      case Origin::survey:
        if constexpr (std::is_same_v<S, double>)
          values[i] = survey_results()[index].value(*design.survey, design.scratch);
        else
          values[i] = survey_results()[index].smooth(*design.survey, sharpness_, design.scratch);
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
