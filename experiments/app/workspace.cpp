// `pkmopt workspace`: the workspace of one design, cell by cell, in short or as files for other programs.

#include <numbers>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/math/rounding.hpp"
#include "engine/problem/no_conditioning.hpp"
#include "engine/report/html_page.hpp"
#include "engine/report/workspace_export.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/cube.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/picture.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/section.hpp"
#include "experiments/app/slices.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct WorkspaceArguments : DesignArguments, ModeArguments, GridArguments, WorkspaceOutputs, CubeArguments {
  std::vector<std::string> held, cut;
  std::string csv, html, svg, png;
  int threads = 0;

  /// The option that asks for a picture of a slice; "": none does.
  std::string picture() const { return !svg.empty() ? "--svg" : !png.empty() ? "--png" : ""; }
};

/// Feasible cells lie at an end of a range that is given.
bool touches(const WorkspaceFields& workspace, const std::array<bool, 3>& ranges_given) {
  const VoxelGrid grid = workspace.grid();
  for (const std::size_t cell : workspace.feasible_cells()) {
    auto rest = static_cast<std::int64_t>(cell);
    for (std::size_t i = 3; i-- > 0; rest /= grid.cells[i]) {
      const std::int64_t k = rest % grid.cells[i];
      if (i < workspace.axes.size() && ranges_given[i] && (k == 0 || k == grid.cells[i] - 1)) return true;
    }
  }
  return false;
}

/// Throws ConfigError where what is asked for is of a workspace over other coordinates than those that are swept.
void expect_axes(const Axes& swept, const WorkspaceArguments& arguments) {
  const std::vector<std::string> names = names_of(swept);
  if (const std::string option = arguments.picture(); !option.empty() && names.size() != 2)
    throw ConfigError({"", 0, option}, "a workspace over " + join(names),
                      names.size() > 2 ? "a slice of it, such as that of --cut " + names.back() + "=0"
                                       : "a workspace over two coordinates");
  expect_lengths(swept, arguments);
  expect_surface(arguments, names);
}

/// A picture of a workspace over two coordinates.
Picture section_picture(const Target& target, const WorkspaceFields& workspace, Printout& out) {
  const Section section = section_of(workspace, PoseMargin(*target.mechanism, target.parameters, target.limits));
  const std::string& unit = workspace.volume_unit;
  out.say("area", section.area, number(section.area, unit) + ", within the outline that is drawn");
  std::vector<std::string> held;
  for (const WorkspaceAxis& axis : workspace.held)
    held.push_back(axis.name + " = " +
                   (axis.unit == "rad" ? formatted("%.6g deg", axis.lower * 180 / std::numbers::pi)
                                       : formatted("%.6g mm", 1e3 * axis.lower)));
  std::vector<std::string> lines = {title_of(target), "area " + formatted("%.4g", section.area) + " " + unit};
  if (!held.empty()) lines.insert(lines.begin() + 1, join(held));
  return picture_of(section, lines);
}

/// Least and greatest value of each axis at which a cell is feasible: the cells' outer faces. Absent: none is.
using Extents = std::optional<std::vector<std::array<double, 2>>>;

Extents extents_of(const WorkspaceFields& workspace) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extents extents;
  const VoxelGrid grid = workspace.grid();
  const std::vector<double>& feasible = workspace.field("feasible").values;
  for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
    if (!(feasible[cell] > 0)) continue;
    if (!extents) extents.emplace(workspace.axes.size(), std::array{kInfinity, -kInfinity});
    const Pose<double> pose = workspace.pose(cell);
    for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
      const double centre = pose[static_cast<std::size_t>(workspace.axes[i].coordinate)], half = grid.step[i] / 2;
      auto& [least, greatest] = (*extents)[i];
      least = std::min(least, centre - half);
      greatest = std::max(greatest, centre + half);
    }
  }
  return extents;
}

void tell_workspace(const Target& target, const WorkspaceFields& workspace, Printout& out) {
  Json& json = out.json;
  out.say("mechanism", target.info().name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.say("design", target.words);
  json["parameters"] = values_by_name(target.info().parameters, target.parameters);
  json["held"] = Json::array();
  for (std::size_t i = 0; i < workspace.held.size(); ++i) {
    const auto& [coordinate, name, unit, value, upper, cells] = workspace.held[i];
    const std::string& why = workspace.held_note[i];
    json["held"].push_back({{"name", name}, {"value", value}, {"unit", unit}, {"why", why}});
    out.head.push_back({name, position(value, unit), why});
    if (const std::string note = turns_note({{name, unit}}, {&value, 1}); !note.empty())
      out.head.push_back({"note", note});
  }

  std::vector<Row> rows;
  const Extents extents = extents_of(workspace);
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
    const WorkspaceAxis& axis = workspace.axes[i];
    const double size = std::max(std::fabs(axis.lower), std::fabs(axis.upper));
    const std::array whole = {beyond_rounding(axis.lower, size), beyond_rounding(axis.upper, size)};
    std::array feasible = whole;
    if (extents)
      std::ranges::transform((*extents)[i], feasible.begin(), [&](double end) { return beyond_rounding(end, size); });
    const auto range = [&axis](const std::array<double, 2>& ends) {
      return position(ends[0], axis.unit) + " .. " + position(ends[1], axis.unit);
    };
    json["axes"].push_back({{"name", axis.name},
                            {"unit", axis.unit},
                            {"lower", whole[0]},
                            {"upper", whole[1]},
                            {"cells", axis.cells},
                            {"feasible", extents ? Json(feasible) : Json()}});
    rows.push_back(
        {axis.name, extents ? range(feasible) : "none", "of " + range(whole), std::to_string(axis.cells) + " cells"});
  }
  out.section("extent of the feasible cells", rows);

  const auto feasible = std::ranges::count(workspace.field("feasible").values, 1.0);
  json["cells"] = workspace.cells();
  json["feasible_cells"] = feasible;
  json["volume"] = workspace.volume;
  json["unit"] = workspace.volume_unit;
  json["touches_box"] = workspace.touches_box;
  out.head.push_back({"feasible cells", std::to_string(feasible) + " of " + std::to_string(workspace.cells())});
  out.head.push_back({"volume", number(workspace.volume, workspace.volume_unit)});
  if (workspace.touches_box) out.head.push_back({"warning", "the feasible set touches the box: it may go on"});

  rows.clear();
  const Refusal undefined = no_conditioning(target.info());
  for (const WorkspaceField& field : workspace.fields) {
    const auto range = range_of(field);
    json["fields"][field.name] = {{"unit", field.unit},
                                  {"least", range ? Json(range->least) : Json()},
                                  {"greatest", range ? Json(range->greatest) : Json()},
                                  {"meaning", field.meaning}};
    if (undefined && field.name == kConditioning.name) {
      json["fields"][field.name]["unavailable"] = *undefined;
      rows.push_back({field.name, "none", "", *undefined});
    }
    const std::string unit = field.unit == "mixed" ? "1" : field.unit;  // the meaning has the units
    if (range && field.name != "feasible")
      rows.push_back({field.name, position(range->least, unit), position(range->greatest, unit), field.meaning});
  }
  out.section("fields (least and greatest value)", rows);
}

std::string workspace(const Target& target, const WorkspaceArguments& arguments, Printout& out) {
  std::vector<std::string> files = files_of(arguments, target);
  for (const std::string& file : {arguments.csv, arguments.html, arguments.svg, arguments.png})
    if (!file.empty()) files.push_back(file);
  const Existing existing = if_forced(arguments.force);
  if (!arguments.html.empty()) page_parts();  // or say at once that there are none
  with_team(arguments.threads, [&] {
    SurveyPlan plan = target.plan();
    Slices slices;
    if (!arguments.held.empty()) slices = set_held(plan, target.info(), arguments.held);
    add_cuts(slices, plan, target.info(), arguments.cut);
    if (!slices.empty() && !arguments.html.empty())
      throw ConfigError({"", 0, "--html"}, "a slice of a workspace", "a whole one; --svg and --png draw slices");
    auto ranges_given = set_grid(plan, target, arguments, kPictureCells, kMostCells);
    expect_axes(swept_axes(plan, target.info(), slices), arguments);
    cut(plan, target, slices, ranges_given);
    const std::string mode = known_mode(target.info(), arguments);
    check_outputs(files, target.files, existing);
    WorkspaceFields found = fields_of(target, plan, mode);
    found.touches_box = touches(found, ranges_given);
    flatten(found, target.info(), slices);
    expect_fields(found, target.info(), arguments);
    write_workspace(arguments, target, found);
    if (!arguments.csv.empty()) write_file(arguments.csv, workspace_table(found).text(), existing);
    if (!arguments.html.empty()) {
      const auto motions = target.study ? target.study->motions : std::vector<NamedMotion>();
      const Views views = views_of(*target.mechanism, plan, mode, motions, {target.words, target.parameters});
      write_file(arguments.html, html_page(page_data(views, program_words())), existing);
    }
    tell_workspace(target, found, out);
    tell_cube(found, arguments, out);
    if (arguments.picture().empty()) return;
    const Picture picture = section_picture(target, found, out);
    if (!arguments.svg.empty()) write_file(arguments.svg, svg_file(picture), existing);
    if (!arguments.png.empty()) write_file(arguments.png, png_file(picture), existing);
  });
  out.json["files"] = files;
  for (const std::string& file : files) out.text += "wrote " + file + '\n';
  return "";
}

}  // namespace

void add_workspace(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<WorkspaceArguments>(
      app, session, "workspace", "The workspace of one design, for ParaView, tables and CAD.",
      "Cells count where their centre is feasible under the study's limits; a bare mechanism has none. Files are in "
      "SI:\n"
      "an axis of angles is in rad beside others in m.\n"
      "Example: pkmopt workspace 4ppa-2par --cut theta=20deg -o section.svg",
      workspace);
  add_grid_options(command, arguments, kPictureCells);
  add_list_option(command, "--held", arguments.held,
                  "Coordinates that are not swept; default: the study's, else the design's middle");
  add_list_option(command, "--cut", arguments.cut, "Swept coordinates of which only this slice is looked at");
  add_option(command, "--mode MODE", arguments.mode, "Working mode of the coupling indices; default: the first");
  add_workspace_outputs(command, arguments);
  add_option(command, "--csv FILE", arguments.csv, "Write a row per cell to this file");
  add_option(command, "--html FILE", arguments.html, "Write a page with plots of the design to this file");
  add_option(command, "--svg FILE", arguments.svg,
             "Draw a workspace over two coordinates, such as a slice, to this file");
  add_option(command, "--png FILE", arguments.png, "The same picture as dots");
  add_output_by_ending(command, {{".csv", &arguments.csv},
                                 {".html", &arguments.html},
                                 {".png", &arguments.png},
                                 {".stl", &arguments.stl},
                                 {".svg", &arguments.svg},
                                 {".vtkhdf", &arguments.vtk}});
  add_cube_options(command, arguments);
  add_threads(command, arguments.threads);
}

}  // namespace pkm
