#include "engine/config/mechanism_file.hpp"

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_keys.hpp"
#include "engine/config/mechanism_solve.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/generic/equations.hpp"
#include "engine/generic/mechanism.hpp"
#include "engine/geometry/mixed_units.hpp"

namespace pkm {
namespace {

using generic::Inputs;
using limbs::Term;

const std::vector<std::string> kUnits = {"m", "rad", "kg",      "kg m^2", "kg/m", "kg/m^3",
                                         "N", "N/m", "N m/rad", "Pa",     "1"};

void read_names(const ConfigValue& root, MechanismDraft& draft) {
  const ConfigValue table = root.at("mechanism", "a table [mechanism] with name, title, source").table();
  const ConfigValue name = table.at("name", "the mechanism's name");
  draft.model.info.name = name.text("the mechanism's name");
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (draft.model.info.name.empty() || draft.model.info.name.size() > 60 ||
      !std::ranges::all_of(draft.model.info.name, fits))
    throw name.error("a name of at most 60 letters, digits, '-' and '_'");
  draft.model.info.title = text_of(table, "title");
  draft.model.info.source = text_of(table, "source");
}

/// The SI unit of a parameter, derived from its default value: for example "m" if the value is "200 mm".
std::string unit_of(const ConfigValue& table) {
  if (const auto unit = table.find("unit")) return si_unit(*unit);
  const ConfigValue value = table.at("default", "the default, a number or text with a unit: \"200 mm\"");
  if (!value.is_text()) return "1";
  const std::string& text = value.text("a number or text with a unit");
  if (parse_quantity(text, "1")) return "1";
  for (const std::string& unit : kUnits)
    if (parse_quantity(text, unit)) return unit;
  throw value.error("a number, or text with a unit: \"200 mm\", \"40 deg\"; other units by unit = \"..\"");
}

/// The parameter of a single limb: a copy of the parameter that all limbs share, with the values that `table` changes.
Parameter own_parameter(const ConfigValue& table, const LimbParameter& own, const std::vector<Parameter>& all) {
  const Parameter* const general = find_named(all, own.parameter);
  if (!general)
    throw table.refusal("there is no common parameter '" + own.parameter + "' above, whose value " + own.name() +
                        " could replace");
  Parameter p = *general;
  p.lower = table.find_number("min", p.unit).value_or(p.lower);
  p.upper = table.find_number("max", p.unit).value_or(p.upper);
  if (!(p.lower < p.upper)) throw table.refusal("max must be greater than min");
  p.nominal = table.find_number("default", p.unit, p.lower, p.upper).value_or(p.nominal);
  if (table.has("meaning")) p.meaning = text_of(table, "meaning");
  return p;
}

/// Adds the parameters of a table, [parameters] or that of a mass model.
void read_parameter_table(const ConfigValue& all, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  for (const std::string& name : all.dotted_keys(true)) {
    const ConfigValue value = *all.find(name);
    if (const auto own = limb_parameter(name, value.place())) {
      const ConfigValue table = value.described_by(limb_parameter_keys());
      add_own_parameter(*own, own_parameter(table, *own, model.info.parameters), draft);
      continue;
    }
    const ConfigValue table = value.table();
    if (name == generic::kClearanceLimit)
      throw table.refusal(
          "the name clearance_min is reserved for the limit of the clearance of links; rename the parameter");
    Parameter p;
    p.name = name;
    p.unit = unit_of(table);
    p.lower = table.at("min", "the minimum allowed value").number(p.unit);
    p.upper = table.at("max", "the maximum allowed value").number(p.unit);
    if (!(p.lower < p.upper)) throw table.find("max")->error("a number above min = " + with_unit(p.lower, p.unit));
    p.nominal = table.at("default", "the default").number(p.unit, p.lower, p.upper);
    p.meaning = text_of(table, "meaning");
    draft.scope.add(table, name, model.graph.input(model.info.parameters.size(), Inputs::kDesign));
    model.info.parameters.push_back(p);
  }
}

void read_parameters(const ConfigValue& root, const std::vector<LimbParameter>& asked, const StudyAdditions& study,
                     MechanismDraft& draft) {
  const ConfigValue all = root.at("parameters", "a table [parameters] with at least one parameter").table();
  if (all.keys().empty()) throw all.error("at least one parameter");
  read_parameter_table(all, draft);
  if (draft.masses)
    if (const auto more = draft.masses->find_table("parameters")) read_parameter_table(*more, draft);
  if (study)
    if (const auto more = study->find_table("parameters")) read_parameter_table(*more, draft);
  generic::Model& model = draft.model;
  for (const LimbParameter& own : asked) {
    const Parameter* const general = find_named(model.info.parameters, own.parameter);
    const auto known = names_of(model.info.parameters);
    if (!general)
      throw ConfigError(own.place, "the unknown parameter '" + own.parameter + "' of " + own.name(),
                        "one of " + join(known), nearest_name(own.parameter, known));
    if (!find_named(model.info.parameters, own.name())) add_own_parameter(own, Parameter(*general), draft);
  }
  model.inputs.parameters = model.info.parameters.size();
}

void read_let(const ConfigValue& root, MechanismDraft& draft) {
  for (const auto& all : {root.find_table("let"), draft.masses ? draft.masses->find_table("let") : std::nullopt}) {
    if (!all) continue;
    draft.let.push_back(*all);
    for (const std::string& name : all->keys()) {
      const ConfigValue value = *all->find(name);
      draft.scope.add(value, name, draft.scope.formula_of_any_kind(value, "1", name));
    }
  }
}

/// Selects one of the mass models in [masses]. A mass model can have its own parameters and formulas.
/// @param chosen  name of the model; "": the first
void choose_masses(const ConfigValue& root, const std::string& chosen, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const auto all = root.find_table("masses");
  if (!all) {
    model.mass_models = {"file"};
  } else {
    if (all->keys().empty()) throw all->error("at least one alternative [masses.NAME]");
    model.mass_models = all->keys();
    // The tables of the other mass models are read only to refuse wrong keys in them.
    for (const std::string& name : model.mass_models) all->find_table(name);
  }
  model.mass_model = chosen.empty() ? model.mass_models.front() : chosen;
  if (all) draft.masses = all->at(model.mass_model, "an alternative of [masses]").table();
}

void read_platform(const ConfigValue& platform, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  model.origin = nodes(draft.origin);
  for (std::size_t row = 0; row < 3; ++row) model.rotation[row] = nodes(draft.turn[row]);
  if (const auto length = platform.find("characteristic_length")) {
    model.length = draft.scope.of_design(*length, "m", "characteristic_length").node();
    model.info.characteristic_length = length->is_text() ? length->text("a formula") : shortest(length->number("m"));
  }
  if (const auto list = platform.find("conditioning_over")) {
    constexpr const char* kExpected = "a list of coordinates: [\"x\", \"z\"]";
    for (const ConfigValue& each : list->elements(kExpected)) {
      const std::string& name = each.word(names_of(model.info.coordinates));
      const auto i = static_cast<std::size_t>(find_named(model.info.coordinates, name) - model.info.coordinates.data());
      if (std::ranges::count(model.conditioning_coordinates, i) > 0)
        throw each.refusal("'" + name + "' is in the list already");
      model.conditioning_coordinates.push_back(i);
    }
    if (model.conditioning_coordinates.empty()) throw list->error(kExpected);
  }
  if (const auto radius = platform.find("characteristic_radius"))
    model.radius = draft.scope.of_design(*radius, "m", "characteristic_radius").node();
  if (!mixes_units(model.info.coordinates) && model.info.characteristic_length.empty())
    model.info.characteristic_length = "1";  // all coordinates have the same unit, so that no scaling is needed
  if (const auto size = platform.find_table("size")) {
    const std::string unit = si_unit(size->at("unit", "the size's unit: \"m^3\""));
    const ConfigValue formula = size->at("formula", "a formula of parameters");
    model.size = {draft.scope.of_design(formula, unit, "size").node(), unit, text_of(*size, "meaning")};
  }
  read_platform_body(platform, draft);
}

/// Clears the characteristic length if the conditioning is undefined for any length: if lengths and angles are mixed
/// among the joints and no characteristic radius is given, or if there are fewer joints than coordinates, so that the
/// Jacobian does not have full column rank.
void remove_undefined_conditioning(generic::Model& model) {
  const bool needs_radius = mixes_units(model.info.joints) && !model.radius;
  if (needs_radius || model.info.joints.size() < model.info.coordinates.size())
    model.info.characteristic_length.clear();
}

/// Unit of all constraints on the pose; "" if their units differ, or if the unit of one of them is unknown, because it
/// is the argument of a square root or of a similar operation.
std::string common_margin_unit(const generic::Model& model) {
  std::optional<std::string> unit;
  for (const auto* const conditions : {&model.domains, &model.margins})
    for (const generic::Result& condition : *conditions) {
      if ((model.graph[condition.node].groups & ~Inputs::kDesign) == 0) continue;
      if (unit && *unit != condition.unit) return "";
      unit = condition.unit;
    }
  for (const generic::ReportLimit& limit : model.report_limits)
    if (unit && *unit != limit.quantity->unit) return "";
  return unit.value_or("");
}

}  // namespace

std::string text_of(const ConfigValue& table, const std::string& key) {
  const auto value = table.find(key);
  return value ? value->text("text") : "";
}

std::string si_unit(const ConfigValue& unit) {
  const std::string& text = unit.text("a unit");
  if (!is_si_unit(text)) throw unit.error("a product of SI units: \"m\", \"rad\", \"kg m^2\"");
  return text;
}

namespace {

/// Reads everything that the formulas of [[solve]] may use. @return the table [platform]
ConfigValue read_definitions(const ConfigValue& root, const std::vector<LimbParameter>& own,
                             const std::string& mass_model, const StudyAdditions& study, MechanismDraft& draft) {
  read_names(root, draft);
  choose_masses(root, mass_model, draft);
  read_parameters(root, own, study, draft);
  draft.model.inputs.limits = 0;
  read_limits(root, draft);
  if (study) read_quantity_limits(*study, draft);
  const ConfigValue platform = root.at("platform", "a table [platform] with its coordinates").table();
  read_coordinates(platform, draft);
  add_unknowns(draft);
  read_modes(root, draft);
  read_inputs(root, draft);
  read_frames(root, platform, draft);
  draft.scope.allow_motion(true);
  read_let(root, draft);
  draft.scope.allow_motion(false);
  return platform;
}

void read_draft(const std::string& text, const std::string& file_name, const std::vector<LimbParameter>& own,
                const std::string& mass_model, const StudyAdditions& study, MechanismDraft& draft) {
  const TomlValue document = parse_toml(text, file_name, "a mechanism in TOML");
  if (document.keys.empty())
    throw ConfigError({file_name, 0, ""}, "an empty file",
                      "a mechanism: [mechanism], [parameters], [platform], [[limb]]");
  const ConfigValue root = ConfigValue(document, file_name, "").described_by(mechanism_keys());
  SolvedSystems systems(root);
  if (!systems.empty()) {
    systems.use_inputs();
    read_definitions(root, own, mass_model, study, systems.draft());
    systems.read_equations();
    systems.use_solutions(draft);
  }
  const ConfigValue platform = read_definitions(root, own, mass_model, study, draft);
  resolve_frames(root, platform, draft);
  systems.add_margins(draft);
  read_platform(platform, draft);
  read_limbs(root, draft);
  read_frame_bodies(root, draft);
  read_bodies(root, read_links(root, draft), draft);
  if (!draft.model.bodies.empty()) draft.model.equations = generic::equations_of(draft.model);
  add_transmission(root, study.get(), draft);
  add_performance(root, study.get(), draft);
  add_constraint_quantity(root, study.get(), draft);
  add_forces(root, study.get(), draft);
  read_quantities(root, study.get(), draft);
  read_margins(root, draft);
  if (study) add_quantity_margins(*study, draft);
  refuse_idle_signs(root, draft);
  refuse_idle_parameters(draft);
  read_survey(root, draft);
  remove_undefined_conditioning(draft.model);
  draft.scope.add_domains();
  list_modes(draft);
  refuse_changing_planes(draft);
  add_clearance(draft);
  add_joints(root, draft);
  draft.model.margin_unit = common_margin_unit(draft.model);
}

std::shared_ptr<const Mechanism> build(const std::string& text, const std::string& file_name,
                                       const std::vector<LimbParameter>& own, const std::string& mass_model,
                                       const StudyAdditions& study) {
  generic::Model model = read_mechanism_model(text, file_name, own, mass_model, study);
  if (model.mass_models.size() > 1)
    model.with_masses = [=](const std::string& name) { return build(text, file_name, own, name, study); };
  return generic::make_mechanism(std::move(model));
}

}  // namespace

generic::Model read_mechanism_model(const std::string& text, const std::string& file_name,
                                    const std::vector<LimbParameter>& own, const std::string& mass_model,
                                    const StudyAdditions& study) {
  MechanismDraft draft;
  read_draft(text, file_name, own, mass_model, study, draft);
  bound_survey(draft);
  return std::move(draft.model);
}

std::vector<LimbParameter> limb_copies(const std::string& text, const std::string& file_name,
                                       const std::vector<std::string>& common, const std::vector<LimbParameter>& own) {
  MechanismDraft without;  // the mechanism without the new parameters, which provides the names of the limbs
  read_draft(text, file_name, own, "", nullptr, without);
  std::vector<LimbParameter> all = own;
  for (const std::string& parameter : common)
    for (const NamedLimb& limb : without.limbs)
      all.push_back({.limb = limb.name, .parameter = parameter, .may_be_idle = true});
  MechanismDraft draft;
  read_draft(text, file_name, all, "", nullptr, draft);
  std::vector<LimbParameter> copies = effective_parameters(draft);
  std::erase_if(copies, [&common](const LimbParameter& each) { return !contains(common, each.parameter); });
  return copies;
}

std::shared_ptr<const Mechanism> read_mechanism_toml(const std::string& text, const std::string& file_name,
                                                     const std::vector<LimbParameter>& own,
                                                     const StudyAdditions& study) {
  return build(text, file_name, own, "", study);
}

}  // namespace pkm
