// `pkmopt export`: what a study found, for other programs.

#include <filesystem>
#include <iostream>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/report/study_tables.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/recorded_study.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/slices.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct ExportArguments : DesignArguments, WorkspaceOutputs {
  std::string csv;
  int threads = 0;
};

std::string path_of(const std::string& folder, const NamedTable& table) {
  return (std::filesystem::path(folder) / table.file_name).string();
}

void export_study(const Session& session, const ExportArguments& arguments) {
  expect_study_file(arguments.from, "workspace", session);
  if (!arguments.any() && arguments.csv.empty())
    throw ConfigError({"", 0, "export"}, "nothing to write", "at least one of --vtk, --csv, --stl");
  if (const char* const option = given_option(arguments.choice); option && !arguments.any())
    throw ConfigError({"", 0, option}, "tables only, which are of all designs", "--vtk or --stl beside it");

  const StudyContents contents = read_study(arguments.from);
  std::vector<std::string> files;
  std::vector<NamedTable> tables;
  if (!arguments.csv.empty()) tables = study_tables(contents);
  for (const NamedTable& table : tables) files.push_back(path_of(arguments.csv, table));
  std::optional<Target> target;
  if (arguments.any()) {
    target = find_target(session, arguments);
    expect_few_cells(target->plan());
    expect_surface(arguments, names_of(swept_axes(target->plan(), target->info(), {})));
    const auto more = files_of(arguments, *target);
    files.insert(files.end(), more.begin(), more.end());
  }
  std::string why;
  if (!target && !find_recorded_study(contents, arguments.from, session, why)) {
    const StorageError note(arguments.from + ": this program cannot read the study's text (" + why + ")");
    std::cerr << session.program << ": note: " << note.what() << '\n';
  }
  const Existing existing = if_forced(arguments.force);
  check_outputs(files, {arguments.from}, existing);

  if (!tables.empty()) make_folder(arguments.csv);
  for (const NamedTable& table : tables) write_file(path_of(arguments.csv, table), table.table.text(), existing);
  if (target)
    with_team(arguments.threads, [&] {
      const std::string& mode = target->study->problem->parts().demand.mode;  // of the indices that it asks for
      write_workspace(arguments, *target, fields_of(*target, target->plan(), mode));
    });
  if (contents.state != StudyState::finished)
    std::cout << "the study is " << words(contents.state) << ": what it has recorded is exported\n";
  if (target) std::cout << "workspace of " << target->words << '\n';
  for (const std::string& file : files) std::cout << "wrote " << file << '\n';
}

}  // namespace

void add_export(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ExportArguments>(
      app, "export", "What a study found, as tables and as files for ParaView and CAD.",
      "The workspace is evaluated anew, as the study in the file says, for the best design (of a trade-off the\n"
      "compromise) unless another is named. 'pkmopt workspace --from F.h5' does so on other cells.\n"
      "Example: pkmopt export paper-problem.h5 --vtk best.vtkhdf --csv tables --stl .",
      [&session](const ExportArguments& given) { export_study(session, given); });
  add_option(command, "file F.h5", arguments.from, "The study file")->required();
  add_workspace_outputs(command, arguments);
  add_option(command, "--csv DIR", arguments.csv, "Write the study's tables into this folder");
  add_output_by_ending(command, {{".stl", &arguments.stl}, {".vtkhdf", &arguments.vtk}});
  add_choice_options(command, arguments.choice);
  add_threads(command, arguments.threads);
}

}  // namespace pkm
