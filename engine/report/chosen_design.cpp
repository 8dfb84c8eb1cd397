#include "engine/report/chosen_design.hpp"

#include <algorithm>
#include <functional>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

ConfigError wrong(const char* option, const std::string& found, const std::string& expected) {
  return ConfigError({"", 0, option}, found, expected);
}

/// The number within [first, last], which are what `expected` ends with.
std::size_t checked(const char* option, std::int64_t number, std::int64_t first, std::int64_t last,
                    const std::string& expected) {
  if (number < first || number > last)
    throw wrong(option, std::to_string(number),
                expected + ", " + std::to_string(first) + " to " + std::to_string(last));
  return static_cast<std::size_t>(number - first);
}

/// Index of the stage asked for among those that have what is looked for; the last one where none is asked for.
template <class Has>
std::size_t chosen_stage(const StudyContents& contents, const DesignChoice& choice, const char* option,
                         const std::string& what, const Has& has) {
  std::vector<std::string> with;
  for (std::size_t s = 0; s < contents.stages.size(); ++s)
    if (std::invoke(has, contents.stages[s])) with.push_back(std::to_string(s + 1));
  if (with.empty())
    throw wrong(option, "study " + contents.name, "a study file that holds a " + what + ": this one has none");
  const std::string stage = choice.stage ? std::to_string(*choice.stage) : with.back();
  if (std::ranges::find(with, stage) == with.end())
    throw wrong("--stage", stage, "a stage with a " + what + ": " + join(with));
  return std::stoul(stage) - 1;
}

void refuse_contradictions(const DesignChoice& choice) {
  const bool of_generation = choice.generation || choice.individual;
  if (choice.baseline + of_generation + choice.front.has_value() > 1)
    throw wrong(choice.baseline ? "--baseline" : "--front", "another design beside it",
                "one of --baseline, --front N, and --generation G with --individual I");
  if (of_generation && !(choice.generation && choice.individual))
    throw wrong(choice.generation ? "--generation" : "--individual",
                choice.generation ? "no --individual" : "no --generation", "--generation G and --individual I");
  if (choice.stage && !of_generation && !choice.front)
    throw wrong("--stage", "no --front or --generation", "the front or the generation of that stage");
}

}  // namespace

ChosenDesign chosen_design(const StudyContents& contents, const Study& study, const DesignChoice& choice) {
  refuse_contradictions(choice);
  if (choice.baseline) {
    if (!study.baseline)
      throw wrong("--baseline", "study " + contents.name, "a study with a [baseline]: this one has none");
    return {"the baseline", "baseline", *study.baseline};
  }
  const auto design = [&](std::size_t stage, std::int64_t row) {
    return study.problem->parameters(contents.stages[stage].table.design(static_cast<std::size_t>(row)));
  };
  if (choice.front) {
    const std::size_t s = chosen_stage(contents, choice, "--front", "front", &StageRecord::has_front);
    const std::string stage = std::to_string(s + 1), point = std::to_string(*choice.front);
    const std::vector<std::int64_t>& rows = contents.stages[s].front->rows;
    const std::size_t k = checked("--front", *choice.front, 1, static_cast<std::int64_t>(rows.size()),
                                  "a point of the front of stage " + stage);
    return {"point " + point + " of the front of stage " + stage, "stage-" + stage + "-front-" + point,
            design(s, rows[k])};
  }
  if (choice.generation) {
    const std::size_t s = chosen_stage(contents, choice, "--generation", "generation",
                                       [](const StageRecord& stage) { return stage.generations.size() > 0; });
    const GenerationRecords& generations = contents.stages[s].generations;
    const std::string stage = std::to_string(s + 1), generation = std::to_string(*choice.generation),
                      individual = std::to_string(*choice.individual);
    const std::size_t g = checked("--generation", *choice.generation, 0,
                                  static_cast<std::int64_t>(generations.size()) - 1, "a generation of stage " + stage);
    const auto population = generations.population_of(g);
    const std::size_t k = checked("--individual", *choice.individual, 1, static_cast<std::int64_t>(population.size()),
                                  "an individual of generation " + generation);
    return {"individual " + individual + " of generation " + generation + " of stage " + stage,
            "stage-" + stage + "-generation-" + generation + "-individual-" + individual, design(s, population[k])};
  }
  if (contents.best.row < 0)
    throw ConfigError({}, "no best design in study " + contents.name,
                      "a study that has evaluated one: this one has none yet");
  return {"the best design", "best", design(static_cast<std::size_t>(contents.best.stage), contents.best.row)};
}

}  // namespace pkm
