#include "engine/runner/records.hpp"

#include <algorithm>

#include "engine/config/upgrade.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/runner/machine.hpp"
#include "engine/runner/python_functions.hpp"
#include "engine/runner/run_outcome.hpp"
#include "engine/storage/file_header.hpp"

namespace pkm {
namespace {

// The first algorithm version in which a [[motion]] implies a constraint.
constexpr std::int64_t kFirstWithImpliedConstraints = 6;

/// Hash of the study's text, followed by a NUL character and the text of the mechanism file.
std::string text_digest(const std::string& toml, const std::optional<SourceText>& description) {
  return xxh64_hex(toml + '\0' + (description ? description->text : ""));
}

/// Text by which a recorded element of the problem is compared with that of the study's text: "name [unit]", and other
/// properties without which the recorded values would be meaningless.
template <class Info>
std::string label(const Info& info) {
  return info.name + " [" + info.unit + "]";
}
std::string label(const ParameterRecord& p) {
  return p.name + " [" + p.unit + "]" + (p.variable < 0 ? "" : ", variable " + std::to_string(p.variable + 1));
}
std::string label(const ObjectiveInfo& o) {
  return (o.direction == Direction::maximise ? "maximise " : "minimise ") + o.name + " [" + o.unit + "]";
}
template <class List>
std::vector<std::string> labels(const List& list) {
  std::vector<std::string> all;
  for (const auto& element : list) all.push_back(label(element));
  return all;
}

/// @return a sentence that names the first element of `recorded` that the study's text does not define; empty if it
/// defines all of them
template <class List>
Unsupported undefined_in_text(const std::string& kind, const List& of_text, const List& recorded) {
  const std::vector<std::string> known = labels(of_text);
  for (const std::string& each : labels(recorded))
    if (!contains(known, each)) return "the record has " + kind + " " + each + ", which the text does not define";
  return {};
}

std::string conflict(const std::string& in_text, const std::string& recorded) {
  return "the text has " + in_text + ", the record has " + recorded;
}

/// @return a sentence that states why the recorded problem differs from the one that the study's text describes; empty
/// if they are the same
Unsupported conflict_with_text(const Study& study, const StudyContents& contents) {
  const ProblemRecord of_text = problem_record(study);
  const ProblemRecord& recorded = contents.problem;
  if (study.description.has_value() != contents.description.has_value())
    return study.description ? conflict("a mechanism file", "none") : conflict("no mechanism file", "one");
  if (of_text.mechanism != recorded.mechanism) return conflict("mechanism " + of_text.mechanism, recorded.mechanism);
  const std::string variables = join(labels(of_text.variables));
  if (const std::string other = join(labels(recorded.variables)); variables != other)
    return conflict("variables " + variables, other);
  const std::string objectives = join(labels(of_text.objectives));
  if (const std::string other = join(labels(recorded.objectives)); objectives != other)
    return conflict("objectives " + objectives, other);
  if (Unsupported missing = undefined_in_text("parameter", of_text.parameters, recorded.parameters)) return missing;
  if (Unsupported missing = undefined_in_text("constraint", of_text.margins, recorded.margins)) return missing;
  if (Unsupported missing = undefined_in_text("output", of_text.reports, recorded.reports)) return missing;
  const std::string stages = std::to_string(study.stages.size()) + " stages";
  if (contents.stages.size() > study.stages.size()) return conflict(stages, std::to_string(contents.stages.size()));
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    if (study.stages[s].entry->name != contents.stages[s].optimiser)
      return conflict("optimiser " + study.stages[s].entry->name + " in stage " + std::to_string(s + 1),
                      contents.stages[s].optimiser);
  for (const Extension& extension : contents.extensions)
    if (extension.stage < 0 || extension.stage >= static_cast<std::int64_t>(study.stages.size()))
      return conflict(stages, "a new limit of stage " + std::to_string(extension.stage + 1));
  return {};
}

/// Compares recorded values with those that follow from the study's text. The problem must otherwise be the same.
/// @return one sentence for each difference
std::vector<std::string> differences(const Study& study, const StudyContents& contents) {
  const ProblemRecord of_text = problem_record(study);
  const ProblemRecord& recorded = contents.problem;
  std::vector<std::string> all;
  const auto compare = [&all](const std::string& key, double record, double text, const std::string& unit) {
    if (record != text)
      all.push_back("it records " + key + " = " + with_unit(record, unit) + ", but its text gives " +
                    with_unit(text, unit) + " in this program");
  };
  for (const ParameterRecord& p : recorded.parameters)
    compare(p.name, p.value, find_named(of_text.parameters, p.name)->value, p.unit);
  for (const Variable& v : recorded.variables) {
    const Variable& text = *find_named(of_text.variables, v.name);
    compare("variables." + v.name + ".min", v.lower, text.lower, v.unit);
    compare("variables." + v.name + ".max", v.upper, text.upper, v.unit);
    compare("variables." + v.name + ".step", v.step, text.step, v.unit);
  }
  const auto added = [&all](const std::string& kind, const auto& text, const auto& record) {
    for (const auto& each : text)
      if (!find_named(record, each.name))
        all.push_back("it has no " + kind + " " + each.name + ", which this program adds");
  };
  added("constraint", of_text.margins, recorded.margins);
  added("output", of_text.reports, recorded.reports);
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    for (const std::string& line : contents.stages[s].options) {
      const std::string name = line.substr(0, line.find(" = "));
      const auto extended = [&](const Extension& e) {
        return e.stage == static_cast<std::int64_t>(s) && e.limit == name;
      };
      const auto& values = study.stages[s].options.values();
      const auto option = values.find(name);
      if (option == values.end() || std::ranges::any_of(contents.extensions, extended)) continue;
      if (const std::string text = to_text(option->second); line != name + " = " + text)
        all.push_back("it records " + line + " of stage " + std::to_string(s + 1) + ", but its text gives " + text +
                      " in this program");
    }
  return all;
}

}  // namespace

ProblemRecord problem_record(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  ProblemRecord p;
  p.mechanism = info.name;
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    p.parameters.push_back({info.parameters[i].name, info.parameters[i].unit, parts.parameters[i], -1});
  for (std::size_t v = 0; v < parts.varies.size(); ++v)
    p.parameters[parts.varies[v]].variable = static_cast<std::int64_t>(v);
  p.variables = parts.space.variables();
  for (const Choice& choice : parts.choices) {
    if (!p.choices) p.choices.emplace();
    const std::int64_t variable = p.parameters[choice.parameter].variable;
    for (const std::string& row : choice.rows) p.choices->push_back({variable, row});
  }
  p.objectives = study.problem->objectives();
  p.margins = study.problem->margins();
  p.reports = study.problem->reports();
  return p;
}

StudyContents new_contents(const Study& study) {
  StudyContents c;
  c.name = study.name;
  c.toml = study.text;
  c.toml_file = study.file_name;
  c.description = study.description;
  c.text_digest = text_digest(study.text, study.description);
  c.seed = study.seed;
  c.algorithms = kAlgorithms;
  c.machine = describe_machine();
  c.created = c.updated = utc_now();
  c.problem = problem_record(study);
  if (std::vector<FunctionRecord> functions = function_records(study); !functions.empty())
    c.functions = std::move(functions);
  return c;
}

Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes) {
  const std::string inconsistent = "the text of the study does not match the recorded problem: ";
  if (!contents.text_digest.empty() && contents.text_digest != text_digest(contents.toml, contents.description))
    throw StorageError(inconsistent + "the text, or the mechanism file, was changed after the study was started");
  const auto implied =
      contents.algorithms >= kFirstWithImpliedConstraints ? ImpliedConstraints::added : ImpliedConstraints::left_out;
  std::optional<SourceText> description = contents.description;
  if (description) description->text = upgraded(description->text, TextKind::mechanism).text;
  const std::string text = upgraded(contents.toml, TextKind::study).text;
  const auto read = [&](const StudyChanges& with) {
    return read_study_toml(text, contents.toml_file, catalogues, description, with, implied);
  };
  Study study = read(changes);
  if (const Unsupported difference = conflict_with_text(study, contents))
    throw StorageError(inconsistent + *difference);
  if (std::vector<std::string> found = differences(study, contents); !found.empty()) {
    StudyChanges recorded = changes;
    for (const ParameterRecord& p : contents.problem.parameters)
      recorded.recorded_parameters.push_back({p.name, p.value});
    recorded.recorded_variables = contents.problem.variables;
    study = read(recorded);
    study.differences = std::move(found);
  }
  study.seed = contents.seed;
  return study;
}

Study study_to_continue(const StudyContents& contents, const std::string& path, const Catalogues& catalogues) {
  try {
    Study study = study_of(contents, catalogues);
    if (!study.differences.empty()) throw StorageError(join(study.differences, "; "));
    return study;
  } catch (const StorageError& reason) {
    throw StorageError(path + ": cannot be continued: " + reason.what());
  }
}

std::vector<std::string> option_lines(const Options& options) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : options.values()) lines.push_back(name + " = " + to_text(value));
  return lines;
}

}  // namespace pkm
