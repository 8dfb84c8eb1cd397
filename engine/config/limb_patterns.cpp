#include "engine/config/limb_patterns.hpp"

#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*') return !name.empty() && pattern[0] == name[0] && matches(pattern.substr(1), name.substr(1));
  return matches(pattern.substr(1), name) || (!name.empty() && matches(pattern, name.substr(1)));
}

/// Names of the copies of a parameter in single limbs that a pattern such as "arm*.l_b" stands for, except the copies
/// in `alone`, which are variables themselves.
/// @param copies  all copies of the parameter
std::vector<std::string> copies_of(const ConfigValue& entry, const LimbParameter& pattern,
                                   const std::vector<LimbParameter>& copies, const std::vector<std::string>& alone) {
  std::vector<std::string> found, all, limbs;
  for (const LimbParameter& copy : copies) {
    all.push_back(copy.name());
    limbs.push_back(copy.limb);
    if (matches(pattern.limb, copy.limb) && !contains(alone, copy.name())) found.push_back(copy.name());
  }
  if (all.empty())
    throw entry.refusal("no joint or limit of a single limb depends on " + pattern.parameter + "; write " +
                        pattern.parameter + " instead of " + pattern.name());
  std::string stem = pattern.limb;
  std::erase(stem, '*');
  if (found.empty())
    throw entry.error_of("a pattern that no limb with " + pattern.parameter + " matches",
                         "one that matches some of " + join(all), nearest_name(stem, limbs));
  return found;
}

}  // namespace

TomlValue with_limb_patterns(const TomlValue& study, const std::string& file_name,
                             const std::function<SourceText(const ConfigValue& file)>& description) {
  const TomlValue* const variables = study.find("variables");
  if (!variables || variables->kind != TomlValue::Kind::table || std::ranges::none_of(variables->keys, is_pattern))
    return study;
  const ConfigValue root = ConfigValue(study, file_name, "").described_by(study_keys()),
                    table = *root.find("variables");
  const auto mechanism = root.find("mechanism");
  const auto file = mechanism && mechanism->is_table() ? mechanism->find("file") : std::nullopt;
  const std::vector<std::string> keys = table.dotted_keys(true);
  std::vector<std::string> alone;
  std::ranges::copy_if(keys, std::back_inserter(alone), [](const std::string& key) { return !is_pattern(key); });
  std::optional<SourceText> text;

  TomlValue expanded = filtered(*variables, [](const std::string& key) { return !is_pattern(key); });
  for (const std::string& key : keys) {
    if (!is_pattern(key)) continue;
    const ConfigValue entry = *table.find(key);
    const auto pattern = limb_parameter(key, entry.place());
    if (!pattern) throw entry.refusal("a pattern of limbs is followed by a dot and a parameter, as in \"arm*.l_b\"");
    if (!entry.is_table()) throw entry.error("a table with min and max");
    if (entry.has("from")) throw entry.refusal("a choice from a catalogue belongs to one variable, not to a pattern");
    if (!file)
      throw entry.refusal("parameters of single limbs need a mechanism file; 'pkmopt new mechanism' writes one");
    if (!text) text = description(*file);
    if (is_pattern(pattern->parameter))
      throw entry.refusal("only the limb of a parameter can be a pattern, as in \"arm*.l_b\"");
    std::vector<std::string> known =
        names_of(read_mechanism_model(text->text, text->file_name, {}, "").info.parameters);
    std::erase_if(known, [](const std::string& name) { return name.find('.') != std::string::npos; });
    if (!contains(known, pattern->parameter))
      throw entry.error_of("an unknown parameter", "one of " + join(known), nearest_name(pattern->parameter, known));
    const auto copies = limb_copies(text->text, text->file_name, {pattern->parameter}, {});
    const std::vector<std::string> names = copies_of(entry, *pattern, copies, alone);
    const auto tie = entry.find("tie");
    if (!tie || !tie->flag()) {
      for (const std::string& name : names) {
        if (expanded.find(name)) throw entry.refusal(name + " matches two patterns; expected one");
        set_key(expanded, name, filtered(entry.toml(), [](const std::string& option) { return option != "tie"; }));
      }
      continue;
    }
    for (const LimbParameter& copy : copies)
      if (!contains(names, copy.name()) && !contains(alone, copy.name()))
        throw tie->refusal("only all copies of " + pattern->parameter + " can vary together, but the pattern omits " +
                           copy.name() + "; add a variable " + copy.name() + ", or change the pattern");
    if (contains(alone, pattern->parameter) || expanded.find(pattern->parameter))
      throw tie->refusal(pattern->parameter + " is a variable already, which all of its copies share");
    set_key(expanded, pattern->parameter, entry.toml());
  }
  TomlValue result = study;
  set_key(result, "variables", std::move(expanded));
  return result;
}

}  // namespace pkm
