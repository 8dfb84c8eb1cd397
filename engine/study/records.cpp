#include "engine/study/records.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/storage/file_seal.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/run_outcome.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kImplyMotions = 6;  // the first version whose studies have constraints because of motions

std::string text_digest(const std::string& toml, const std::optional<SourceText>& description) {
  return digest_of(toml + '\0' + (description ? description->text : ""));
}

/// "name [unit]", which has to be the same for a value to have a meaning.
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

/// The first of `recorded` that the text does not give.
template <class List>
Refusal not_of_text(const std::string& kind, const List& of_text, const List& recorded) {
  const std::vector<std::string> known = labels(of_text);
  for (const std::string& each : labels(recorded))
    if (!contains(known, each)) return "no " + kind + " " + each + ", and one";
  return {};
}

/// Why a file's records cannot be those of the study that its text describes.
Refusal text_against_record(const Study& study, const StudyContents& contents) {
  const ProblemRecord told = problem_of(study);
  const ProblemRecord& recorded = contents.problem;
  if (study.description.has_value() != contents.description.has_value())
    return std::string(study.description ? "a mechanism's file, and none" : "no file of a mechanism, and one");
  if (told.mechanism != recorded.mechanism) return told.mechanism + " as mechanism, and " + recorded.mechanism;
  const std::string variables = join(labels(told.variables));
  if (const std::string other = join(labels(recorded.variables)); variables != other)
    return "the variables " + variables + ", and " + other;
  const std::string objectives = join(labels(told.objectives));
  if (const std::string other = join(labels(recorded.objectives)); objectives != other)
    return "the objectives " + objectives + ", and " + other;
  if (Refusal missing = not_of_text("parameter", told.parameters, recorded.parameters)) return missing;
  if (Refusal missing = not_of_text("constraint", told.margins, recorded.margins)) return missing;
  if (Refusal missing = not_of_text("report", told.reports, recorded.reports)) return missing;
  if (contents.stages.size() > study.stages.size())
    return std::to_string(study.stages.size()) + " stages, and " + std::to_string(contents.stages.size());
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    if (study.stages[s].entry->name != contents.stages[s].optimiser)
      return "stage " + std::to_string(s + 1) + " by " + study.stages[s].entry->name + ", and by " +
             contents.stages[s].optimiser;
  for (const Extension& extension : contents.extensions)
    if (extension.stage < 0 || extension.stage >= static_cast<std::int64_t>(study.stages.size()))
      return std::to_string(study.stages.size()) + " stages, and a new limit of stage " +
             std::to_string(extension.stage + 1);
  return {};
}

/// Where a file's records differ from what its text gives, although both are of one study: a sentence for each value.
std::vector<std::string> differences(const Study& study, const StudyContents& contents) {
  const ProblemRecord told = problem_of(study);
  const ProblemRecord& recorded = contents.problem;
  std::vector<std::string> all;
  const auto compare = [&all](const std::string& key, double record, double text, const std::string& unit) {
    if (record != text)
      all.push_back("it records " + key + " = " + with_unit(record, unit) + ", but its text gives " +
                    with_unit(text, unit) + " in this program");
  };
  for (const ParameterRecord& p : recorded.parameters)
    compare(p.name, p.value, find_named(told.parameters, p.name)->value, p.unit);
  for (const Variable& v : recorded.variables) {
    const Variable& of_text = *find_named(told.variables, v.name);
    compare("variables." + v.name + ".min", v.lower, of_text.lower, v.unit);
    compare("variables." + v.name + ".max", v.upper, of_text.upper, v.unit);
    compare("variables." + v.name + ".step", v.step, of_text.step, v.unit);
  }
  const auto added = [&all](const std::string& kind, const auto& of_text, const auto& record) {
    for (const auto& each : of_text)
      if (!find_named(record, each.name))
        all.push_back("it has no " + kind + " " + each.name + ", which this program adds");
  };
  added("constraint", told.margins, recorded.margins);
  added("report", told.reports, recorded.reports);
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    for (const std::string& line : contents.stages[s].options) {
      const std::string name = line.substr(0, line.find(" = "));
      const auto extended = [&](const Extension& e) {
        return e.stage == static_cast<std::int64_t>(s) && e.limit == name;
      };
      const auto& values = study.stages[s].options.values();
      const auto of_text = values.find(name);
      if (of_text == values.end() || std::ranges::any_of(contents.extensions, extended)) continue;
      if (const std::string text = to_text(of_text->second); line != name + " = " + text)
        all.push_back("it records " + line + " of stage " + std::to_string(s + 1) + ", but its text gives " + text +
                      " in this program");
    }
  return all;
}

}  // namespace

ProblemRecord problem_of(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  ProblemRecord p;
  p.mechanism = info.name;
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    p.parameters.push_back({info.parameters[i].name, info.parameters[i].unit, parts.parameters[i], -1});
  for (std::size_t v = 0; v < parts.varies.size(); ++v)
    p.parameters[parts.varies[v]].variable = static_cast<std::int64_t>(v);
  p.variables = parts.space.variables();
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
  c.problem = problem_of(study);
  return c;
}

Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes) {
  const std::string disagree = "the study's text and what is recorded of it disagree: ";
  if (!contents.text_digest.empty() && contents.text_digest != text_digest(contents.toml, contents.description))
    throw StorageError(disagree + "its text, or its mechanism's, was changed after the study was begun");
  const auto implied = contents.algorithms >= kImplyMotions ? ImpliedConstraints::added : ImpliedConstraints::left_out;
  const auto read = [&](const StudyChanges& with) {
    return read_study_toml(contents.toml, contents.toml_file, catalogues, contents.description, with, implied);
  };
  Study study = read(changes);
  if (const Refusal difference = text_against_record(study, contents)) throw StorageError(disagree + *difference);
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
    throw StorageError(path + " cannot be continued: " + reason.what());
  }
}

std::vector<std::string> option_lines(const Options& options) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : options.values()) lines.push_back(name + " = " + to_text(value));
  return lines;
}

}  // namespace pkm
