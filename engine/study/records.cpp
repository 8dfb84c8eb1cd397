#include "engine/study/records.hpp"

#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/run_outcome.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kImplyMotions = 6;  // the first version whose studies have constraints because of motions

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
  p.objectives = study.problem->objectives();
  p.margins = study.problem->margins();
  p.reports = study.problem->reports();
  return p;
}

/// Why a file's records cannot be those of the study that its text describes.
Refusal text_against_record(const Study& study, const StudyContents& contents) {
  const ProblemRecord told = problem_record(study);
  const ProblemRecord& recorded = contents.problem;
  if (study.description.has_value() != contents.description.has_value())
    return std::string(study.description ? "a mechanism's file, and none" : "no file of a mechanism, and one");
  if (told.mechanism != recorded.mechanism) return told.mechanism + " as mechanism, and " + recorded.mechanism;
  const std::string variables = join(names_of(told.variables));
  if (const std::string other = join(names_of(recorded.variables)); variables != other)
    return "the variables " + variables + ", and " + other;
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

}  // namespace

StudyContents new_contents(const Study& study) {
  StudyContents c;
  c.name = study.name;
  c.toml = study.text;
  c.toml_file = study.file_name;
  c.description = study.description;
  c.seed = study.seed;
  c.algorithms = kAlgorithms;
  c.machine = describe_machine();
  c.created = c.updated = utc_now();
  c.problem = problem_record(study);
  return c;
}

Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes) {
  const auto implied = contents.algorithms >= kImplyMotions ? ImpliedConstraints::added : ImpliedConstraints::left_out;
  Study study = read_study_toml(contents.toml, contents.toml_file, catalogues, contents.description, changes, implied);
  if (const Refusal difference = text_against_record(study, contents))
    throw StorageError("the study's text and what is recorded of it disagree: " + *difference);
  study.seed = contents.seed;
  return study;
}

ProblemRecord continued_problem(const Study& study, const ProblemRecord& begun) {
  ProblemRecord now = problem_record(study);
  for (const ParameterRecord& before : begun.parameters) {
    const ParameterRecord* const after = find_named(now.parameters, before.name);
    if (!after)
      throw std::invalid_argument("it has the parameter " + before.name + ", which this program's mechanism " +
                                  now.mechanism + " has not");
    if (after->value != before.value || after->unit != before.unit || after->variable != before.variable)
      throw std::invalid_argument("it was begun with " + before.name + " = " + with_unit(before.value, before.unit) +
                                  ", where this program takes " + with_unit(after->value, after->unit));
  }
  if (now.shape() != begun.shape())
    throw std::invalid_argument("this program gives other numbers of objectives, constraints or reports");
  return now;
}

std::vector<std::string> option_lines(const Options& options) {
  std::vector<std::string> lines;
  for (const auto& [name, value] : options.values()) lines.push_back(name + " = " + to_text(value));
  return lines;
}

}  // namespace pkm
