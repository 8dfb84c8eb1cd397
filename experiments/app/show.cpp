// `pkmopt show`: prints the results of a study from its file.

#include <iostream>

#include "engine/results/comparison.hpp"
#include "engine/runner/progress.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/storage/study_lock.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/recorded_study.hpp"
#include "experiments/app/summary.hpp"

namespace pkm {
namespace {

/// Text of a table with about ten equally spaced generations of each stage.
std::string history(const StudyContents& contents) {
  std::string text;
  for (const StageRecord& stage : contents.stages) {
    const auto& list = stage.generations;
    if (list.size() == 0 || contents.problem.objectives.empty()) continue;
    const bool front = stage.front && stage.front->hypervolume.size() == list.size();
    // Multistart runs that start from a front have a table of their own.
    if (contents.problem.objectives.size() > 1 && !front) continue;
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
        best = result_text(stage.table.objective_row(static_cast<std::size_t>(list.best_row[g]))[0],
                           contents.problem.objectives[0].unit);
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

/// Describes the state of a study that is not finished. A study whose process was killed is still recorded as running;
/// it is running only while a process holds its lock, otherwise its state is changed to interrupted.
std::string describe_state(StudyContents& contents, const ShowArguments& arguments, const Session& session) {
  if (contents.state == StudyState::finished) return "";
  const auto holder = StudyLock::holder(arguments.file);
  if (contents.state == StudyState::running && holder) return "the study is being run by " + *holder + '\n';
  contents.state = StudyState::interrupted;
  return "study interrupted; resume with: " + command_text(session, {"resume", file_argument(arguments.file)}) + '\n';
}

/// Prints the results of a study. If this program cannot read the study's text, published references and some reasons
/// of a diagnosis are omitted.
void show(const ShowArguments& arguments, const Session& session) {
  expect_study_file(arguments.file, "check", session);
  StudyContents contents = read_study(arguments.file);
  const std::string state = describe_state(contents, arguments, session);
  std::string why;
  const auto found = find_recorded_study(contents, arguments.file, session, why);
  const std::string note =
      found ? "" : "note: this program cannot read the study's text, so references are omitted (" + why + ")\n";
  const Study study = found.value_or(Study());
  const auto diagnosis = diagnose(contents, study.problem.get());
  if (arguments.json)
    print_json(summary_json(contents, diagnosis, collect_failures(contents, study.problem.get())));
  else
    std::cout << summary_text(contents, study, diagnosis) << history(contents) << note << state;
}

}  // namespace

void add_show(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ShowArguments>(
      app, "show", "Show the results of a study: best design, margins and a short history.",
      "Example: pkmopt show paper-problem.h5", [&session](const ShowArguments& given) { show(given, session); });
  add_option(command, "file F.h5", arguments.file, "The study file")->required();
  command.add_flag("--json", arguments.json, "Print one JSON object, numbers in full precision");
}

}  // namespace pkm
