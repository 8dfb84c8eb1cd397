// `pkmopt run --seeds`: repeats a study with several seeds and prints the spread of the results.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "engine/core/printable.hpp"
#include "engine/results/comparison.hpp"
#include "engine/results/front_points.hpp"
#include "engine/runner/stop_request.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/run.hpp"
#include "experiments/app/summary.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxCompared = 4;  // maximum number of study files in the suggested report command

std::string seed_file(const std::string& output, std::uint64_t seed) {
  const std::filesystem::path path(output);
  return (path.parent_path() / (path.stem().string() + "-seed-" + std::to_string(seed) + path.extension().string()))
      .string();
}

/// Progress display that adds the number of the current seed to the reports.
class SeedProgress final : public Progress {
 public:
  SeedProgress(Progress& screen, int seeds) : screen_(screen), seeds_(seeds) {}
  void next() { ++seed_; }
  void generation(const ProgressReport& report) override {
    ProgressReport named = report;
    named.optimiser = "seed " + std::to_string(seed_) + " of " + std::to_string(seeds_) + ", " + report.optimiser;
    screen_.generation(named);
  }
  void step(const std::string& what) override { screen_.step("seed " + std::to_string(seed_) + ", " + what); }

 private:
  Progress& screen_;
  int seeds_, seed_ = 0;
};

/// Results of all seeds: one table row for each, and the values from which the spread is computed.
struct SeedTable {
  bool pareto;       ///< true: there are several objectives, and the seeds are compared by their hypervolumes
  std::string unit;  ///< unit of the first objective
  int feasible_seeds = 0;
  std::vector<Row> rows = {{"seed", pareto ? "hypervolume" : "best", "exact", "evaluations", "time", "file"}};
  std::vector<double> best = {}, exact = {}, seconds = {};
  std::string note = {};  ///< note of the first seed that has a note
  /// Diagnosis of the first seed that found no feasible design; std::nullopt: all seeds found one.
  std::optional<Diagnosis> diagnosis = {};
  std::vector<Json> summaries = {};      ///< results of the seeds, for --json
  std::vector<std::string> errors = {};  ///< messages on exact volumes that contradict their certified bounds

  void add(const Study& study, const StudyContents& contents, const std::string& file) {
    const FinalRecord final = contents.final.value_or(FinalRecord());
    const auto objective = [](const std::optional<DesignRecord>& record) -> std::optional<double> {
      if (!record || record->objectives.empty() || std::isnan(record->objectives[0])) return {};
      return record->objectives[0];
    };
    const auto nothing = diagnose(contents, study.problem.get());
    if (!diagnosis) diagnosis = nothing;
    const bool feasible = !nothing && objective(final.best) && final.best->status == Status::feasible;
    feasible_seeds += feasible;
    const auto keep = [this, feasible](std::optional<double> value, std::vector<double>& all) -> std::string {
      if (!feasible || !value) return "";
      all.push_back(*value);
      return pareto ? digits(*value) : result_text(*value, unit);
    };
    const auto value = pareto ? evolved_hypervolume(study, contents) : objective(final.best);
    for (const std::string& sentence : contradicted(contents))
      errors.push_back("seed " + std::to_string(contents.seed) + ": " + sentence);
    const bool fails = final.best && final.best->certified && final.best->status == Status::failed;
    const std::string best_text = feasible ? keep(value, best)
                                  : fails  ? "outside certified bounds"
                                           : "nothing feasible";
    seconds.push_back(contents.seconds);
    summaries.push_back(summary_json(contents, nothing, collect_failures(contents, study.problem.get())));
    summaries.back()["file"] = file;
    if (note.empty() && !contents.notes.empty())
      note = "note of seed " + std::to_string(contents.seed) + ": " + printable(join(contents.notes, "; ")) + '\n';
    rows.push_back({std::to_string(contents.seed), best_text, pareto ? "" : keep(objective(final.best_exact), exact),
                    std::to_string(contents.evaluations()), duration_text(contents.seconds), file});
  }

  void add_spread() {
    const auto row = [&](const char* name, const auto& pick) {
      const auto of = [&](std::vector<double> values, const auto& text) {
        std::ranges::sort(values);
        return values.empty() ? std::string() : text(pick(values));
      };
      const auto text = [this](double value) { return pareto ? digits(value) : result_text(value, unit); };
      rows.push_back({name, of(best, text), of(exact, text), "", of(seconds, duration_text), ""});
    };
    row("minimum", [](const std::vector<double>& v) { return v.front(); });
    row("median", [](const std::vector<double>& v) { return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]); });
    row("maximum", [](const std::vector<double>& v) { return v.back(); });
  }
};

/// Throws ConfigError or StorageError if the study file of a seed would overwrite a file that must not be overwritten.
void check_files(const std::vector<std::string>& files, const Study& study, const RunArguments& arguments) {
  for (const std::string& file : files) {
    check_outputs({file}, input_files(study), Existing::replaced);
    if (!arguments.force && !arguments.resume && exists(file))
      throw StorageError(file + " exists already; resume it with --resume, or overwrite it with --force");
  }
}

void print_diagnosis(const SeedTable& table, const RunArguments& arguments, Session& session) {
  if (!arguments.common.quiet && !arguments.common.json)
    std::cout << "diagnosis: " << table.diagnosis->finding << ": " << table.diagnosis->sentence << '\n'
              << reasons_text(table.diagnosis->reasons);
  report_diagnosis(table.diagnosis, arguments.common, session);
}

/// Prints a suggestion for the next command: a report or, after a stop, the command that continues with the remaining
/// seeds.
void print_next_step(const std::string& output, std::uint64_t first, const std::vector<std::string>& files,
                     const RunArguments& arguments, const Session& session) {
  if (session.exit_code == kStoppedEarly) {
    std::cout << "stopped, exit code " << kStoppedEarly << "; resume with: " << session.program << " run "
              << quoted(file_argument(arguments.study));
    for (const std::string& word : arguments.changes.arguments()) std::cout << ' ' << quoted(word);
    std::cout << " --seeds " << arguments.seeds << " --seed " << first << " --resume --output "
              << quoted(file_argument(output)) << '\n';
  } else if (!arguments.common.quiet) {
    std::vector<std::string> words = {"report"};
    for (std::size_t i = 0; i < std::min<std::size_t>(files.size(), kMaxCompared); ++i)
      words.push_back(file_argument(files[i]));
    std::cout << next_step(session, words);
  }
}

}  // namespace

void run_seeds(Study& study, const std::string& output, const RunArguments& arguments, RunOptions options,
               Session& session) {
  const StopRequest listen;  // one object for all seeds, so that a signal between the runs of two seeds is not lost
  const std::optional<double> time_limit = options.time_limit;  // limit of the total time of all seeds
  double seconds = 0;
  const std::uint64_t first = study.seed;
  if (first > std::numeric_limits<std::uint64_t>::max() - static_cast<std::uint64_t>(arguments.seeds))
    throw ConfigError({"", 0, "--seeds"}, "a first seed of " + std::to_string(first), "a last seed below 2^64");
  std::vector<std::string> files;
  for (int i = 0; i < arguments.seeds; ++i) files.push_back(seed_file(output, first + static_cast<std::uint64_t>(i)));
  check_files(files, study, arguments);

  SeedTable table{study.problem->objectives().size() > 1, study.problem->objectives()[0].unit};
  const auto screen = make_progress(arguments.common);
  SeedProgress progress(*screen, arguments.seeds);
  // The reason why the results of a seed are not in its file; std::nullopt: they are.
  std::optional<std::string> write_error;
  for (std::size_t i = 0; i < files.size() && session.exit_code == kDone; ++i) {
    study.seed = first + i;
    progress.next();
    if (time_limit) options.time_limit = *time_limit - seconds;
    RunEnd end;
    try {
      end = execute_run([&] { return run_one(study, files[i], arguments, options, session, progress); });
    } catch (const StorageError& failure) {
      if (table.seconds.empty()) throw;
      write_error = failure.what();
      break;
    }
    const RunOutcome& outcome = end.outcome;
    seconds += outcome.seconds;
    if (outcome.stopped.empty()) table.add(study, outcome.contents, end.write_error ? "not written" : files[i]);
    write_error = end.write_error;
    if (write_error) break;
    const bool last = i + 1 == files.size();
    if (!outcome.stopped.empty() || (StopRequest::signal() != 0 && !last)) session.exit_code = kStoppedEarly;
  }
  screen->finish();
  table.add_spread();
  if (arguments.common.json)
    print_json({{"name", study.name}, {"requested", arguments.seeds}, {"seeds", table.summaries}});
  else if (!arguments.common.quiet || write_error)
    std::cout << printable(study.name) << ", " << table.seconds.size() << " of " << arguments.seeds << " seeds\n"
              << aligned(table.rows) << table.feasible_seeds << " of " << table.seconds.size()
              << " seeds ended feasible\n"
              << table.note << std::flush;
  if (write_error) throw StorageError(*write_error);
  if (!table.errors.empty()) throw std::runtime_error(join(table.errors, "; "));
  if (session.exit_code == kDone && table.feasible_seeds == 0 && table.diagnosis)
    print_diagnosis(table, arguments, session);
  if (!arguments.common.json) print_next_step(output, first, files, arguments, session);
}

}  // namespace pkm
