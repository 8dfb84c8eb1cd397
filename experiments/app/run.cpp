// pkmopt run: a study from its TOML file, or the same study over several seeds.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "engine/core/printable.hpp"
#include "engine/study/stop_request.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/running.hpp"

namespace pkm {
namespace {

struct RunArguments {
  std::string study, output;
  bool resume = false, force = false;
  std::optional<std::int64_t> seed;
  int seeds = 1;
  RunningArguments common;
};

/// What the evaluations will cost at most, from a timed one in the middle of the design space.
void print_estimate(const Study& study, int seeds, int threads) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape());
  table.extend(1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) table.design(0)[i] = problem.space().from_unit(i, 0.5);
  using Clock = std::chrono::steady_clock;
  double seconds = 1e30;
  Scratch scratch;
  for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {  // the first one also warms up
    const auto begin = Clock::now();
    problem.evaluate(table.design(0), scratch, table.slot(0));
    seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  std::int64_t limit = 0;
  for (const auto& stage : study.stages) limit += stage.optimiser->evaluation_limit(problem);
  std::cout << printable(study.name) << ": at most " << limit << " evaluations";
  if (seeds > 1) std::cout << " for each of " << seeds << " seeds";
  std::cout << " of about " << duration_text(seconds) << ", together about "
            << duration_text(seconds * static_cast<double>(limit) * seeds / threads) << " on " << threads
            << (threads == 1 ? " thread" : " threads") << std::endl;  // at once, also into a pipe
}

/// A given voxel box that cuts the workspace makes it look smaller than it is.
void warn_of_box(const Study& study, const std::string& program) {
  const auto& parts = study.problem->parts();
  if (!parts.plan.voxels() || !parts.plan.box()) return;
  const auto report = study.problem->report(study.baseline ? *study.baseline : parts.parameters);
  if (report.survey.touches_box)
    std::cerr << program << ": warning: feasible cells of the " << (study.baseline ? "baseline" : "nominal design")
              << " touch the box of [workspace]; the workspace may be larger than what is counted\n";
}

bool exists(const std::string& file) {
  std::error_code unseen;  // the attempt to open it tells
  return std::filesystem::exists(file, unseen);
}

RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments, Session& session,
                   Progress& progress) {
  const RunOptions options = run_options(arguments.common);
  if (arguments.resume && exists(output)) {
    HeldStudy held(output);
    StudyContents& contents = held.contents;
    const std::string way_out =
        "; go on with it by '" + session.program + " resume " + quoted(output) + "', or overwrite it with --force";
    if (contents.toml != study.text)
      throw StorageError(output + " holds another text of the study than " + study.file_name + way_out);
    if (contents.seed != study.seed)
      throw StorageError(output + " holds the study with seed " + std::to_string(contents.seed) + ", not " +
                         std::to_string(study.seed) + way_out);
    if (contents.state == StudyState::finished) return {.contents = std::move(contents)};
    return resume_study(held, session.catalogues, {}, options, progress);
  }
  return run_study(study, output, arguments.force, options, progress);
}

std::string seed_file(const std::string& output, std::uint64_t seed) {
  const std::filesystem::path path(output);
  return (path.parent_path() / (path.stem().string() + "-seed-" + std::to_string(seed) + path.extension().string()))
      .string();
}

/// Says which of the seeds is under way.
class SeedProgress final : public Progress {
 public:
  SeedProgress(Progress& screen, int seeds) : screen_(screen), seeds_(seeds) {}
  void next() { ++seed_; }
  void generation(const ProgressReport& report) override {
    ProgressReport named = report;
    named.optimiser = "seed " + std::to_string(seed_) + " of " + std::to_string(seeds_) + ", " + report.optimiser;
    screen_.generation(named);
  }

 private:
  Progress& screen_;
  int seeds_, seed_ = 0;
};

/// The last hypervolume of the study's evolved front; none where its corner is not the study's to say: hypervolumes
/// from different corners cannot be compared.
std::optional<double> evolved_hypervolume(const Study& study, const StudyContents& contents) {
  for (std::size_t i = contents.stages.size(); i-- > 0;) {
    const std::optional<FrontRecord>& front = contents.stages[i].front;
    if (!front || front->hypervolume.empty() || !study.stages[i].options.has("reference")) continue;
    if (std::isfinite(front->hypervolume.back())) return front->hypervolume.back();
  }
  return {};
}

/// What came of the seeds: a row each, and the numbers of the spread.
struct SeedTable {
  bool trade_off;
  int feasible_seeds = 0;
  std::vector<Row> rows = {{"seed", trade_off ? "hypervolume" : "best", "exact", "evaluations", "time", "file"}};
  std::vector<double> best = {}, exact = {}, seconds = {};

  void add(const Study& study, const StudyContents& contents, const std::string& file) {
    const FinalRecord final = contents.final.value_or(FinalRecord());
    const auto objective = [](const std::optional<DesignRecord>& record) -> std::optional<double> {
      if (!record || record->objectives.empty()) return {};
      return record->objectives[0];
    };
    const bool feasible = objective(final.best) && final.best->status == Status::feasible;
    feasible_seeds += feasible;
    const auto keep = [feasible](std::optional<double> value, std::vector<double>& all) -> std::string {
      if (!feasible || !value) return "";
      all.push_back(*value);
      return digits(*value);
    };
    const auto value = trade_off ? evolved_hypervolume(study, contents) : objective(final.best);
    const std::string best_text = feasible ? keep(value, best) : "nothing feasible";
    seconds.push_back(contents.seconds);
    rows.push_back({std::to_string(contents.seed), best_text, trade_off ? "" : keep(objective(final.best_exact), exact),
                    std::to_string(contents.evaluations()), duration_text(contents.seconds), file});
  }

  void add_spread() {
    const auto row = [&](const char* name, const auto& pick) {
      const auto of = [&](std::vector<double> values, const auto& text) {
        std::ranges::sort(values);
        return values.empty() ? std::string() : text(pick(values));
      };
      rows.push_back({name, of(best, digits), of(exact, digits), "", of(seconds, duration_text), ""});
    };
    row("least", [](const std::vector<double>& v) { return v.front(); });
    row("median", [](const std::vector<double>& v) { return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]); });
    row("greatest", [](const std::vector<double>& v) { return v.back(); });
  }
};

/// The same study over several seeds: a file and a line each, then the spread.
void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, Session& session) {
  const StopRequest listen;  // one for all, so that a signal between two seeds counts
  const std::uint64_t first = study.seed;
  if (first > std::numeric_limits<std::uint64_t>::max() - static_cast<std::uint64_t>(arguments.seeds))
    throw ConfigError({"", 0, "--seeds"}, "a first seed of " + std::to_string(first), "one that leaves room for them");
  const auto file_of = [&](int i) { return seed_file(output, first + static_cast<std::uint64_t>(i)); };
  for (int i = 0; i < arguments.seeds; ++i) {
    check_outputs({file_of(i)}, {arguments.study}, Existing::replaced);
    if (!arguments.force && !arguments.resume && exists(file_of(i)))
      throw StorageError(file_of(i) + " exists already; resume it with --resume, or overwrite it with --force");
  }

  SeedTable table{study.problem->objectives().size() > 1};
  const auto screen = make_progress(arguments.common);
  SeedProgress progress(*screen, arguments.seeds);
  for (int i = 0; i < arguments.seeds && session.exit_code == kDone; ++i) {
    study.seed = first + static_cast<std::uint64_t>(i);
    progress.next();
    const RunOutcome outcome = run_one(study, file_of(i), arguments, session, progress);
    if (outcome.stopped.empty()) table.add(study, outcome.contents, file_of(i));
    const bool last = i == arguments.seeds - 1;
    if (!outcome.stopped.empty() || (StopRequest::signal() != 0 && !last)) session.exit_code = kStoppedEarly;
  }
  screen->finish();
  table.add_spread();
  if (!arguments.common.quiet)
    std::cout << printable(study.name) << ", " << table.seconds.size() << " of " << arguments.seeds << " seeds\n"
              << aligned(table.rows) << table.feasible_seeds << " of " << table.seconds.size()
              << " seeds ended feasible\n";
  if (session.exit_code == kStoppedEarly)
    std::cout << "stopped; go on with: " << session.program << " run " << quoted(arguments.study) << " --seeds "
              << arguments.seeds << " --seed " << first << " --resume --output " << quoted(output) << '\n';
}

void run(const RunArguments& arguments, Session& session) {
  Study study = load_study_toml(arguments.study, session.catalogues);
  if (arguments.seed) study.seed = static_cast<std::uint64_t>(*arguments.seed);
  const std::string output = arguments.output.empty() ? study.output_file() : arguments.output;
  check_outputs({output}, {arguments.study}, Existing::replaced);
  for (const auto& warning : study.warnings) std::cerr << session.program << ": warning: " << warning << '\n';
  warn_of_box(study, session.program);
  if (!arguments.common.quiet) print_estimate(study, arguments.seeds, team_size(arguments.common.threads));
  if (arguments.seeds > 1) {
    run_seeds(study, output, arguments, session);
    return;
  }
  const auto progress = make_progress(arguments.common);
  const RunOutcome outcome = run_one(study, output, arguments, session, *progress);
  progress->finish();
  print_outcome(outcome, study, output, arguments.common, session);
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  const auto [command, arguments] =
      add_command<RunArguments>(app, "run", "Runs a study and writes its study file.",
                                "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml --threads 2",
                                [&session](const RunArguments& given) { run(given, session); });
  add_option(command, "study STUDY.toml", arguments.study, "The study, a TOML file")->required();
  add_option(command, "--output F.h5", arguments.output,
             "The study file (default: as the study says, else its stem + .h5)");
  command.add_flag("--resume", arguments.resume, "Go on with the study file if it exists");
  command.add_flag("--force", arguments.force, "Overwrite the study file if it exists")->excludes("--resume");
  add_integer(command, "--seed N", arguments.seed, 0, std::numeric_limits<std::int64_t>::max(),
              "Seed, instead of the study's own");
  add_integer(command, "--seeds N", arguments.seeds, 1, 100'000,
              "Repeat the study over N seeds, a file each, and print the spread");
  add_running_options(command, arguments.common);
}

}  // namespace pkm
