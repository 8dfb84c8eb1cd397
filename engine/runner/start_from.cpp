#include "engine/runner/start_from.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/runner/stage_starts.hpp"

namespace pkm {
namespace {

constexpr const char* kOption = "--start-from";

/// Maximum number of designs of another study from which a stage can start.
std::size_t designs_used_by(const Stage& stage) {
  const Options& options = stage.options;
  if (stage.entry->capabilities(options).starts)
    return options.word("start") == "best-of-basins" ? static_cast<std::size_t>(options.integer("starts")) : 1;
  return options.has("population") ? static_cast<std::size_t>(options.integer("population")) / 2 : 1;
}

std::string assignments(const DesignSpace& space, const std::vector<double>& design) {
  std::vector<std::string> words;
  for (std::size_t v = 0; v < design.size(); ++v) words.push_back(space[v].name + "=" + shortest(design[v]));
  return join(words, ",");
}

}  // namespace

StartFrom start_from(const Study& study, const StudyContents& other, const std::string& file) {
  const DesignSpace& space = study.problem->space();
  const std::vector<ParameterRecord>& known = other.problem.parameters;
  StartFrom result;
  std::vector<const ParameterRecord*> sources;
  bool has_common_variable = false;
  for (const Variable& v : space.variables()) {
    const ParameterRecord* const source = find_named(known, v.name);
    sources.push_back(source);
    if (!source) {
      result.missing.push_back(v.name);
      continue;
    }
    if (source->unit != v.unit)
      throw ConfigError({file, 0, v.name}, "a parameter in " + source->unit,
                        "one in " + v.unit + ", as " + v.name + " of " + study.file_name + ", for " + kOption);
    if (source->variable >= 0) has_common_variable = true;
  }
  if (!has_common_variable)
    throw ConfigError({file, 0, ""}, "a study with the variables " + join(names_of(other.problem.variables)),
                      std::string("one that has a variable in common with ") + study.file_name + " (" +
                          join(names_of(space.variables())) + ") for " + kOption);
  const std::vector<StartDesign> designs = distinct_best_designs(other, designs_used_by(study.stages.front()));
  if (designs.empty())
    throw ConfigError({file, 0, ""}, "a study without an evaluated design", std::string("designs for ") + kOption);
  const std::vector<double> base = baseline_or_centre(study);
  for (const StartDesign& each : designs) {
    std::vector<double> design = base;
    bool is_moved = false;
    for (std::size_t v = 0; v < design.size(); ++v) {
      if (!sources[v]) continue;
      const double value =
          sources[v]->variable >= 0 ? each.design[static_cast<std::size_t>(sources[v]->variable)] : sources[v]->value;
      design[v] = space.nearest(v, value);
      is_moved = is_moved || design[v] != value;
    }
    const std::string words = assignments(space, design);
    if (std::ranges::find(result.start, words) != result.start.end()) continue;
    result.start.push_back(words);
    if (is_moved) ++result.moved;
  }
  return result;
}

}  // namespace pkm
