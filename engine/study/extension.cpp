#include "engine/study/extension.hpp"

#include <algorithm>

namespace pkm {
namespace {

/// Throws ConfigError when the last stage has no such limit or the value does not fit it.
void check_limit(const Stage& stage, const std::string& limit, double value) {
  const auto option = std::ranges::find(stage.entry->options, limit, &OptionSpec::name);
  const SourcePlace place{"", 0, "--" + limit};
  if (option == stage.entry->options.end())
    throw ConfigError(place, "an optimiser '" + stage.entry->name + "' as the last stage",
                      "one that has a limit on " + limit);
  if (!(value <= option->upper)) throw ConfigError(place, shortest(value), "at most " + shortest(option->upper));
}

/// What a limit on evaluations counts: those of the stage, or of one start of a solver.
double evaluations_done(const StageRecord& stage) {
  auto most = static_cast<std::int64_t>(stage.table.size());  // less those of the starts that have ended
  if (!stage.starts.empty()) most -= stage.starts.back().first_row + stage.starts.back().rows;
  for (const StartOutcome& start : stage.starts) most = std::max(most, start.rows);
  for (const StartAhead& start : stage.ahead) most = std::max(most, static_cast<std::int64_t>(start.table.size()));
  return static_cast<double>(most);
}

}  // namespace

void request_extension(const Study& study, StudyContents& contents, const ExtensionRequest& request) {
  const auto last = static_cast<std::int64_t>(study.stages.size()) - 1;
  const bool begun = contents.stages.size() == study.stages.size();
  const auto set = [&](const std::string& limit, double value, double done) {
    check_limit(study.stages.back(), limit, value);
    if (value < done)
      throw ConfigError({"", 0, "--" + limit}, shortest(value),
                        "at least " + shortest(done) + ", which the study has already");
    std::erase_if(contents.extensions, [&](const Extension& e) { return e.stage == last && e.limit == limit; });
    contents.extensions.push_back({last, limit, value});
  };
  const double generations = begun ? static_cast<double>(contents.stages.back().generations.size()) - 1 : 0;
  const double evaluations = begun ? evaluations_done(contents.stages.back()) : 0;
  if (request.evaluations) set("evaluations", static_cast<double>(*request.evaluations), evaluations);
  if (request.generations) set("generations", static_cast<double>(*request.generations), generations);
  const auto& options = study.stages.back().entry->options;
  const auto option = std::ranges::find(options, "generations", &OptionSpec::name);
  if (request.evaluations && !request.generations && option != options.end())
    set("generations", option->upper, generations);
}

void apply_extensions(Study& study, const std::vector<Extension>& extensions) {
  for (const Extension& e : extensions) {
    Stage& stage = study.stages.at(static_cast<std::size_t>(e.stage));
    stage.options.set(e.limit, static_cast<std::int64_t>(e.value));
    stage.optimiser = stage.entry->make(stage.options, study.problem->space());
  }
}

}  // namespace pkm
