// `pkmopt report`: writes the results of studies as one HTML page.

#include "experiments/app/report.hpp"

#include <filesystem>
#include <iostream>

#include "engine/core/team.hpp"
#include "engine/report/html_page.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/recorded_study.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/task_robots.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct ReportArguments {
  std::vector<std::string> files;
  std::string output, task;
  bool force = false;
  int threads = 0;
};

PageStudy page_study(const std::string& file, const Session& session) {
  PageStudy page{std::filesystem::path(file).filename().string(), read_study(file), {}};
  page.study = find_recorded_study(page.contents, file, session, page.unreadable);
  if (!page.study) {
    const StorageError note(file + ": this program cannot read the study's text; panels that require new evaluations " +
                            "are omitted (" + page.unreadable + ")");
    std::cerr << session.program << ": note: " << note.what() << '\n';
  }
  return page;
}

void report(const ReportArguments& arguments, const Session& session) {
  for (const std::string& file : arguments.files) expect_study_file(file, "run", session);
  const std::string output =
      arguments.output.empty() ? std::filesystem::path(arguments.files[0]).stem().string() + ".html" : arguments.output;
  page_assets();  // throws std::runtime_error here, before any evaluation, if this build does not contain the page
  std::vector<PageStudy> studies;
  for (const std::string& file : arguments.files) studies.push_back(page_study(file, session));
  std::vector<std::string> inputs = arguments.files;
  if (!arguments.task.empty()) inputs.push_back(arguments.task);
  check_outputs({output}, inputs, if_forced(arguments.force));
  std::optional<Task> task;
  std::vector<TaskRobot> robots;
  if (!arguments.task.empty()) {
    task = load_task_toml(arguments.task);
    robots = find_task_robots(session, arguments.files);
  }
  const SlowStepNotice slow = announce_slow_step(session, "evaluating the data of the page");
  std::string page;
  with_team(arguments.threads, [&] {
    std::optional<TaskComparison> comparison;
    if (task) comparison = compare_in_task(*task, robots, session.catalogues);
    page = html_page(page_data(studies, program_words(), comparison ? &*comparison : nullptr));
  });
  write_file(output, page, if_forced(arguments.force));
  std::cout << output << ": " << formatted("%.1f MB", 1e-6 * static_cast<double>(page.size())) << '\n';
}

}  // namespace

std::string report_file_beside(const std::string& study_file) {
  return std::filesystem::path(study_file).replace_extension(".html").string();
}

std::string write_report_beside(const std::string& study_file, int threads, const Session& session) {
  page_assets();  // throws if this build does not contain the page
  std::vector<PageStudy> studies;
  studies.push_back(page_study(study_file, session));
  std::string page;
  with_team(threads, [&] { page = html_page(page_data(studies, program_words(), nullptr)); });
  write_file(report_file_beside(study_file), page, Existing::replaced);
  return report_file_beside(study_file);
}

void add_report(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ReportArguments>(
      app, "report", "Write the results of studies as one HTML page with plots.",
      "The page opens from disk and needs no network. Data that a study file does not contain are evaluated again.\n"
      "Example: pkmopt report paper-problem.h5",
      [&session](const ReportArguments& given) { report(given, session); });
  add_option(command, "files F.h5", arguments.files, "Study files; several are also compared")->required();
  add_option(command, "--task TASK.toml", arguments.task, "Also compare the best designs in this task");
  add_option(command, "-o,--output R.html", arguments.output, "Page to write (default: first file's stem + .html)");
  command.add_flag("--force", arguments.force, "Overwrite the page if it exists");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
