// Reader of [[stage]]: optimisers with their options. Checks that they support the problem.

#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

/// The reason why an optimiser does not support the problem; empty if it supports the problem.
Unsupported refusal_of(const OptimiserEntry& entry, const Options& options, const Problem& problem,
                       const std::vector<Choice>& choices) {
  const auto& objectives = problem.objectives();
  const Capabilities can = entry.capabilities(options);
  const std::string who = "the optimiser " + entry.name + " " +
                          (options.has("algorithm") ? "with the algorithm " + options.word("algorithm") + " " : "");
  if (problem.space().dimension() == 0) return who + "needs variables, but the study's [variables] is empty";
  if (can.min_objectives > 0 && objectives.empty())
    return who + "needs an objective, but the study has no [[objective]]";
  if (objectives.size() < can.min_objectives)
    return who + "needs " + std::to_string(can.min_objectives) + " objectives, but the study has one (" +
           objectives.front().name + ")";
  if (objectives.size() > can.max_objectives)
    return who + "handles " + std::to_string(can.max_objectives) + " objective" + (can.max_objectives == 1 ? "" : "s") +
           ", but the study has " + std::to_string(objectives.size()) + " (" + join(names_of(objectives)) + ")" +
           (*can.too_many_objectives_hint ? std::string("; ") + can.too_many_objectives_hint : "");
  if (!can.constraints && !problem.margins().empty())
    return who + "handles no constraints, but the study has " + join(names_of(problem.margins()));
  if (!can.discrete && !choices.empty()) {
    const Choice& choice = choices.front();
    return who + "handles continuous variables only, but the variable " + choice.variable +
           " is a choice from a catalogue; use a genetic algorithm, or remove the variable and write the values of one "
           "row, for example of " +
           choice.rows.front();
  }
  for (const auto& variable : problem.space().variables())
    if (!can.discrete && variable.step > 0)
      return who + "handles continuous variables only, but the variable " + variable.name + " has a step";
  if (can.needs_gradient)
    if (const Unsupported reason = problem.why_no_derivatives()) return who + "needs derivatives, but " + *reason;
  return {};
}

/// The default value of an option, which may depend on the values of other options.
std::optional<OptionValue> default_of(const std::string& name, const OptimiserEntry& entry, const Options& options,
                                      const DesignSpace& space) {
  Options others;
  for (const auto& [other, value] : options.values())
    if (other != name) others.set(other, value);
  if (entry.resolve) entry.resolve(others, space);
  const auto found = others.values().find(name);
  return found == others.values().end() ? std::nullopt : std::optional(found->second);
}

/// Refuses initial designs outside the bounds of the variables.
void check_designs(const ConfigValue& table, const Stage& stage, const DesignSpace& space) {
  for (const OptionSpec& spec : stage.specs) {
    if (spec.field_names != FieldNames::variables || !table.has(spec.name)) continue;
    for (const NamedNumbers& design : stage.options.list(spec.name))
      for (const Variable& v : space.variables())
        if (const auto given = design.find(v.name);
            given != design.end() && !(given->second >= v.lower && given->second <= v.upper))
          throw table.find(spec.name)->refusal(v.name + " = " + with_unit(given->second, v.unit) +
                                               " lies outside the variable's bounds " + with_unit(v.lower, v.unit) +
                                               " to " + with_unit(v.upper, v.unit));
  }
}

/// Reads one optimiser with its options.
/// @param each      a table [[stage]]
/// @param is_first  true if it is the first stage
Stage read_stage(const ConfigValue& each, const std::vector<OptimiserEntry>& optimisers, const Problem& problem,
                 bool is_first, const std::vector<Choice>& choices = {}) {
  const OptimiserEntry& entry = *find_named(optimisers, each.choice("optimiser", names_of(optimisers)));
  const ConfigValue table = each.table(entry.options);
  // Use the unit of the objective; several objectives have no common unit.
  const auto& objectives = problem.objectives();
  const DesignSpace& space = problem.space();
  auto specs = with_entry_unit(entry.options, objectives.size() == 1 ? objectives.front().unit : "1");
  for (auto& spec : specs) {
    if (spec.field_names == FieldNames::variables)
      for (const Variable& v : space.variables()) spec.fields.emplace_back(v.name, v.unit);
    if (spec.field_names != FieldNames::objectives) continue;
    for (const ObjectiveInfo& o : objectives) spec.fields.emplace_back(o.name, o.unit);
    if (spec.kind == OptionKind::word) spec.choices = names_of(objectives);
  }
  Stage stage{
      std::make_shared<const OptimiserEntry>(entry), read_options(table, specs), nullptr, table.place().line, {}};
  if (const Unsupported reason = refusal_of(entry, stage.options, problem, choices))
    throw table.find("optimiser")->refusal(*reason);
  if (entry.capabilities(stage.options).needs_front && is_first)
    throw table.find("start")->refusal(
        "start = \"pareto\" needs a [[stage]] before it that finds a front, such as nsga2");
  if (entry.resolve) entry.resolve(stage.options, space);
  for (auto& spec : specs)
    if (!spec.initial) spec.initial = default_of(spec.name, entry, stage.options, space);
  stage.specs = std::move(specs);
  check_designs(table, stage, space);
  stage.optimiser = table.explained([&] { return entry.make(stage.options, space); });
  return stage;
}

std::vector<ConfigValue> stage_tables(const ConfigValue& root) {
  const auto list = root.find("stage");
  if (!list) return {};
  const std::string expected = "a list of tables, each written [[stage]]";
  std::vector<ConfigValue> tables = list->elements(expected);
  for (ConfigValue& table : tables) table = table.expect_table(expected);
  return tables;
}

}  // namespace

void require_stages(const Study& study, const Catalogues& catalogues) {
  if (study.stages.empty())
    throw ConfigError({study.file_name, 0, "stage"}, "nothing",
                      "at least one [[stage]] with optimiser = one of " + join(names_of(catalogues.optimisers)) +
                          "; without stages a study can be evaluated, but not run");
}

void read_stages(const ConfigValue& root, StudyDraft& draft) {
  for (const ConfigValue& table : stage_tables(root))
    draft.study.stages.push_back(read_stage(table, draft.catalogues.optimisers, *draft.study.problem,
                                            draft.study.stages.empty(), draft.parts.choices));
}

Stage read_stage_toml(const std::string& lines, const std::string& file_name,
                      const std::vector<OptimiserEntry>& optimisers, const Problem& problem) {
  const TomlValue document = parse_toml("[[stage]]\n" + lines + '\n', file_name);
  const auto tables = stage_tables(ConfigValue(document, file_name, "").described_by(study_keys()));
  if (tables.size() != 1 || document.keys.size() != 1)
    throw ConfigError({file_name, 0, ""}, "tables", "keys and values of one stage");
  return read_stage(tables.front(), optimisers, problem, true);
}

}  // namespace pkm
