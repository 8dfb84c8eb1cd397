// Reader and writer of [[override]]: changes of a study by the command line.

#include "engine/config/study_changes.hpp"

#include <array>
#include <sstream>

#include "engine/config/assignments.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

struct Change {
  const char* key;
  std::vector<std::string> StudyChanges::*lists;
};
constexpr std::array<Change, 5> kChanges = {{{"set", &StudyChanges::set},
                                             {"limit", &StudyChanges::limit},
                                             {"cells", &StudyChanges::cells},
                                             {"start_from", &StudyChanges::start_from},
                                             {"start", &StudyChanges::start}}};
/// A TOML string. Control characters, which are not allowed in it, become visible.
std::string toml_text(const std::string& word) {
  std::string text = "\"";
  for (const char c : printable(word)) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

constexpr const char* kHeading = "\n# from the command line\n[[override]]\n";

}  // namespace

std::vector<std::string> StudyChanges::arguments() const {
  std::vector<std::string> words;
  for (const auto& [option, lists] :
       {std::pair("--set", &set), {"--limit", &limit}, {"--cells", &cells}, {"--start-from", &start_from}})
    for (const std::string& list : *lists) words.insert(words.end(), {option, list});
  return words;
}

std::string with_changes(const std::string& text, const StudyChanges& changes) {
  std::string all = text + kHeading;
  for (const auto& [key, lists] : kChanges)
    if (const auto& words = changes.*lists; !words.empty())
      all += std::string(key) + " = [" + join_texts(words, toml_text) + "]\n";
  return all;
}

std::string with_catalogue(const std::string& text, const SourceText& file) {
  std::string all = text + kHeading + "catalogue = " + toml_text(file.file_name) + "\ntext = [";
  std::istringstream lines(file.text);
  for (std::string line; std::getline(lines, line);) all += toml_text(line) + ",\n  ";
  return all + "]\n";
}

std::optional<SourceText> recorded_catalogue(const TomlValue& study, const std::string& file_name) {
  const TomlValue* const overrides = study.find("override");
  if (!overrides) return {};
  for (const TomlValue& table : overrides->items) {
    const TomlValue *const name = table.find("catalogue"), *const lines = table.find("text");
    if (!name || name->text != file_name || !lines) continue;
    SourceText file{"", file_name};
    for (const TomlValue& line : lines->items) file.text += line.text + '\n';
    return file;
  }
  return {};
}

std::string without_changes(const std::string& text) { return text.substr(0, text.find(kHeading)); }

std::vector<LimbParameter> limb_parameters(const StudyChanges& changes) {
  std::vector<LimbParameter> all;
  const auto add = [&all](const std::string& name) {
    const auto own = limb_parameter(name, {"", 0, "--set"});
    if (own && std::ranges::find(all, name, &LimbParameter::name) == all.end()) all.push_back(*own);
  };
  for (const std::string& name : assigned_names(changes.set)) add(name);
  std::ranges::for_each(changes.limb_parameters, add);
  return all;
}

void read_overrides(const ConfigValue& root, StudyDraft& draft) {
  for (const ConfigValue& table : root.tables("override")) {
    StudyChanges& changes = draft.changes.emplace_back();
    for (const auto& [key, lists] : kChanges)
      if (const auto words = table.find(key))
        for (const ConfigValue& each : words->elements("a list of texts, such as [\"L0=2\"]"))
          (changes.*lists).push_back(each.text("text such as \"L0=2\""));
  }
}

void override_parameters(const ConfigValue& root, StudyDraft& draft) {
  const auto variables = root.find("variables");
  for (const StudyChanges& changes : draft.changes) {
    const auto given = parse_assignments(changes.set, "--set", assignable_parameters(draft.info()));
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (!given[i]) continue;
      const std::string& name = draft.info().parameters[i].name;
      if (variables && variables->find(name))
        throw ConfigError({"", 0, "--set"}, name + ", which varies",
                          "a parameter that is not among the [variables] of " + draft.study.file_name);
      draft.parts.parameters[i] = *given[i];
    }
    for (const auto& [name, value] : changes.recorded_parameters) {
      const Parameter& p = *find_named(draft.info().parameters, name);
      if (!(value >= p.lower && value <= p.upper))
        throw ConfigError({draft.study.file_name, 0, name}, "the recorded value " + with_unit(value, p.unit),
                          range_text("a number", p.lower, p.upper, p.unit));
      draft.parts.parameters[static_cast<std::size_t>(&p - draft.info().parameters.data())] = value;
    }
  }
}

void override_limits(StudyDraft& draft) {
  LimitSpec& limits = draft.parts.plan.limits;
  for (const StudyChanges& changes : draft.changes) {
    const auto given = parse_assignments(changes.limit, "--limit", assignable_limits(draft.info()));
    for (std::size_t i = 0; i < given.size(); ++i)
      if (given[i]) {
        limits.given[i] = given[i];
        limits.derived[i] = false;
        draft.study.limit_origins[i] = "--limit";
      }
  }
}

void override_starts(StudyDraft& draft) {
  std::vector<Assignable> variables;
  for (const Variable& v : draft.parts.space.variables()) variables.push_back({v.name, v.unit, v.lower, v.upper});
  std::vector<StartDesign>& starts = draft.study.starts;
  for (const StudyChanges& changes : draft.changes) {
    if (changes.start.empty()) continue;
    starts.clear();
    for (const std::string& design : changes.start)
      starts.push_back({parse_all_assignments({design}, "start of [[override]]", variables),
                        "design " + std::to_string(starts.size() + 1) + " of " + join(changes.start_from)});
  }
}

}  // namespace pkm
