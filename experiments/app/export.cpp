// `pkmopt export`: writes the results of a study for other programs, as CSV tables, as workspace files (VTK, STL) and
// as models for simulation (URDF, SDF, MJCF).

#include <filesystem>
#include <iostream>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/export/study_tables.hpp"
#include "engine/mechanism/sampled_poses.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/storage/study_file.hpp"
#include "experiments/app/model_files.hpp"
#include "experiments/app/next_step.hpp"
#include "experiments/app/recorded_study.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/slices.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct ExportArguments : DesignArguments, WorkspaceOutputs {
  std::string csv;
  ModelFiles model;
  std::vector<std::string> at;
  int threads = 0;
};

/// The pose that --at gives or, without --at, a pose in the middle of the workspace.
Pose<double> reference_pose(const Target& target, const std::string& mode, const ExportArguments& arguments) {
  if (!arguments.at.empty()) {
    MotionArguments motion;
    motion.at = arguments.at;
    return parse_motion(*target.mechanism, motion).pose;
  }
  if (const auto pose = central_pose(*target.mechanism, target.parameters, target.limits, mode)) return *pose;
  throw ConfigError({"", 0, "--at"}, "no pose, and no feasible pose of the design was found",
                    "the reference pose of the model");
}

/// Path of the file to which a table is written in a folder.
std::string path_of(const std::string& folder, const NamedTable& table) {
  return (std::filesystem::path(folder) / table.file_name).string();
}

void export_study(const Session& session, const ExportArguments& arguments) {
  expect_study_file(arguments.from, "workspace", session);
  const bool of_design = arguments.any() || arguments.model.any();
  if (!of_design && arguments.csv.empty())
    throw ConfigError({"", 0, "export"}, "no output", "at least one of --vtk, --csv, --stl, --urdf, --sdf, --mjcf");
  if (const char* const option = first_given_option(arguments.choice); option && !of_design)
    throw ConfigError({"", 0, option},
                      "selects a design for --vtk, --stl, --urdf, --sdf or --mjcf; the tables of --csv contain all "
                      "designs");
  if (!arguments.at.empty() && !arguments.model.any())
    throw ConfigError({"", 0, "--at"}, "is the reference pose of --urdf, --sdf or --mjcf, none of which is given");

  const StudyContents contents = read_study(arguments.from);
  std::vector<std::string> files;
  std::vector<NamedTable> tables;
  if (!arguments.csv.empty()) tables = study_tables(contents);
  for (const NamedTable& table : tables) files.push_back(path_of(arguments.csv, table));
  std::optional<Target> target;
  std::vector<std::pair<std::string, std::string>> models;
  if (of_design) target = find_target(session, arguments);
  if (arguments.model.any()) {
    const std::string& mode = target->study->problem->parts().request.mode;
    models = model_texts(arguments.model, *target, mode, reference_pose(*target, mode, arguments),
                         target->info().name + ", " + target->words + " of study " + target->study->name);
    for (const auto& [file, text] : models) files.push_back(file);
  }
  if (arguments.any()) {
    check_cell_count(target->plan());
    expect_surface(arguments, names_of(swept_axes(target->plan(), target->info(), {})));
    const auto more = output_files(arguments, *target);
    files.insert(files.end(), more.begin(), more.end());
  }
  std::string reason;
  if (!target && !find_recorded_study(contents, arguments.from, session, reason)) {
    const StorageError note(arguments.from + ": this program cannot read the study's text (" + reason + ")");
    std::cerr << session.program << ": note: " << note.what() << '\n';
  }
  const Existing existing = if_forced(arguments.force);
  check_outputs(files, {arguments.from}, existing);

  if (!tables.empty()) create_folder(arguments.csv);
  for (const NamedTable& table : tables) write_file(path_of(arguments.csv, table), table.table.text(), existing);
  for (const auto& [file, text] : models) write_file(file, text, existing);
  if (arguments.any())
    with_team(arguments.threads, [&] {
      // The working mode that the objectives of the study use.
      const std::string& mode = target->study->problem->parts().request.mode;
      write_workspace(arguments, *target, compute_fields(*target, target->plan(), mode));
    });
  if (contents.state != StudyState::finished)
    std::cout << "the study is " << words(contents.state) << ": only the results recorded so far are exported\n";
  if (target) std::cout << (arguments.any() ? "workspace of " : "model of ") << target->words << '\n';
  for (const std::string& file : files) std::cout << "wrote " << file << '\n';
}

}  // namespace

void add_export(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<ExportArguments>(
      app, "export", "Write the results of a study as tables and as files for ParaView, CAD and simulation.",
      "The workspace is computed again with the settings of the study, for the best design (of a Pareto front, the\n"
      "compromise solution) unless another design is selected. 'pkmopt workspace --from F.h5' uses other cells.\n"
      "Example: pkmopt export paper-problem.h5 --vtk best.vtkhdf --csv tables --stl .",
      [&session](const ExportArguments& given) { export_study(session, given); });
  add_option(command, "file F.h5", arguments.from, "Study file")->required();
  add_workspace_outputs(command, arguments);
  add_option(command, "--csv DIR", arguments.csv, "Write all tables of the study into this folder");
  std::vector<std::pair<std::string, std::string*>> extensions = {{".stl", &arguments.stl},
                                                                  {".vtkhdf", &arguments.vtk}};
  const auto models = extensions_of(arguments.model);
  extensions.insert(extensions.end(), models.begin(), models.end());
  add_output_by_extension(command, extensions);
  add_model_options(command, arguments.model);
  add_list_option(command, "--at", arguments.at,
                  "Reference pose of the model, all coordinates; default: in the middle of the workspace");
  add_choice_options(command, arguments.choice);
  add_threads(command, arguments.threads);
}

}  // namespace pkm
