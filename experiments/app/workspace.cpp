// `pkmopt workspace`: the workspace of one design, cell by cell, in short or as files for other programs.

#include <iostream>

#include <CLI/CLI.hpp>

#include "engine/core/team.hpp"
#include "engine/report/html_page.hpp"
#include "engine/report/page_parts.hpp"
#include "engine/report/workspace_export.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

constexpr double kMostCells = 1e7;

struct WorkspaceArguments : DesignArguments, ModeArguments, GridArguments, WorkspaceOutputs {
  std::vector<std::string> held;
  std::string csv, html;
  int threads = 0;
};

/// Holds the coordinates that --held names at their values. Others that the study holds stay as they are where its
/// sweep serves; where another does, the study's box and cells are of other axes.
void set_held(SurveyPlan& plan, const MechanismInfo& info, const std::vector<std::string>& lists) {
  const SourcePlace place{"", 0, "--held"};
  const auto values = parse_assignments(lists, place.key, assignable_coordinates(info));
  std::vector<int> known;
  std::size_t most = 0;
  for (const Sweep& sweep : info.sweeps) {
    most = std::max(most, sweep.held.size());
    for (const int held : sweep.held)
      if (std::ranges::find(known, held) == known.end()) known.push_back(held);
  }
  const auto name = [&info](int coordinate) { return info.coordinates[static_cast<std::size_t>(coordinate)].name; };
  std::vector<std::string> names;
  for (const int coordinate : known) names.push_back(name(coordinate));
  std::vector<HeldCoordinate> given;
  for (int i = 0; i < std::ssize(values); ++i) {
    const auto& value = values[static_cast<std::size_t>(i)];
    if (value && std::ranges::find(known, i) == known.end())
      throw ConfigError(place, name(i), "a coordinate that surveys can hold: " + join(names));
    if (value) given.push_back({i, HeldCoordinate::Kind::value, *value});
  }
  const auto serves = [&given](const Sweep& sweep) {
    return std::ranges::all_of(
        given, [&](const auto& held) { return std::ranges::find(sweep.held, held.coordinate) != sweep.held.end(); });
  };
  if (std::ranges::none_of(info.sweeps, serves))
    throw ConfigError(
        place, join(lists),
        most > 1 ? "coordinates that one survey can hold, with their values" : "one coordinate with its value");
  if (!serves(sweep_of(info, plan))) {
    plan.held.clear();
    plan.method = ColumnOptions();
  }
  for (const HeldCoordinate& held : plan.held)
    if (std::ranges::find(given, held.coordinate, &HeldCoordinate::coordinate) == given.end()) given.push_back(held);
  plan.held = given;
}

/// The voxels asked for: the study's limits, its plan where the command line says nothing.
SurveyPlan plan_of(const Target& target, const WorkspaceArguments& arguments) {
  SurveyPlan plan;
  if (target.study) plan = target.study->problem->parts().plan;
  plan.limits = target.limits;
  if (!arguments.held.empty()) set_held(plan, target.info(), arguments.held);
  set_grid(plan, target.info(), arguments, kPictureCells, kMostCells);
  return plan;
}

/// Least and greatest value of each axis at which a cell is feasible: the cells' outer faces. Absent: none is.
using Extents = std::optional<std::vector<std::array<double, 2>>>;

Extents extents_of(const WorkspaceFields& workspace) {
  Extents extents;
  const VoxelGrid grid = workspace.grid();
  const std::vector<double>& feasible = workspace.field("feasible").values;
  for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
    if (!(feasible[cell] > 0)) continue;
    const Pose<double> pose = workspace.pose(cell);
    const bool first = !extents;
    if (first) extents.emplace(workspace.axes.size());
    for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
      const double centre = pose[static_cast<std::size_t>(workspace.axes[i].coordinate)], half = grid.step[i] / 2;
      auto& [least, greatest] = (*extents)[i];
      least = first ? centre - half : std::min(least, centre - half);
      greatest = first ? centre + half : std::max(greatest, centre + half);
    }
  }
  return extents;
}

std::int64_t feasible_cells(const WorkspaceFields& workspace) {
  return std::ranges::count(workspace.field("feasible").values, 1.0);
}

Json workspace_json(const Target& target, const WorkspaceFields& workspace, const std::vector<std::string>& files) {
  const Extents extents = extents_of(workspace);
  Json held = Json::array();
  for (std::size_t i = 0; i < workspace.held.size(); ++i) {
    const WorkspaceAxis& axis = workspace.held[i];
    held.push_back({{"name", axis.name}, {"value", axis.lower}, {"unit", axis.unit}, {"why", workspace.held_note[i]}});
  }
  Json json = {{"mechanism", target.info().name},
               {"design", target.words},
               {"parameters", values_by_name(target.info().parameters, target.parameters)},
               {"held", held.size() == 1 ? held[0] : held},
               {"axes", Json::array()}};
  for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
    const WorkspaceAxis& axis = workspace.axes[i];
    json["axes"].push_back({{"name", axis.name},
                            {"unit", axis.unit},
                            {"lower", axis.lower},
                            {"upper", axis.upper},
                            {"cells", axis.cells},
                            {"feasible", extents ? Json((*extents)[i]) : Json()}});
  }
  json["cells"] = workspace.cells();
  json["feasible_cells"] = feasible_cells(workspace);
  json["volume"] = workspace.volume;
  json["unit"] = workspace.volume_unit;
  json["touches_box"] = workspace.touches_box;
  json["fields"] = Json::object();
  for (const WorkspaceField& field : workspace.fields) {
    const auto range = range_of(field);
    json["fields"][field.name] = {{"unit", field.unit},
                                  {"least", range ? Json(range->least) : Json()},
                                  {"greatest", range ? Json(range->greatest) : Json()},
                                  {"meaning", field.meaning}};
  }
  json["files"] = files;
  return json;
}

void print_workspace(const Target& target, const WorkspaceFields& workspace, const std::vector<std::string>& files) {
  const Extents extents = extents_of(workspace);
  std::vector<Row> head = {{"mechanism", target.info().name}};
  if (target.study) head.push_back({"study", target.study->name});
  head.push_back({"design", target.words});
  for (std::size_t i = 0; i < workspace.held.size(); ++i)
    head.push_back(
        {workspace.held[i].name, number(workspace.held[i].lower, workspace.held[i].unit), workspace.held_note[i]});
  head.push_back(
      {"feasible cells", std::to_string(feasible_cells(workspace)) + " of " + std::to_string(workspace.cells())});
  head.push_back({"volume", number(workspace.volume, workspace.volume_unit)});
  if (workspace.touches_box) head.push_back({"warning", "the feasible set touches the box: it may go on"});
  std::cout << aligned(head);

  std::vector<Row> axes, fields;
  for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
    const WorkspaceAxis& axis = workspace.axes[i];
    const auto range = [&](double lower, double upper) {
      return number(lower, axis.unit) + " .. " + number(upper, axis.unit);
    };
    axes.push_back({axis.name, extents ? range((*extents)[i][0], (*extents)[i][1]) : "none",
                    "of " + range(axis.lower, axis.upper), std::to_string(axis.cells) + " cells"});
  }
  for (const WorkspaceField& field : workspace.fields)
    if (const auto range = range_of(field); range && field.name != "feasible")
      fields.push_back(
          {field.name, number(range->least, field.unit), number(range->greatest, field.unit), field.meaning});
  print_section(std::cout, "extent of the feasible cells", axes);
  print_section(std::cout, "fields (least and greatest value)", fields);
  for (const std::string& file : files) std::cout << "wrote " << file << '\n';
}

int workspace(const Catalogues& catalogues, const WorkspaceArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  std::vector<std::string> files = files_of(arguments, target);
  for (const std::string& file : {arguments.csv, arguments.html})
    if (!file.empty()) files.push_back(file);
  refuse_existing(files, arguments.force);
  if (!arguments.html.empty()) page_parts();  // or say at once that there are none
  with_team(arguments.threads, [&] {
    const SurveyPlan plan = plan_of(target, arguments);
    const std::string mode = known_mode(target.info(), arguments);
    const WorkspaceFields found = fields_of(target, plan, mode);
    write_workspace(arguments, target, found);
    if (!arguments.csv.empty()) replace_file(arguments.csv, workspace_table(found).text());
    if (!arguments.html.empty()) {
      const auto motions = target.study ? target.study->motions : std::vector<NamedMotion>();
      const Views views = views_of(*target.mechanism, plan, mode, motions, {target.words, target.parameters});
      replace_file(arguments.html, html_page(page_data(views, program_words())));
    }
    if (arguments.json)
      print_json(std::cout, workspace_json(target, found, files));
    else
      print_workspace(target, found, files);
  });
  return kDone;
}

}  // namespace

void add_workspace(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<WorkspaceArguments>();
  CLI::App* command = app.add_subcommand("workspace", "The workspace of one design, for ParaView, tables and CAD.");
  add_design_arguments(*command, *arguments);
  add_grid_options(*command, *arguments, kPictureCells);
  add_list_option(*command, "--held", arguments->held,
                  "Coordinates that are not swept; default: the study's, else the design's middle", false);
  command->add_option("--mode", arguments->mode, "Working mode of the coupling indices; default: the first")
      ->type_name("MODE");
  add_workspace_outputs(*command, *arguments);
  command->add_option("--csv", arguments->csv, "Write a row per cell to this file")->type_name("FILE");
  command->add_option("--html", arguments->html, "Write a page with plots of the design to this file")
      ->type_name("FILE");
  add_threads(*command, arguments->threads);
  command->footer(
      "Cells count where their centre is feasible under the study's limits; a bare mechanism has none. Files are in "
      "SI:\n"
      "an axis of angles is in rad beside others in m.\n"
      "Example: pkmopt workspace 3crr-r-cru --held phi=30deg --vtk phi-30.vtkhdf");
  command->callback([&session, arguments] { session.exit_code = workspace(session.catalogues, *arguments); });
}

}  // namespace pkm
