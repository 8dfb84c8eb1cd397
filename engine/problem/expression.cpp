#include "engine/problem/expression.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/expression/formula_lexer.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/problem/pose_statistic.hpp"

namespace pkm {
namespace {

template <class S>
struct ExpressionScratch {
  std::vector<S> values, thresholds, stack;
};

/// Whether a formula contains `word` as a whole identifier.
bool has_word(const std::string& formula, const std::string& word) {
  const auto is_name_char = [&](std::size_t i) {
    return i < formula.size() && (std::isalnum(static_cast<unsigned char>(formula[i])) || formula[i] == '_');
  };
  for (std::size_t at = formula.find(word); at != std::string::npos; at = formula.find(word, at + 1))
    if (!(at > 0 && is_name_char(at - 1)) && !is_name_char(at + word.size())) return true;
  return false;
}

/// The formula of the expression. Throws std::invalid_argument with a sentence if it uses a result of the workspace
/// analysis that the mechanism does not support.
const std::string& formula_text(const EntryContext& context) {
  const std::string& formula = context.options.word("expression");
  for (const AnalysisResult& result : analysis_results(context.mechanism.info())) {
    if (!result.quantity || !has_word(formula, result.name)) continue;
    if (const Unsupported reason = why_unavailable(context.mechanism, *result.quantity))
      throw std::invalid_argument("the formula \"" + formula + "\" uses " + result.name + ", but " + *reason);
  }
  return formula;
}

}  // namespace

using Origin = ExpressionName::Origin;

template <class S>
S AnalysisResult::value(const WorkspaceResult<S>& workspace, double sharpness, Scratch& scratch) const {
  if (!quantity) return workspace.volume;
  if (statistic == "worst") return PoseStatistic{*quantity, "mean", "worst"}(workspace, scratch);
  return PoseStatistic{*quantity, statistic, statistic == "mean" ? "mean" : "worst", sharpness}(workspace, scratch);
}

template double AnalysisResult::value(const WorkspaceResult<double>&, double, Scratch&) const;
template Dual4 AnalysisResult::value(const WorkspaceResult<Dual4>&, double, Scratch&) const;

std::vector<AnalysisResult> analysis_results(const MechanismInfo& info) {
  std::vector<AnalysisResult> all = {{"volume", "measure of the feasible poses over the swept coordinates"}};
  for (const PoseQuantity* const quantity : pose_quantities(info))
    for (const auto& [statistic, meaning] : quantity->results)
      if (statistic)
        all.push_back({quantity->name + std::string("_") + statistic, meaning + empty_workspace_note(*quantity),
                       quantity, statistic});
  return all;
}

std::vector<ExpressionName> expression_names(const Mechanism& mechanism, const WorkspacePlan& plan) {
  const MechanismInfo& info = mechanism.info();
  std::vector<ExpressionName> names;
  for (std::size_t i = 0; i < info.parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[i];
    if (find_named(info.limits, parameter.name))
      // Skip a parameter that has the name of a limit: in expressions, this name denotes the threshold in effect.
      continue;
    if (!expression::may_be_name(parameter.name))
      // Skip the parameters of single limbs, such as "arm2.l_b", because formulas cannot contain their names.
      continue;
    names.push_back({parameter.name, parameter.unit, parameter.meaning, Origin::parameter, i});
  }
  for (std::size_t i = 0; i < info.limits.size(); ++i) {
    const LimitInfo& limit = info.limits[i];
    if (limit.group == kQuantityLimit) continue;  // as a name in expressions, it denotes the statistic of the quantity
    names.push_back({limit.name, limit.unit, "threshold in effect: " + limit.meaning, Origin::threshold, i});
  }
  if (const Size* const size = mechanism.size())
    names.push_back({"size", size->unit(), size->meaning(), Origin::size, 0});
  const std::vector<AnalysisResult> results = analysis_results(info);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& [name, meaning, quantity, statistic] = results[i];
    if (quantity && (find_named(names, name) || why_unavailable(mechanism, *quantity))) continue;
    names.push_back({name, quantity ? quantity->unit : volume_unit(info, plan), meaning, Origin::workspace, i});
  }
  return names;
}

std::vector<OptionSpec> expression_options() {
  return {
      {.name = "expression",
       .kind = OptionKind::word,
       .required = true,
       .meaning = "a formula in SI units and radians. It may contain the names that `pkmopt list mechanisms NAME` "
                  "prints, " +
                  formula_help()},
      {.name = "unit",
       .kind = OptionKind::word,
       .initial = std::string("1"),
       .meaning = "SI unit of the value and of its bounds"},
      characteristic_length_option(),
      sharpness_option("conditioning_min"),
  };
}

Expression::Expression(const EntryContext& context)
    : results_(analysis_results(context.mechanism.info())),
      names_(expression_names(context.mechanism, context.plan)),
      formula_(formula_text(context), names_of(names_)),
      limits_(context.plan.limits),
      sharpness_(context.options.number("sharpness")) {
  FieldRequest request;
  add_request(context, request);
  refuse_unused_options(context.options, request);
}

bool Expression::uses(Origin origin) const {
  return std::ranges::any_of(formula_.used(), [&](std::size_t i) { return names_[i].origin == origin; });
}

bool Expression::needs_workspace() const { return uses(Origin::workspace); }

void Expression::add_request(const EntryContext& context, FieldRequest& request) const {
  for (const std::size_t i : formula_.used())
    if (names_[i].origin == Origin::workspace)
      if (const auto* const quantity = results_[names_[i].index].quantity) request_field(*quantity, context, request);
}

/// Rejects options that have no effect, because the user probably expects the expression to use another quantity.
void Expression::refuse_unused_options(const Options& options, const FieldRequest& request) const {
  if (options.has("characteristic_length") && !request.needs_jacobian())
    throw std::invalid_argument("characteristic_length has no effect: the expression does not use the conditioning");
  const bool has_extremum = std::ranges::any_of(formula_.used(), [&](std::size_t i) {
    if (names_[i].origin != Origin::workspace) return false;
    const std::string& statistic = results_[names_[i].index].statistic;
    return statistic == "min" || statistic == "max";
  });
  if (options.values().at("sharpness") != sharpness_option("").initial && !has_extremum)
    throw std::invalid_argument("sharpness has no effect: the expression uses no worst case such as conditioning_min");
}

template <class S>
S Expression::value(const DesignView<S>& design) const {
  auto& [values, thresholds, stack] = design.scratch.template get<ExpressionScratch<S>>();
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
      case Origin::workspace:
        values[i] = results_[index].value(*design.workspace, sharpness_, design.scratch);
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
                                "\" is not a product of SI units; expected one such as \"m^2 rad\", or \"1\"");
  return unit;
}

std::string expression_text(const EntryContext& context) {
  std::istringstream words(context.options.word("expression"));
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  return text;
}

}  // namespace pkm
