// pkmopt show: what a study found, from its file.

#include <iostream>
#include <new>

#include "engine/report/standing.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"
#include "engine/study/progress.hpp"
#include "engine/study/records.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/summary.hpp"

namespace pkm {
namespace {

/// The history in brief: about ten generations of each stage.
std::string history(const StudyContents& contents) {
  std::string text;
  for (const StageRecord& stage : contents.stages) {
    const auto& list = stage.generations;
    if (list.size() == 0 || contents.problem.objectives.empty()) continue;
    const bool front = stage.front && stage.front->hypervolume.size() == list.size();
    if (contents.problem.objectives.size() > 1 && !front) continue;  // starts on a front have a table of their own
    std::vector<std::vector<std::string>> rows = {{"generation", "evaluations",
                                                   front ? "hypervolume" : contents.problem.objectives[0].name,
                                                   "feasible", "diversity", "time"}};
    if (front) rows[0].insert(rows[0].begin() + 3, "spread");
    const std::size_t step = std::max<std::size_t>(1, (list.size() - 1 + 9) / 10);
    for (std::size_t g = 0; g < list.size();
         g = g + step < list.size() || g == list.size() - 1 ? g + step : list.size() - 1) {
      const std::size_t rows_so_far =
          g + 1 < list.size() ? static_cast<std::size_t>(list.first_row[g + 1]) : stage.table.size();
      std::string best = "-";
      if (front)
        best = digits(stage.front->hypervolume[g]);
      else if (list.best_row[g] >= 0)
        best = digits(stage.table.objective_row(static_cast<std::size_t>(list.best_row[g]))[0]);
      rows.push_back({std::to_string(g), std::to_string(rows_so_far), best,
                      formatted("%.0f %%", 100 * list.feasible_share[g]), formatted("%.2g", list.diversity[g]),
                      duration_text(list.seconds[g])});
      if (front) rows.back().insert(rows.back().begin() + 3, formatted("%.2g", stage.front->spread[g]));
    }
    text += '\n' + stage.optimiser + '\n' + aligned(rows);
  }
  return text;
}

struct ShowArguments {
  std::string file;
  bool json = false;
};

/// A study that was killed left the word that it is running: it is, while a process holds its lock.
std::string standing(StudyContents& contents, const ShowArguments& arguments, const Session& session) {
  if (contents.state == StudyState::finished) return "";
  const auto holder = StudyLock::holder(arguments.file);
  if (contents.state == StudyState::running && holder) return *holder + " works on it\n";
  contents.state = StudyState::interrupted;
  return "it was interrupted; go on with: " + command_text(session, {"resume", arguments.file}) + '\n';
}

/// References are in the study's text only, and a verdict's reasons partly; a file whose text this program no longer
/// reads is shown without them.
void show(const ShowArguments& arguments, const Session& session) {
  expect_study_file(arguments.file, "check", session);
  StudyContents contents = read_study(arguments.file);
  const std::string state = standing(contents, arguments, session);
  Study study;
  std::string note;
  try {
    study = study_of(contents, session.catalogues);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    note = "note: this program cannot read the study's text, so references are left out (" + message_of(error) + ")\n";
  }
  const auto verdict = verdict_on(contents, study.problem.get());
  if (arguments.json)
    print_json(summary_json(contents, verdict, failures_in(contents, study.problem.get())));
  else
    std::cout << summary_text(contents, study, verdict) << history(contents) << note << state;
}

}  // namespace

void add_show(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ShowArguments>(
      app, "show", "Shows what a study found: best design, margins, history in brief.",
      "Example: pkmopt show paper-problem.h5", [&session](const ShowArguments& given) { show(given, session); });
  add_option(command, "file F.h5", arguments.file, "The study file")->required();
  command.add_flag("--json", arguments.json, "One JSON object, numbers in full precision");
}

}  // namespace pkm
