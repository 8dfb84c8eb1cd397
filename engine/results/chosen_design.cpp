#include "engine/results/chosen_design.hpp"

#include <algorithm>
#include <functional>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

ConfigError option_error(const char* option, const std::string& sentence) {
  return ConfigError({"", 0, option}, sentence);
}

/// Converts a number in [first, last] to an index from 0. Throws ConfigError if it is out of range.
/// @param expected  what the number identifies, for the message
std::size_t to_index(const char* option, std::int64_t number, std::int64_t first, std::int64_t last,
                     const std::string& expected) {
  if (number < first || number > last)
    throw ConfigError({"", 0, option}, std::to_string(number),
                      expected + ", " + std::to_string(first) + " to " + std::to_string(last));
  return static_cast<std::size_t>(number - first);
}

/// Index of the requested stage, or without a request of the last stage for which has_content(stage) is true. Throws
/// ConfigError if the requested stage, or every stage, lacks the content.
/// @param option   the option that needs the content, for messages
/// @param content  "front" or "generation", for messages
template <class HasContent>
std::size_t find_stage(const StudyContents& contents, const DesignChoice& choice, const char* option,
                       const std::string& content, const HasContent& has_content) {
  std::vector<std::string> candidates;
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    if (std::invoke(has_content, contents.stages[s])) candidates.push_back(std::to_string(s + 1));
  if (candidates.empty())
    throw option_error(option, "study " + contents.name + " has no " + content + "; expected a study that has one");
  const std::string stage = choice.stage ? std::to_string(*choice.stage) : candidates.back();
  if (std::ranges::find(candidates, stage) == candidates.end())
    throw ConfigError({"", 0, "--stage"}, stage, "a stage with a " + content + ": " + join(candidates));
  return std::stoul(stage) - 1;
}

/// Throws ConfigError if the options that select a design (--front, --generation ..) select two, or are incomplete.
void check_choice(const DesignChoice& choice) {
  const bool of_generation = choice.generation || choice.individual;
  if (choice.baseline + of_generation + choice.front.has_value() > 1)
    throw option_error(choice.baseline ? "--baseline" : "--front",
                       "two designs selected; expected --baseline, --front N, or --generation G with --individual I");
  if (of_generation && !(choice.generation && choice.individual))
    throw option_error(choice.generation ? "--generation" : "--individual",
                       "incomplete; expected --generation G with --individual I");
  if (choice.stage && !of_generation && !choice.front)
    throw option_error("--stage", "--front or --generation is missing; expected one of them with --stage");
}

}  // namespace

ChosenDesign chosen_design(const StudyContents& contents, const Study& study, const DesignChoice& choice) {
  check_choice(choice);
  if (choice.baseline) {
    if (!study.baseline)
      throw option_error("--baseline", "study " + contents.name + " has no [baseline]; expected a study that has one");
    return {"the baseline", "baseline", *study.baseline};
  }
  const auto design = [&](std::size_t stage, std::int64_t row) {
    return study.problem->parameters(contents.stages[stage].table.design(static_cast<std::size_t>(row)));
  };
  if (choice.front) {
    const std::size_t s = find_stage(contents, choice, "--front", "front", &StageRecord::has_front);
    const std::string stage = std::to_string(s + 1), point = std::to_string(*choice.front);
    const std::vector<std::int64_t>& rows = contents.stages[s].front->rows;
    const std::size_t k = to_index("--front", *choice.front, 1, static_cast<std::int64_t>(rows.size()),
                                   "a point of the front of stage " + stage);
    return {"point " + point + " of the front of stage " + stage, "stage-" + stage + "-front-" + point,
            design(s, rows[k])};
  }
  if (choice.generation) {
    const std::size_t s = find_stage(contents, choice, "--generation", "generation",
                                     [](const StageRecord& stage) { return stage.generations.size() > 0; });
    const GenerationRecords& generations = contents.stages[s].generations;
    const std::string stage = std::to_string(s + 1), generation = std::to_string(*choice.generation),
                      individual = std::to_string(*choice.individual);
    const std::size_t g = to_index("--generation", *choice.generation, 0,
                                   static_cast<std::int64_t>(generations.size()) - 1, "a generation of stage " + stage);
    const auto population = generations.population_of(g);
    const std::size_t k = to_index("--individual", *choice.individual, 1, static_cast<std::int64_t>(population.size()),
                                   "an individual of generation " + generation);
    return {"individual " + individual + " of generation " + generation + " of stage " + stage,
            "stage-" + stage + "-generation-" + generation + "-individual-" + individual, design(s, population[k])};
  }
  if (contents.best.row < 0)
    throw ConfigError({}, "study " + contents.name + " has no best design yet; expected an evaluated design");
  return {"the best design", "best", design(static_cast<std::size_t>(contents.best.stage), contents.best.row)};
}

}  // namespace pkm
