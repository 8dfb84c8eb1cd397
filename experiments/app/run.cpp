// pkmopt run: a study from its TOML file, or the same study over several seeds.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "engine/core/printable.hpp"
#include "engine/core/ranks.hpp"
#include "engine/report/standing.hpp"
#include "engine/study/stop_request.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct RunArguments {
  std::string study, output;
  bool resume = false, force = false;
  std::optional<std::int64_t> seed;
  int seeds = 1;
  StudyChanges changes;
  RunningArguments common;
};

/// What an evaluation takes [s]: in the middle of the design space or at the baseline, whichever takes longer, for a
/// design that cannot be evaluated takes no time.
double seconds_of_one(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape(detail));
  table.extend(study.baseline ? 2 : 1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) {
    table.design(0)[i] = problem.space().from_unit(i, 0.5);
    if (study.baseline) table.design(1)[i] = (*study.baseline)[problem.parts().varies[i]];
  }
  using Clock = std::chrono::steady_clock;
  Scratch scratch;
  double longest = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    double seconds = 1e30;
    for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {  // the first one also warms up
      const auto begin = Clock::now();
      problem.evaluate(table.design(row), scratch, table.slot(row));
      seconds = std::min(seconds, std::chrono::duration<double>(Clock::now() - begin).count());
    }
    longest = std::max(longest, seconds);
  }
  return longest;
}

constexpr int kMostCompared = 4;  // studies in the report that is proposed

/// What the evaluations will cost at most, from timed ones.
void print_estimate(const Study& study, int seeds, int threads_of_rank) {
  const int ranks = ranks::size(), threads = ranks * threads_of_rank;
  std::int64_t plain = 0, with_derivatives = 0;
  double plain_rounds = 0, derivative_rounds = 0;  // of evaluations side by side
  for (const auto& stage : study.stages) {
    const bool slopes = stage.optimiser->detail() == Detail::derivatives;
    const std::int64_t limit = stage.optimiser->evaluation_limit(*study.problem);
    const auto at_once = std::min<std::int64_t>(threads, stage.optimiser->at_once());
    (slopes ? with_derivatives : plain) += limit;
    (slopes ? derivative_rounds : plain_rounds) += static_cast<double>(limit) / static_cast<double>(at_once);
  }
  double together = 0;
  std::vector<std::string> parts;
  const auto add = [&](std::int64_t limit, const char* what, double seconds, double rounds) {
    parts.push_back(std::to_string(limit) + what + " of about " + duration_text(seconds));
    together += seconds * rounds;
  };
  if (plain > 0 || with_derivatives == 0)
    add(plain, " evaluations", seconds_of_one(study, Detail::complete), plain_rounds);
  if (with_derivatives > 0)
    add(with_derivatives, plain > 0 ? " with derivatives" : " evaluations with derivatives",
        seconds_of_one(study, Detail::derivatives), derivative_rounds);
  std::cout << printable(study.name) << ": at most " << join(parts, " and ");
  if (seeds > 1) std::cout << ", for each of " << seeds << " seeds";
  std::cout << ", together about " << duration_text(together * seeds) << " on "
            << (ranks > 1 ? std::to_string(ranks) + " ranks x " : "") << threads_of_rank
            << (threads_of_rank == 1 ? " thread" : " threads") << std::endl;  // at once, also into a pipe
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

/// What the command line changed in a study.
std::string changes_of(const Study& study) { return study.changes.empty() ? "no changes" : join(study.changes, " "); }

RunOutcome run_one(const Study& study, const std::string& output, const RunArguments& arguments,
                   const RunOptions& options, Session& session, Progress& progress) {
  if (arguments.resume && exists(output)) {
    HeldStudy held(output);
    StudyContents& contents = held.contents;
    const std::string way_out =
        "; go on with it by '" + session.program + " resume " + quoted(output) + "', or overwrite it with --force";
    if (contents.toml != study.text && without_changes(contents.toml) == without_changes(study.text))
      throw StorageError(output + " holds the study with " + changes_of(study_of(contents, session.catalogues)) +
                         ", not with " + changes_of(study) + way_out);
    if (contents.toml != study.text)
      throw StorageError(output + " holds another text of the study than " + study.file_name + way_out);
    if (study.description && contents.description && contents.description->text != study.description->text)
      throw StorageError(output + " holds another text of the mechanism than " + study.description->file_name +
                         way_out);
    if (contents.seed != study.seed)
      throw StorageError(output + " holds the study with seed " + std::to_string(contents.seed) + ", not " +
                         std::to_string(study.seed) + way_out);
    if (contents.state == StudyState::finished) return {.contents = std::move(contents)};
    return resume_study(held, session.catalogues, {}, options, progress);
  }
  return run_study(study, output, arguments.force, options, progress);
}

/// The files that a study was read from: no output may be one of them.
std::vector<std::string> inputs_of(const Study& study) {
  if (!study.description) return {study.file_name};
  return {study.file_name, study.description->file_name};
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
  std::string note = {};                ///< the first
  std::optional<Verdict> verdict = {};  ///< of the first seed that found nothing
  std::vector<std::string> wrong = {};  ///< volumes outside of their certain bounds

  void add(const Study& study, const StudyContents& contents, const std::string& file) {
    const FinalRecord final = contents.final.value_or(FinalRecord());
    const auto objective = [](const std::optional<DesignRecord>& record) -> std::optional<double> {
      if (!record || record->objectives.empty() || std::isnan(record->objectives[0])) return {};
      return record->objectives[0];
    };
    const auto nothing = verdict_on(contents, study.problem.get());
    if (!verdict) verdict = nothing;
    const bool feasible = !nothing && objective(final.best) && final.best->status == Status::feasible;
    feasible_seeds += feasible;
    const auto keep = [feasible](std::optional<double> value, std::vector<double>& all) -> std::string {
      if (!feasible || !value) return "";
      all.push_back(*value);
      return digits(*value);
    };
    const auto value = trade_off ? evolved_hypervolume(study, contents) : objective(final.best);
    for (const std::string& sentence : contradicted(contents))
      wrong.push_back("seed " + std::to_string(contents.seed) + ": " + sentence);
    const bool fails = final.best && final.best->certain && final.best->status == Status::failed;
    const std::string best_text = feasible ? keep(value, best) : fails ? "outside of its bounds" : "nothing feasible";
    seconds.push_back(contents.seconds);
    if (note.empty() && !contents.notes.empty())
      note = "note of seed " + std::to_string(contents.seed) + ": " + printable(join(contents.notes, "; ")) + '\n';
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
void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, RunOptions options,
               Session& session) {
  const StopRequest listen;  // one for all, so that a signal between two seeds counts
  const std::optional<double> time_limit = options.time_limit;  // of all
  double seconds = 0;
  const std::uint64_t first = study.seed;
  if (first > std::numeric_limits<std::uint64_t>::max() - static_cast<std::uint64_t>(arguments.seeds))
    throw ConfigError({"", 0, "--seeds"}, "a first seed of " + std::to_string(first), "one that leaves room for them");
  const auto file_of = [&](int i) { return seed_file(output, first + static_cast<std::uint64_t>(i)); };
  for (int i = 0; i < arguments.seeds; ++i) {
    check_outputs({file_of(i)}, inputs_of(study), Existing::replaced);
    if (!arguments.force && !arguments.resume && exists(file_of(i)))
      throw StorageError(file_of(i) + " exists already; resume it with --resume, or overwrite it with --force");
  }

  SeedTable table{study.problem->objectives().size() > 1};
  const auto screen = make_progress(arguments.common);
  SeedProgress progress(*screen, arguments.seeds);
  std::optional<std::string> unwritten;  // why what was found is not in its file
  for (int i = 0; i < arguments.seeds && session.exit_code == kDone; ++i) {
    study.seed = first + static_cast<std::uint64_t>(i);
    progress.next();
    if (time_limit) options.time_limit = *time_limit - seconds;
    RunEnd end;
    try {
      end = end_of_run([&] { return run_one(study, file_of(i), arguments, options, session, progress); });
    } catch (const StorageError& failure) {
      if (table.seconds.empty()) throw;
      unwritten = failure.what();
      break;
    }
    const RunOutcome& outcome = end.outcome;
    seconds += outcome.seconds;
    if (outcome.stopped.empty()) table.add(study, outcome.contents, end.unwritten ? "not written" : file_of(i));
    unwritten = end.unwritten;
    if (unwritten) break;
    const bool last = i == arguments.seeds - 1;
    if (!outcome.stopped.empty() || (StopRequest::signal() != 0 && !last)) session.exit_code = kStoppedEarly;
  }
  screen->finish();
  table.add_spread();
  if (!arguments.common.quiet || unwritten)
    std::cout << printable(study.name) << ", " << table.seconds.size() << " of " << arguments.seeds << " seeds\n"
              << aligned(table.rows) << table.feasible_seeds << " of " << table.seconds.size()
              << " seeds ended feasible\n"
              << table.note << std::flush;
  if (unwritten) throw StorageError(*unwritten);
  if (!table.wrong.empty()) throw std::runtime_error(join(table.wrong, "; "));
  if (session.exit_code == kDone && table.feasible_seeds == 0 && table.verdict) {
    if (!arguments.common.quiet)
      std::cout << "verdict: " << table.verdict->finding << ": " << table.verdict->sentence << '\n'
                << reasons_text(table.verdict->reasons);
    conclude(table.verdict, arguments.common, session);
  }
  if (session.exit_code != kStoppedEarly && !arguments.common.quiet) {
    std::vector<std::string> words = {"report"};
    for (int i = 0; i < std::min(arguments.seeds, kMostCompared); ++i) words.push_back(file_of(i));
    std::cout << next_step(session, words);
  }
  if (session.exit_code == kStoppedEarly) {
    std::cout << "stopped; go on with: " << session.program << " run " << quoted(arguments.study);
    for (const std::string& word : arguments.changes.arguments()) std::cout << ' ' << quoted(word);
    std::cout << " --seeds " << arguments.seeds << " --seed " << first << " --resume --output " << quoted(output)
              << '\n';
  }
}

void run(const RunArguments& arguments, Session& session) {
  expect_toml(arguments.study, "resume", session);
  expect_file(arguments.study, "a study in TOML", "new study", session);
  Study study = load_study_toml(arguments.study, session.catalogues, arguments.changes);
  if (arguments.seed) study.seed = static_cast<std::uint64_t>(*arguments.seed);
  const std::string output = arguments.output.empty() ? study.output_file() : arguments.output;
  check_outputs({output}, inputs_of(study), Existing::replaced);
  for (const auto& warning : study.warnings) std::cerr << session.program << ": warning: " << warning << '\n';
  for (const Reason& reason : contradictions(study.problem->parts()))
    std::cerr << session.program << ": warning: " << reason.sentence << '\n';
  warn_of_box(study, session.program);
  const RunOptions options = run_options(arguments.common, session);
  if (!arguments.common.quiet) print_estimate(study, arguments.seeds, threads_of(arguments.common));
  if (arguments.seeds > 1) {
    run_seeds(study, output, arguments, options, session);
    return;
  }
  const auto progress = make_progress(arguments.common);
  const RunEnd end = end_of_run([&] { return run_one(study, output, arguments, options, session, *progress); });
  progress->finish();
  print_end(end, study, output, arguments.common, session);
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  const auto [command, arguments] =
      add_command<RunArguments>(app, "run", "Runs a study and writes its study file.",
                                "Example: pkmopt run experiments/4ppa-2par/paper-problem.toml --threads 2",
                                [&session](const RunArguments& given) { run(given, session); });
  add_option(command, "study STUDY.toml", arguments.study, "The study, a TOML file")->required();
  add_option(command, "-o,--output F.h5", arguments.output,
             "The study file (default: as the study says, else its stem + .h5)");
  command.add_flag("--resume", arguments.resume, "Go on with the study file if it exists");
  command.add_flag("--force", arguments.force, "Overwrite the study file if it exists")->excludes("--resume");
  add_integer(command, "--seed N", arguments.seed, 0, std::numeric_limits<std::int64_t>::max(),
              "Seed, instead of the study's own");
  add_integer(command, "--seeds N", arguments.seeds, 1, 100'000,
              "Repeat the study over N seeds, a file each, and print the spread");
  add_change_options(command, arguments.changes);
  add_running_options(command, arguments.common);
}

}  // namespace pkm
