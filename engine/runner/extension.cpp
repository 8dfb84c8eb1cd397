#include "engine/runner/extension.hpp"

#include <algorithm>

namespace pkm {
namespace {

/// Throws ConfigError if the stage has no limit with the name `limit`, or if the value exceeds the maximum of this
/// limit.
void check_limit(const Stage& stage, const std::string& limit, double value) {
  const auto option = std::ranges::find(stage.entry->options, limit, &OptionSpec::name);
  const SourceLocation place{"", 0, "--" + limit};
  if (option == stage.entry->options.end())
    throw ConfigError(place, "an optimiser '" + stage.entry->name + "' as the last stage",
                      "one that has a limit on " + limit);
  if (!(value <= option->upper)) throw ConfigError(place, shortest(value), "at most " + shortest(option->upper));
}

/// Number of evaluations made, as the stage's evaluation limit counts them: all evaluations of the stage or, in a
/// solver stage, where the limit applies to each multistart run, those of the longest run.
double evaluations_done(const StageRecord& stage) {
  // The rows of the evaluation table after those of all finished multistart runs belong to the unfinished run.
  auto count = static_cast<std::int64_t>(stage.table.size());
  if (!stage.starts.empty()) count -= stage.starts.back().first_row + stage.starts.back().rows;
  for (const StartOutcome& start : stage.starts) count = std::max(count, start.rows);
  for (const UnmergedRun& start : stage.ahead) count = std::max(count, static_cast<std::int64_t>(start.table.size()));
  return static_cast<double>(count);
}

}  // namespace

void request_extension(const Study& study, StudyContents& contents, const ExtensionRequest& request) {
  const auto last = static_cast<std::int64_t>(study.stages.size()) - 1;
  const bool started = contents.stages.size() == study.stages.size();
  const auto set = [&](const std::string& limit, double value, double done) {
    check_limit(study.stages.back(), limit, value);
    if (value < done)
      throw ConfigError({"", 0, "--" + limit}, shortest(value),
                        "at least " + shortest(done) + ", which the study has already");
    std::erase_if(contents.extensions, [&](const Extension& e) { return e.stage == last && e.limit == limit; });
    contents.extensions.push_back({last, limit, value});
  };
  const double generations = started ? static_cast<double>(contents.stages.back().generations.size()) - 1 : 0;
  const double evaluations = started ? evaluations_done(contents.stages.back()) : 0;
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
