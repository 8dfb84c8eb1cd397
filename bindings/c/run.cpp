// Runs of studies, with progress reports and stop requests on the calling thread.
#include <cmath>

#include "bindings/c/handles.hpp"
#include "engine/runner/run_study.hpp"
#include "experiments/app/version.hpp"

namespace pkm::c {
namespace {

/// Progress display that calls the caller's progress function.
class Reported final : public Progress {
 public:
  explicit Reported(const pkmopt_run_options& options) : options_(options) {}

  void generation(const ProgressReport& report) override {
    if (!options_.progress) return;
    const bool has_objective = !report.objective.empty();
    const pkmopt_progress progress{.stage = static_cast<int>(report.stage) + 1,
                                   .stages = static_cast<int>(report.stages),
                                   .generation = report.generation,
                                   .evaluations = report.evaluations,
                                   .evaluation_limit = report.evaluation_limit,
                                   .seconds = report.seconds,
                                   .best = report.has_best && has_objective ? report.best : std::nan(""),
                                   .violation = report.violation,
                                   .front = report.front,
                                   .hypervolume = report.hypervolume,
                                   .feasible_share = report.feasible_share};
    if (options_.progress(&progress, options_.user) != 0) is_stop_requested_ = true;
  }
  bool is_stop_requested() const { return is_stop_requested_; }

 private:
  const pkmopt_run_options& options_;
  std::atomic<bool> is_stop_requested_ = false;
};

/// Runs body(run options, progress) and describes its outcome.
template <class Body>
Json outcome_of(const pkmopt_run_options* given, const Body& body) {
  const pkmopt_run_options options = given ? *given : pkmopt_run_options{};
  Reported progress(options);
  Interrupt interrupt(options.common);
  RunOptions run{.threads = options.common.threads, .program = {program_version(), program_revision(), "libpkmopt"}};
  if (!(options.time_limit >= 0))
    throw ConfigError({"", 0, "time_limit"}, std::to_string(options.time_limit), "a time > 0, or 0 for none");
  if (options.time_limit > 0) run.time_limit = options.time_limit;
  run.stop = [&] { return progress.is_stop_requested() || interrupt.is_requested(); };
  run.handles_signals = false;
  run.python = python_options(options.python);
  if (options.functions) run.functions = functions_of(*options.functions);
  const RunOutcome outcome = body(run, progress);
  return {{"stopped", outcome.stopped},
          {"seconds", outcome.seconds},
          {"evaluations", outcome.evaluations},
          {"total_evaluations", outcome.contents.evaluations()},
          {"parallel_efficiency", outcome.parallel_efficiency},
          {"team", outcome.team},
          {"warnings", outcome.warnings}};
}

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_study_run(const pkmopt_study* study, const char* path, int64_t seed,
                               const pkmopt_run_options* options, char** json) {
  return guarded([&] {
    const std::string file = required_text(path, "path");
    refuse_existing(file, options && options->overwrite != 0);
    pkm::Study copy = study->study;
    if (seed >= 0) copy.seed = static_cast<std::uint64_t>(seed);
    pkm::require_stages(copy, catalogues());
    *json = allocated(outcome_of(options, [&](const pkm::RunOptions& run, pkm::Progress& progress) {
      return pkm::run_study(copy, file, options && options->overwrite != 0, run, progress);
    }));
  });
}

pkmopt_status pkmopt_study_resume(const char* path, int64_t generations, int64_t evaluations,
                                  const pkmopt_run_options* options, char** json) {
  return guarded([&] {
    const std::string file = required_text(path, "path");
    pkm::ExtensionRequest extension;
    for (const auto& [name, value] : {std::pair("generations", generations), std::pair("evaluations", evaluations)})
      if (value < 0)
        throw pkm::ConfigError({"", 0, name}, std::to_string(value), "a number > 0, or 0 for no extension");
    if (generations > 0) extension.generations = generations;
    if (evaluations > 0) extension.evaluations = evaluations;
    *json = allocated(outcome_of(options, [&](const pkm::RunOptions& run, pkm::Progress& progress) {
      return pkm::resume_study(file, catalogues(), extension, run, progress);
    }));
  });
}
