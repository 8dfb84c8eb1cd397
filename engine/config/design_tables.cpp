// Readers of [mechanism], [variables] and [baseline]: the mechanism, the parameters that vary, and the design for
// comparison.

#include <algorithm>

#include "engine/config/assignments.hpp"
#include "engine/config/built_in_files.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/config/study_additions.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/tied_parameters.hpp"

namespace pkm {
namespace {

/// The names of the parameters in a table. Refuses unknown names and names that occur twice.
std::vector<std::string> parameters_in(const ConfigValue& table, bool of_tables, const std::vector<Parameter>& known) {
  std::vector<std::string> keys = table.dotted_keys(of_tables);
  const std::vector<std::string> names = names_of(known);
  for (auto key = keys.begin(); key != keys.end(); ++key) {
    const ConfigValue value = *table.find(*key);
    if (!contains(names, *key))
      throw value.error_of("an unknown parameter", "one of " + join(names), nearest_name(*key, names));
    if (std::find(keys.begin(), key, *key) != key) throw value.refusal("the parameter is there already");
  }
  return keys;
}

/// Collects the parameters of single limbs that the study or the command line names.
void find_limb_parameters(const ConfigValue& root, StudyDraft& draft) {
  std::vector<LimbParameter>& all = draft.limb_parameters;
  const auto add = [&all](const LimbParameter& own) {
    if (std::ranges::find(all, own.name(), &LimbParameter::name) == all.end()) all.push_back(own);
  };
  const auto add_those_in = [&add](const std::optional<ConfigValue>& table, bool of_tables) {
    if (!table || !table->is_table()) return;
    for (const std::string& name : table->dotted_keys(of_tables))
      if (const auto own = limb_parameter(name, table->find(name)->place())) add(*own);
  };
  add_those_in(root.find("mechanism")->find("parameters"), false);
  add_those_in(root.find("variables"), true);
  for (const StudyChanges& changes : draft.changes) std::ranges::for_each(limb_parameters(changes), add);
}

/// Sets the parameters of single limbs that have no value of their own to the values of the parameters that all limbs
/// share.
template <class Given>
void apply_common_parameters(const StudyDraft& draft, const Given& given, std::vector<double>& values) {
  const auto& known = draft.info().parameters;
  const auto number = [&known](const std::string& name) {
    return static_cast<std::size_t>(find_named(known, name) - known.data());
  };
  for (const LimbParameter& own : draft.limb_parameters)
    if (!given(own.name())) values[number(own.name())] = values[number(own.parameter)];
}

/// Overwrites the values of the parameters that `table` names.
void read_parameters(const ConfigValue& table, const std::vector<Parameter>& known, std::vector<double>& values) {
  for (const auto& key : parameters_in(table, false, known)) {
    const Parameter& p = *find_named(known, key);
    values[static_cast<std::size_t>(&p - known.data())] = table.find(key)->number(p.unit, p.lower, p.upper);
  }
}

Variable read_variable(const ConfigValue& value, const Parameter& parameter) {
  const ConfigValue table = value.table();
  const auto bound = [&](const char* key) {
    return table.at(key, range_text("a number", parameter.lower, parameter.upper, parameter.unit))
        .number(parameter.unit, parameter.lower, parameter.upper);
  };
  Variable variable{parameter.name, parameter.unit, bound("min"), bound("max"), 0};
  if (variable.lower >= variable.upper)
    throw table.find("max")->error("a number above min = " + with_unit(variable.lower, parameter.unit));
  if (const auto step = table.find("step")) {
    variable.step = step->number(parameter.unit);
    if (!(variable.step > 0 && variable.step <= variable.upper - variable.lower))
      throw step->error("a step > 0 and at most max - min = " +
                        with_unit(variable.upper - variable.lower, parameter.unit));
  }
  return variable;
}

/// The variable as recorded in the study file or, if it is not recorded, `of_text`, the variable given by the study's
/// text.
Variable recorded_variable(const StudyDraft& draft, const Variable& of_text, const Parameter& parameter) {
  for (const StudyChanges& changes : draft.changes)
    if (const Variable* const recorded = find_named(changes.recorded_variables, of_text.name)) {
      const auto [name, unit, lower, upper, step] = *recorded;
      if (!(lower >= parameter.lower && lower < upper && upper <= parameter.upper && step >= 0 &&
            step <= upper - lower))
        throw ConfigError(
            {draft.study.file_name, 0, "variables." + name},
            "the recorded bounds " + format_range(lower, upper, unit) + " with step " + with_unit(step, unit),
            range_text("bounds", parameter.lower, parameter.upper, unit));
      return *recorded;
    }
  return of_text;
}

/// Ties the copies of a common parameter that have values of their own in the mechanism file to the variable of the
/// common parameter, unless these copies vary or are fixed in the study.
void tie_copies(const ConfigValue& variables, const std::optional<ConfigValue>& fixed, const ConfigValue& tie,
                const Variable& variable, std::size_t common, StudyDraft& draft) {
  const auto& known = draft.info().parameters;
  if (limb_parameter(variable.name, tie.place()))
    throw tie.refusal(variable.name +
                      " is a single copy; the key belongs to the common parameter, or to a pattern such as "
                      "\"arm*.l_b\"");
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto own = limb_parameter(known[i].name, tie.place());
    if (!own || own->parameter != variable.name || variables.has(known[i].name) || (fixed && fixed->has(known[i].name)))
      continue;
    if (variable.lower < known[i].lower || variable.upper > known[i].upper)
      throw tie.refusal("the mechanism file restricts " + known[i].name + " to " +
                        format_range(known[i].lower, known[i].upper, known[i].unit) + "; expected bounds of " +
                        variable.name + " within this range");
    draft.parts.copies.push_back({i, common});
  }
  apply_ties(draft.parts, draft.parts.parameters);
}

void warn_of_lattice_end(const DesignSpace& space, std::vector<std::string>& warnings) {
  for (std::size_t i = 0; i < space.dimension(); ++i) {
    const Variable& v = space[i];
    const double last = space.nearest(i, v.upper);
    if (v.step > 0 && v.upper - last > 1e-9 * v.step)
      warnings.push_back("variable " + v.name + " never reaches its max " + with_unit(v.upper, v.unit) +
                         ": the largest value min + k step is " + with_unit(last, v.unit));
  }
}

/// The document of a study if it adds quantities, or limits of quantities, to its mechanism; otherwise null.
StudyAdditions additions_of(const ConfigValue& root, const StudyDraft& draft) {
  const auto changes_quantities = [](const ConfigValue& train) {
    return train.has("stiffness") || train.has("peak_force") || train.has("rotor_inertia") ||
           train.has("shaft_inertia") || train.has("motor");
  };
  if (!root.has("parameters") && !root.has("quantity") && !root.has("accuracy") && !limits_of_quantities(root) &&
      std::ranges::none_of(root.tables("drive_train"), changes_quantities))
    return nullptr;
  return study_additions(root.toml(), draft.study.file_name);
}

/// The mechanism that the key `type` or `file` of [mechanism] names.
std::shared_ptr<const Mechanism> find_mechanism(const ConfigValue& root, StudyDraft& draft) {
  std::vector<std::string> names;
  for (const auto& mechanism : draft.catalogues.mechanisms) names.push_back(mechanism.name());
  const std::string either = "type = one of " + join(names) + ", or file = the name of a mechanism's file";
  const ConfigValue table = root.at("mechanism", "a table [mechanism] with " + either).table();
  const auto type = table.find("type"), file = table.find("file");
  const StudyAdditions additions = additions_of(root, draft);
  if (type && file)
    throw file->refusal("the mechanism is also given by mechanism.type (" + type->line() +
                        "); it is either built in or described by a file");
  if (type) {
    const std::string& name = type->word(names);
    if (additions || !draft.copies.empty())
      return type->explained([&] { return built_in_mechanism(name, additions, draft.copies); });
    return std::ranges::find(draft.catalogues.mechanisms, name, &MechanismEntry::name)->get();
  }
  if (!file) throw table.error_of("neither type nor file", either);
  const SourceText& description = draft.study.description.emplace(draft.description(*file));
  find_limb_parameters(root, draft);
  std::ranges::copy(draft.copies, std::back_inserter(draft.limb_parameters));
  return read_mechanism_toml(description.text, description.file_name, draft.limb_parameters, additions);
}

}  // namespace

void read_mechanism(const ConfigValue& root, StudyDraft& draft) {
  draft.parts.mechanism = find_mechanism(root, draft);
  const ConfigValue table = *root.find_table("mechanism");
  if (const auto masses = table.find("masses")) {
    const Dynamics* const dynamics = draft.parts.mechanism->dynamics();
    if (!dynamics) throw masses->refusal("the mechanism " + draft.info().name + " has no masses");
    draft.parts.mechanism = dynamics->with_masses(masses->word(dynamics->mass_models()));
  }

  for (const auto& parameter : draft.info().parameters) draft.parts.parameters.push_back(parameter.nominal);
  const auto fixed = table.find_table("parameters");
  if (fixed) read_parameters(*fixed, draft.info().parameters, draft.parts.parameters);
  override_parameters(root, draft);
  const auto given = [&](const std::string& name) {
    const auto set = [&name](const StudyChanges& changes) {
      const auto is_it = [&name](const auto& recorded) { return recorded.first == name; };
      return contains(assigned_names(changes.set), name) || std::ranges::any_of(changes.recorded_parameters, is_it);
    };
    return (fixed && fixed->has(name)) || std::ranges::any_of(draft.changes, set);
  };
  apply_common_parameters(draft, given, draft.parts.parameters);
}

void read_variables(const ConfigValue& root, StudyDraft& draft) {
  const auto& known = draft.info().parameters;
  const ConfigValue mechanism = *root.find("mechanism");
  std::vector<Variable> variables;
  std::vector<double> nominal = draft.parts.parameters;
  if (const auto table = root.find_table("variables")) {
    const auto fixed = mechanism.find("parameters");
    for (const auto& key : parameters_in(*table, true, known)) {
      const ConfigValue entry = *table->find(key);
      if (fixed && fixed->has(key))
        throw entry.refusal("the parameter is also fixed in mechanism.parameters (" + fixed->find(key)->line() +
                            "); it can either vary or be fixed");
      const auto i = static_cast<std::size_t>(find_named(known, key) - known.data());
      variables.push_back(recorded_variable(draft, read_variable(entry, known[i]), known[i]));
      draft.parts.varies.push_back(i);
      if (const auto tie = entry.find("tie"); tie && tie->flag())
        tie_copies(*table, fixed, *tie, variables.back(), i, draft);
      nominal[i] = std::clamp(nominal[i], variables.back().lower, variables.back().upper);
    }
  }
  draft.parts.space = DesignSpace(std::move(variables));
  for (const Catalogue& catalogue : draft.from_catalogues) {
    const auto parameter = static_cast<std::size_t>(find_named(known, catalogue.variable) - known.data());
    draft.parts.choices.push_back({catalogue.variable, parameter, catalogue.names});
  }
  warn_of_lattice_end(draft.parts.space, draft.study.warnings);
  if (const Unsupported reason = draft.parts.mechanism->refuse(nominal)) throw mechanism.refusal(*reason);
}

void read_baseline(const ConfigValue& root, StudyDraft& draft) {
  const auto table = root.find_table("baseline");
  if (!table) return;
  std::vector<double> values = draft.parts.parameters;
  read_parameters(*table, draft.info().parameters, values);
  apply_common_parameters(
      draft, [&](const std::string& name) { return table->has(name) || !root.find("variables")->has(name); }, values);
  for (const auto& [own, common] : draft.parts.copies)
    if (!table->has(draft.info().parameters[own].name)) values[own] = values[common];
  if (const Unsupported reason = draft.parts.mechanism->refuse(values)) throw table->refusal(*reason);
  draft.study.baseline = std::move(values);
}

}  // namespace pkm
