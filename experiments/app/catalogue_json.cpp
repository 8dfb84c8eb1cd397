#include "experiments/app/catalogue.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/problem/expression.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// JSON of a bound: null if it is infinite.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// Words for the values of OptionKind, in their order.
constexpr std::array kKindWords = {"number",        "integer", "flag", "word", "named numbers", "list of named numbers",
                                   "named settings"};

Json options_json(const std::vector<OptionSpec>& specs) {
  return list_json(specs, [](const OptionSpec& spec) -> Json {
    const bool number = spec.kind == OptionKind::number;
    return {{"name", spec.name},
            {"kind", kKindWords[static_cast<std::size_t>(spec.kind)]},
            {"unit", number && spec.unit != kUnitOfEntry ? Json(spec.unit) : Json()},
            {"default", spec.initial ? to_json(*spec.initial) : Json()},
            {"required", spec.required},
            {"min", finite(spec.lower)},
            {"max", finite(spec.upper)},
            {"choices", spec.choices.empty() ? Json() : Json(spec.choices)},
            {"meaning", spec.meaning}};
  });
}

/// JSON that states whether an objective or a constraint on designs supports a mechanism: its unit, or the reason why
/// it does not.
template <class Entry>
Json support_json(const Entry& entry, const std::vector<OptionSpec>& specs, const Mechanism& mechanism) {
  const Unsupported refusal = entry.refusal(mechanism);
  Json json = {{"name", mechanism.info().name}, {"serves", !refusal}, {"unit", nullptr}, {"reason", nullptr}};
  if (refusal) {
    json["reason"] = *refusal;
    // If the entry has required options, its unit depends on them and stays null.
  } else if (entry.unit && !needs_options(specs)) {
    WorkspacePlan plan;
    plan.limits = no_limits(mechanism.info());
    const Options options = default_options(specs);
    json["unit"] = entry.unit({mechanism, plan, options});
  }
  return json;
}

Json limits_json(const MechanismInfo& info, const std::string& group) {
  Json list = Json::array();
  for (const auto& limit : info.limits)
    if (group.empty() || limit.group == group)
      list.push_back({{"name", limit.name},
                      {"unit", limit.unit},
                      {"inactive", limit.inactive},
                      {"min", limit.lower},
                      {"max", limit.upper},
                      {"constraint", limit.group},
                      {"derivation", text_or_null(limit.derivation)},
                      {"meaning", limit.meaning}});
  return list;
}

/// The names that expressions may use, with their units if the workspace is analysed over the default sweep.
Json expression_names_json(const Mechanism& mechanism) {
  using Origin = ExpressionName::Origin;
  return list_json(expression_names(mechanism, {}), [](const ExpressionName& known) -> Json {
    return {
        {"name", known.name},
        {"unit", known.unit},
        {"known", known.origin == Origin::workspace ? "after the workspace analysis" : "before the workspace analysis"},
        {"meaning", known.meaning}};
  });
}

/// Names of those entries of a catalogue that support a mechanism.
template <class List>
Json names_supporting(const List& entries, const Mechanism& mechanism) {
  Json names = Json::array();
  for (const auto& entry : entries)
    if (!entry.refusal(mechanism)) names.push_back(entry.name);
  return names;
}

Json parameters_json(const std::vector<Parameter>& parameters) {
  return list_json(parameters, [](const Parameter& p) -> Json {
    return {{"name", p.name}, {"unit", p.unit}, {"default", p.nominal},
            {"min", p.lower}, {"max", p.upper}, {"meaning", p.meaning}};
  });
}

/// Those parameters that the mechanism does not have with the selected mass model, but with another one.
Json other_parameters_json(const Mechanism& mechanism) {
  Json models = Json::object();
  const Dynamics* const dynamics = mechanism.dynamics();
  if (!dynamics) return models;
  for (const std::string& model : dynamics->mass_models()) {
    if (model == dynamics->mass_model()) continue;
    std::vector<Parameter> own;
    const auto other = dynamics->with_masses(model);
    for (const Parameter& p : other->info().parameters)
      if (!find_named(mechanism.info().parameters, p.name)) own.push_back(p);
    models["masses = " + model] = parameters_json(own);
  }
  return models;
}

Json sweep_json(const MechanismInfo& info, const Sweep& sweep, bool has_columns) {
  return {{"swept", coordinate_names(info, sweep.swept)},
          {"columns_along", has_columns ? Json(coordinate_names(info, {sweep.column})[0]) : Json()},
          {"fixed", coordinate_names(info, sweep.fixed)},
          {"volume_unit", unit_of_product(info, sweep.swept)}};
}

/// JSON that `read` returns for a capability of a mechanism; null if the mechanism lacks this capability.
template <class Capability, class Read>
Json optional_json(const Capability* capability, const Read& read) {
  return capability ? Json(read(*capability)) : Json();
}

Json objective_json(const ObjectiveEntry& entry, const Catalogues& catalogues) {
  const auto support = [&entry](const auto& mechanism) { return support_json(entry, entry.options, *mechanism); };
  return {{"name", entry.name},
          {"meaning", entry.meaning},
          {"direction", entry.direction == Direction::maximise ? "maximise" : "minimise"},
          {"mechanisms", list_json(catalogues.mechanisms, support)},
          {"options", options_json(entry.options)}};
}

Json constraint_json(const ConstraintEntry& entry, const Catalogues& catalogues) {
  const char* level = entry.pose_level() ? "pose" : entry.needs_workspace ? "design or workspace" : "design";
  Json services = Json::array(), options = Json::object(), limits = Json::object();
  for (const auto& mechanism : catalogues.mechanisms) {
    const MechanismInfo& info = mechanism->info();
    const auto specs = entry.options(info);
    services.push_back(support_json(entry, specs, *mechanism));
    if (entry.refusal(*mechanism)) continue;
    options[info.name] = options_json(specs);
    if (entry.pose_level()) limits[info.name] = limits_json(info, entry.name);
  }
  return {{"name", entry.name},     {"meaning", entry.meaning}, {"level", level},
          {"mechanisms", services}, {"options", options},       {"limits", limits}};
}

Json capabilities_json(const Capabilities& capabilities) {
  const bool many = capabilities.max_objectives == kUnlimitedObjectives;
  return {{"min_objectives", capabilities.min_objectives},
          {"max_objectives", many ? Json() : Json(capabilities.max_objectives)},
          {"constraints", capabilities.constraints},
          {"discrete", capabilities.discrete},
          {"needs_gradient", capabilities.needs_gradient},
          {"starts", capabilities.starts}};
}

/// JSON with the capabilities of an optimiser for its default options and, if it has several algorithms, for each of
/// them.
Json optimiser_json(const OptimiserEntry& entry) {
  Options options = default_options(entry.options);
  Json json = {{"name", entry.name},
               {"meaning", entry.meaning},
               {"capabilities", capabilities_json(entry.capabilities(options))},
               {"options", options_json(entry.options)}};
  for (const OptionSpec& spec : entry.options) {
    if (spec.name != "algorithm") continue;
    for (const std::string& algorithm : spec.choices) {
      options.set(spec.name, algorithm);
      json["algorithms"][algorithm] = capabilities_json(entry.capabilities(options));
    }
  }
  return json;
}

}  // namespace

Json mass_model_json(const Mechanism& mechanism) {
  const Dynamics* const dynamics = mechanism.dynamics();
  return dynamics ? Json(dynamics->mass_model()) : Json();
}

Json mechanism_json(const Mechanism& mechanism, const Catalogues& catalogues) {
  const MechanismInfo& info = mechanism.info();
  const bool has_columns = mechanism.columns();
  Json json = {{"name", info.name}, {"meaning", info.title}, {"source", info.source}};
  json["mass_models"] = mechanism.dynamics() ? Json(mechanism.dynamics()->mass_models()) : Json::array();
  json["masses"] = mass_model_json(mechanism);
  json["coordinates"] = names_of(info.coordinates);
  json["joints"] = names_of(info.joints);
  json["modes"] = info.modes;
  json["default_mode"] = info.modes.front();
  json["branches"] = info.branches.empty() ? Json() : Json(info.branches);
  json["influence_coefficients"] = mechanism.velocities() != nullptr;
  const Sweep& default_sweep = info.sweeps.front();
  json.update(sweep_json(info, default_sweep, has_columns));
  json["other_sweeps"] = Json::array();
  for (std::size_t k = 1; k < info.sweeps.size(); ++k) {
    const Json sweep = sweep_json(info, info.sweeps[k], has_columns);
    Json other = {{"fixed", sweep["fixed"]}};
    other.update(sweep);
    json["other_sweeps"].push_back(other);
  }
  std::vector<int> integrated = default_sweep.swept;
  integrated.insert(integrated.end(), default_sweep.fixed.begin(), default_sweep.fixed.end());
  json["integrated_unit"] = default_sweep.integrates ? Json(unit_of_product(info, integrated)) : Json();
  json["size"] = optional_json(mechanism.size(), [](const Size& size) { return size.meaning(); });
  json["size_unit"] = optional_json(mechanism.size(), [](const Size& size) { return size.unit(); });
  json["characteristic_length"] = text_or_null(info.characteristic_length);
  json["objectives"] = names_supporting(catalogues.objectives, mechanism);
  json["constraints"] = names_supporting(catalogues.constraints, mechanism);
  json["parameters"] = parameters_json(info.parameters);
  if (Json others = other_parameters_json(mechanism); !others.empty()) json["parameters_besides"] = std::move(others);
  json["limits"] = limits_json(info, "");
  json["inputs"] = Json::array();
  for (const InputInfo& input : info.inputs)
    json["inputs"].push_back(
        {{"name", input.name}, {"unit", input.unit}, {"default", input.value}, {"meaning", input.meaning}});
  json["quantities"] = Json::array();
  for (const QuantityInfo& quantity : info.quantities)
    json["quantities"].push_back({{"name", quantity.name},
                                  {"unit", quantity.unit},
                                  {"depends_on", quantity.of_design   ? "design"
                                                 : quantity.of_motion ? "pose and motion"
                                                                      : "pose"},
                                  {"meaning", quantity.meaning}});
  json["design_tests"] = Json::array();
  if (const DesignTests* tests = mechanism.design_tests())
    for (const auto& test : tests->list())
      json["design_tests"].push_back({{"name", test.name}, {"unit", test.unit}, {"meaning", test.meaning}});
  json["expression_names"] = expression_names_json(mechanism);
  return json;
}

bool needs_options(const std::vector<OptionSpec>& specs) { return std::ranges::any_of(specs, &OptionSpec::required); }

Json catalogues_json(const Catalogues& catalogues) {
  const auto mechanism = [&](const auto& entry) { return mechanism_json(*entry, catalogues); };
  const auto objective = [&](const auto& entry) { return objective_json(entry, catalogues); };
  const auto constraint = [&](const auto& entry) { return constraint_json(entry, catalogues); };
  return {{"mechanisms", list_json(catalogues.mechanisms, mechanism)},
          {"objectives", list_json(catalogues.objectives, objective)},
          {"constraints", list_json(catalogues.constraints, constraint)},
          {"optimisers", list_json(catalogues.optimisers, optimiser_json)}};
}

}  // namespace pkm
