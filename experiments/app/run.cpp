// pkmopt run: a study from its TOML file, or the same study over several seeds.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>

#include "engine/core/text_table.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/running.hpp"

namespace pkm {
namespace {

struct RunArguments {
  std::string study;
  std::string output;
  bool resume = false, force = false;
  std::optional<std::uint64_t> seed;
  int seeds = 1;
  RunningArguments common;
};

/// What the run will cost at most, from a timed evaluation of the middle of the design space.
void print_estimate(const Study& study, int threads) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape());
  table.extend(1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) table.design(0)[i] = problem.space().from_unit(i, 0.5);
  using Clock = std::chrono::steady_clock;
  double seconds = 1e30;
  for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {  // the first one also warms up
    const auto begin = Clock::now();
    problem.evaluate(table.design(0), table.slot(0));
    seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  std::int64_t limit = 0;
  for (const auto& stage : study.stages) limit += stage.optimiser->evaluation_limit(problem);
  std::cout << study.name << ": at most " << limit << " evaluations of about " << duration_text(seconds) << ", on "
            << threads << (threads == 1 ? " thread" : " threads") << " at most "
            << duration_text(seconds * static_cast<double>(limit) / threads) << '\n';
}

/// A given voxel box that cuts the workspace makes it look smaller than it is.
void warn_of_box(const Study& study) {
  const auto& parts = study.problem->parts();
  if (parts.plan.method != Method::voxels || !parts.plan.box) return;
  const auto report = study.problem->report(study.baseline ? *study.baseline : parts.parameters);
  if (report.survey.touches_box)
    std::cerr << "pkmopt: warning: feasible cells of the " << (study.baseline ? "baseline" : "nominal design")
              << " touch the box of [workspace]; the workspace may be larger than what is counted\n";
}

RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments, Session& session,
                   Progress& progress) {
  const RunOptions options = run_options(arguments.common);
  if (arguments.resume && std::filesystem::exists(output)) {
    if (read_study(output).toml != study.text)
      throw StorageError(output + " holds another text of the study than " + study.file_name +
                         "; go on with it by 'pkmopt resume " + output + "', or overwrite it with --force");
    return resume_study(output, session.catalogues, {}, options, progress);
  }
  return run_study(study, output, arguments.force, options, progress);
}

std::string seed_file(const std::string& output, std::uint64_t seed) {
  const std::filesystem::path path(output);
  return (path.parent_path() / (path.stem().string() + "-seed-" + std::to_string(seed) + path.extension().string()))
      .string();
}

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// The same study over several seeds: a file and a line each, then the spread.
void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, Session& session) {
  std::vector<std::vector<std::string>> rows = {{"seed", "best", "exact", "evaluations", "time", "file"}};
  std::vector<double> best, exact, seconds;
  const std::uint64_t first = study.seed;
  Progress silent;
  for (int i = 0; i < arguments.seeds; ++i) {
    study.seed = first + static_cast<std::uint64_t>(i);
    const std::string file = seed_file(output, study.seed);
    const RunOutcome outcome = run_one(study, file, arguments, session, silent);
    if (!outcome.stopped.empty()) {
      print_stop(outcome, file);
      session.exit_code = kStoppedEarly;
      return;
    }
    const auto& final = outcome.contents.final;
    const auto objective = [](const std::optional<DesignRecord>& r) { return r && !r->objectives.empty(); };
    const bool feasible = final && objective(final->best) && final->best->status == Status::feasible;
    if (feasible) best.push_back(final->best->objectives[0]);
    const bool has_exact = final && objective(final->best_exact);
    if (feasible && has_exact) exact.push_back(final->best_exact->objectives[0]);
    seconds.push_back(outcome.contents.seconds);
    rows.push_back({std::to_string(study.seed), feasible ? digits(best.back()) : "nothing feasible",
                    feasible && has_exact ? digits(exact.back()) : "", std::to_string(outcome.contents.evaluations()),
                    duration_text(outcome.contents.seconds), file});
  }
  if (arguments.common.quiet) return;
  const auto spread = [&](const char* name, auto pick) {
    const auto of = [&](std::vector<double> values) {
      if (values.empty()) return std::string();
      std::sort(values.begin(), values.end());
      return digits(pick(values));
    };
    const std::string time = of(seconds);
    rows.push_back({name, of(best), of(exact), "", time.empty() ? "" : duration_text(std::stod(time)), ""});
  };
  spread("least", [](const std::vector<double>& v) { return v.front(); });
  spread("median", [](const std::vector<double>& v) { return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]); });
  spread("greatest", [](const std::vector<double>& v) { return v.back(); });
  std::cout << study.name << ", " << arguments.seeds << " seeds\n"
            << aligned(rows) << static_cast<int>(best.size()) << " of " << arguments.seeds << " seeds ended feasible\n";
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Runs a study and writes its study file.");
  command->add_option("study", arguments->study, "The study, a TOML file")->required()->type_name("STUDY.toml");
  command->add_option("--output", arguments->output, "The study file (default: as the study says, else its stem + .h5)")
      ->type_name("F.h5");
  command->add_flag("--resume", arguments->resume, "Go on with the study file if it exists");
  command->add_flag("--force", arguments->force, "Overwrite the study file if it exists")->excludes("--resume");
  command->add_option("--seed", arguments->seed, "Seed, instead of the study's own")->type_name("N");
  command->add_option("--seeds", arguments->seeds, "Repeat the study over N seeds, a file each, and print the spread")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  add_running_options(*command, arguments->common);
  command->footer("Example: pkmopt run experiments/4ppa-2par/paper-problem.toml --threads 2");
  command->callback([arguments, &session] {
    Study study = load_study_toml(arguments->study, session.catalogues);
    if (arguments->seed) study.seed = *arguments->seed;
    const std::string output = arguments->output.empty() ? study.output_file() : arguments->output;
    for (const auto& warning : study.warnings) std::cerr << "pkmopt: warning: " << warning << '\n';
    warn_of_box(study);
    if (!arguments->common.quiet) print_estimate(study, threads_of(arguments->common));
    if (arguments->seeds > 1) {
      run_seeds(study, output, *arguments, session);
      return;
    }
    const auto progress = make_progress(arguments->common);
    const RunOutcome outcome = run_one(study, output, *arguments, session, *progress);
    progress->finish();
    session.exit_code = print_outcome(outcome, study, output, arguments->common);
  });
}

}  // namespace pkm
