// `pkmopt workspace`: evaluates the workspace of one design on a voxel grid; prints a summary and writes files for
// other programs.

#include <filesystem>
#include <limits>
#include <optional>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/export/picture.hpp"
#include "engine/export/tables.hpp"
#include "engine/generic/exact_accuracy.hpp"
#include "engine/math/rounding.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/mechanism/orientations.hpp"
#include "engine/report/html_page.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/component_list.hpp"
#include "experiments/app/coordinate_ranges.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/largest_solid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/slices.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct WorkspaceArguments : DesignArguments, ModeArguments, GridArguments, WorkspaceOutputs, SolidArguments {
  bool ranges = false;
  std::vector<std::string> fixed, cut, fields, home;
  std::string csv, html, svg, png;
  int threads = 0;

  /// Name of the option that requests a picture; "" if none does.
  std::string picture() const { return !svg.empty() ? "--svg" : !png.empty() ? "--png" : ""; }
  /// Names of the picture files: a single one for the outline or for one field, otherwise one for each field.
  std::vector<std::string> pictures(const std::string& file) const {
    if (file.empty() || fields.size() < 2) return file.empty() ? std::vector<std::string>() : std::vector{file};
    const std::filesystem::path path = file;
    std::vector<std::string> names;
    for (const std::string& field : fields)
      names.push_back(path.parent_path() / (path.stem().string() + "-" + field + path.extension().string()));
    return names;
  }
};

/// Returns true if a feasible cell lies at an end of a range that the user has given.
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

/// Returns true if the fields are to be computed on a coarser grid, with kPictureCells cells along each axis: fields
/// cost up to 100 times as much as the test whether a pose is feasible, and without files they are not needed at every
/// cell.
bool needs_coarse_fields(const WorkspacePlan& plan, const std::vector<std::string>& files) {
  double cells = 1, picture_cells = 1;
  for (const std::int64_t n : plan.voxels()->cells) {
    cells *= static_cast<double>(n);
    picture_cells *= static_cast<double>(n > 1 ? kPictureCells : 1);
  }
  return files.empty() && cells > picture_cells;
}

/// The plan with at most kPictureCells cells along each axis.
WorkspacePlan with_picture_cells(WorkspacePlan plan) {
  VoxelOptions voxels = *plan.voxels();
  for (std::int64_t& n : voxels.cells) n = std::min(n, kPictureCells);
  plan.method = voxels;
  return plan;
}

/// The feasible cells of a plan, as a workspace that has no other field.
/// @param coarse  the same workspace on another grid
WorkspaceFields feasible_cells_only(const Target& target, const WorkspacePlan& plan, const WorkspaceFields& coarse) {
  const VoxelMap map =
      voxel_map(*target.mechanism, target.parameters, visualisation_plan(target.info(), plan, {1, 1, 1}));
  WorkspaceFields found = coarse;
  found.fields = {coarse.field("feasible")};
  found.fields.front().values.assign(map.feasible.begin(), map.feasible.end());
  for (std::size_t i = 0; i < found.axes.size(); ++i) {
    found.axes[i].cells = map.cells[i];
    found.axes[i].lower = map.lower[i];
    found.axes[i].upper = map.upper[i];
  }
  WorkspaceResult<double> summary;
  summarise(found.grid(), map, summary, found.axes.size());
  found.volume = summary.volume;
  return found;
}

/// Throws ConfigError if an output that the user requests is not available for these swept coordinates.
void expect_axes(const Axes& swept, const WorkspaceArguments& arguments) {
  const std::vector<std::string> names = names_of(swept);
  if (const std::string option = arguments.picture(); !option.empty() && names.size() != 2)
    throw ConfigError({"", 0, option}, "a workspace over " + join(names),
                      names.size() > 2 ? "a slice of it, such as that of --cut " + names.back() + "=0"
                                       : "a workspace over two coordinates");
  expect_surface(arguments, names);
}

/// The fields of exact errors (accuracy_exact, ..) at feasible poses; empty unless one of them is to be drawn, because
/// computing them takes longer than all other fields.
std::vector<WorkspaceField> exact_fields(const Target& target, const WorkspaceArguments& arguments,
                                         const std::vector<Pose<double>>& poses) {
  const auto compute = [&](const std::vector<Pose<double>>& at) {
    return generic::exact_accuracy_fields(*target.mechanism, target.parameters, at);
  };
  for (const std::string& name : names_of(compute({})))
    if (contains(arguments.fields, name)) return compute(poses);
  return {};
}

/// Adds the fields of exact errors to the fields of a workspace; NaN at infeasible cells.
void add_exact_fields(const Target& target, const WorkspaceArguments& arguments, WorkspaceFields& workspace) {
  if (arguments.fields.empty()) return;
  const std::vector<std::size_t> cells = workspace.feasible_cells();
  std::vector<Pose<double>> poses;
  for (const std::size_t cell : cells) poses.push_back(workspace.pose(cell));
  for (WorkspaceField& field : exact_fields(target, arguments, poses)) {
    std::vector<double> values(workspace.cells(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < cells.size(); ++i) values[cells[i]] = field.values[i];
    field.values = std::move(values);
    workspace.fields.push_back(std::move(field));
  }
}

/// Throws ConfigError if a field that the user names cannot be drawn.
void expect_drawn_fields(const Target& target, const WorkspaceArguments& arguments, const std::string& mode) {
  if (arguments.fields.empty()) return;
  const SourceLocation place{"", 0, "--field"};
  if (arguments.picture().empty() && arguments.csv.empty() && arguments.html.empty() && !arguments.any())
    throw ConfigError(place, "no file", "a picture to draw the field in, such as -o map.svg");
  std::vector<std::string> known = names_of(fields_at(*target.mechanism, target.parameters, target.limits, mode, {}));
  for (const std::string& exact : names_of(generic::exact_accuracy_fields(*target.mechanism, target.parameters, {})))
    known.push_back(exact);
  for (const std::string& field : arguments.fields) {
    if (!contains(known, field)) {
      for (const UndefinedQuantity& undefined : target.info().undefined_quantities)
        if (field == undefined.name || field.starts_with(undefined.name + "_"))
          throw ConfigError(place,
                            "'" + field + "' is undefined for mechanism " + target.info().name + ": " + undefined.why);
      throw ConfigError(place, "'" + field + "'", "one of " + join(known), nearest_name(field, known));
    }
    if (std::ranges::count(arguments.fields, field) > 1)
      throw ConfigError(place, "'" + field + "' twice", "each field once");
    if (const Unsupported undefined = why_no_conditioning(target.info()); undefined && field == kConditioning.name)
      throw ConfigError(place, *undefined);
  }
}

/// Draws a workspace over two coordinates: one picture for each field or, if no field is named, one of the outline.
/// Adds the area of the workspace to the output.
std::vector<Picture> slice_pictures(const Target& target, const WorkspaceFields& workspace,
                                    const WorkspaceArguments& arguments, const std::string& mode, Printout& out) {
  const SliceMesh mesh = slice_mesh(workspace, PoseMargin(*target.mechanism, target.parameters, target.limits));
  const SliceOutline outline = trace_outline(mesh);
  const std::string& unit = workspace.volume_unit;
  out.add("area", outline.area, number(outline.area, unit) + ", within the outline drawn");
  std::vector<std::string> fixed;
  for (const WorkspaceAxis& axis : workspace.fixed) fixed.push_back(axis.name + " = " + number(axis.lower, axis.unit));
  std::vector<std::string> lines = {workspace_title(target), "area " + number(outline.area, unit)};
  if (!fixed.empty()) lines.insert(lines.begin() + 1, join(fixed));
  if (arguments.fields.empty()) return {draw_slice(outline, lines)};
  std::vector<Pose<double>> poses;
  for (const auto& [x, y] : mesh.points) poses.push_back(workspace.pose({x, y, 0}));
  auto fields = fields_at(*target.mechanism, target.parameters, target.limits, mode, poses);
  for (WorkspaceField& exact : exact_fields(target, arguments, poses)) fields.push_back(std::move(exact));
  std::vector<Picture> pictures;
  for (const std::string& name : arguments.fields) pictures.push_back(draw_map(mesh, *find_named(fields, name), lines));
  return pictures;
}

/// Haar measure of the feasible orientations, if the axes of the workspace are the three angles of the platform.
std::optional<double> orientation_measure(const Target& target, const WorkspaceFields& workspace) {
  const auto orientations = orientations_of(*target.mechanism);
  if (!orientations) return {};
  std::vector<int> swept;
  for (const WorkspaceAxis& axis : workspace.axes) swept.push_back(axis.coordinate);
  if (swept != orientations->angles()) return {};
  VoxelMap map = workspace.grid().map();
  std::ranges::transform(workspace.field("feasible").values, map.feasible.begin(),
                         [](double feasible) { return static_cast<std::uint8_t>(feasible == 1); });
  return orientations->measure(map);
}

/// Adds the results of the workspace analysis to the output.
/// @param of_fields  the workspace whose fields are reported: `workspace` itself, or the same on a coarser grid
void report_workspace(const Target& target, const WorkspaceFields& workspace, const WorkspaceFields& of_fields,
                      Printout& out) {
  Json& json = out.json;
  out.add("mechanism", target.info().name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.add("design", target.words);
  json["parameters"] = values_by_name(target.info().parameters, target.parameters);
  json["fixed"] = Json::array();
  for (std::size_t i = 0; i < workspace.fixed.size(); ++i) {
    const auto& [coordinate, name, unit, value, upper, cells] = workspace.fixed[i];
    const std::string& why = workspace.fixed_note[i];
    json["fixed"].push_back({{"name", name}, {"value", value}, {"unit", unit}, {"why", why}});
    out.head.push_back({name, number(value, unit), why});
    if (const std::string note = large_angle_note({{name, unit}}, {&value, 1}); !note.empty())
      out.head.push_back({"note", note});
  }

  std::vector<Row> rows;
  const auto extents = feasible_extents(workspace);
  json["axes"] = Json::array();
  for (std::size_t i = 0; i < workspace.axes.size(); ++i) {
    const WorkspaceAxis& axis = workspace.axes[i];
    const double size = std::max(std::fabs(axis.lower), std::fabs(axis.upper));
    const std::array whole = {zero_if_rounding_error(axis.lower, size), zero_if_rounding_error(axis.upper, size)};
    std::array feasible = whole;
    if (extents)
      std::ranges::transform((*extents)[i], feasible.begin(),
                             [&](double end) { return zero_if_rounding_error(end, size); });
    const auto range = [&axis](const std::array<double, 2>& ends) { return range_text(ends[0], ends[1], axis.unit); };
    json["axes"].push_back({{"name", axis.name},
                            {"unit", axis.unit},
                            {"lower", whole[0]},
                            {"upper", whole[1]},
                            {"cells", axis.cells},
                            {"feasible", extents ? Json(feasible) : Json()}});
    rows.push_back(
        {axis.name, extents ? range(feasible) : "none", "of " + range(whole), std::to_string(axis.cells) + " cells"});
  }
  out.add_table("extent of the feasible cells", rows);

  const auto feasible = std::ranges::count(workspace.field("feasible").values, 1.0);
  json["cells"] = workspace.cells();
  json["feasible_cells"] = feasible;
  json["volume"] = workspace.volume;
  json["unit"] = workspace.volume_unit;
  json["touches_box"] = workspace.touches_box;
  out.head.push_back({"feasible cells", std::to_string(feasible) + " of " + std::to_string(workspace.cells())});
  out.head.push_back(
      {measure_name(workspace.axes.size()),
       number(workspace.volume, workspace.volume_unit, known_digits_of_voxels(feasible, workspace.axes.size()))});
  if (const auto measure = orientation_measure(target, workspace)) {
    json["orientations"] = {{"measure", *measure}, {"unit", kOrientationUnit}};
    out.head.push_back({"orientations", number(*measure, kOrientationUnit), "each counted once"});
  }
  if (workspace.touches_box)
    out.head.push_back({"warning", "the feasible set touches the box; it may extend beyond it"});

  rows = {{"", "minimum", "maximum", ""}};
  const Unsupported undefined = why_no_conditioning(target.info());
  json["field_cells"] = of_fields.cells();
  for (const WorkspaceField& field : of_fields.fields) {
    const auto range = range_of(field);
    json["fields"][field.name] = {{"unit", field.unit},
                                  {"least", range ? Json(range->least) : Json()},
                                  {"greatest", range ? Json(range->greatest) : Json()},
                                  {"meaning", field.meaning}};
    if (undefined && field.name == kConditioning.name) {
      json["fields"][field.name]["unavailable"] = *undefined;
      rows.push_back({field.name, "none", "", *undefined});
    }
    // Fields of mixed units state their units in `meaning`.
    const std::string unit = field.unit == "mixed" ? "1" : field.unit;
    if (range && field.name != "feasible")
      rows.push_back({field.name, number(range->least, unit), number(range->greatest, unit), field.meaning});
  }
  std::string title = "fields: minimum and maximum over the feasible cells (of the smallest margin: over all cells)";
  if (of_fields.cells() != workspace.cells()) {
    std::vector<std::string> cells;
    for (const WorkspaceAxis& axis : of_fields.axes) cells.push_back(std::to_string(axis.cells));
    title += " of a coarser grid of " + join(cells, " x ") + " cells, to save time";
  }
  if (rows.size() > 1) out.add_table(title, rows);
}

std::string workspace(const Target& target, const WorkspaceArguments& arguments, Printout& out) {
  std::vector<std::string> files = output_files(arguments, target);
  for (const std::string& file : {arguments.csv, arguments.html})
    if (!file.empty()) files.push_back(file);
  for (const std::string& file : {arguments.svg, arguments.png})
    for (const std::string& picture : arguments.pictures(file)) files.push_back(picture);
  const Existing existing = if_forced(arguments.force);
  // Throws std::runtime_error here, before any evaluation, if this build does not contain the files of the HTML page.
  if (!arguments.html.empty()) page_assets();
  with_team(arguments.threads, [&] {
    WorkspacePlan plan = target.plan();
    Slices slices;
    if (!arguments.fixed.empty()) slices = set_fixed_coordinates(plan, target.info(), arguments.fixed);
    add_cuts(slices, plan, target.info(), arguments.cut);
    if (!slices.empty() && !arguments.html.empty())
      throw ConfigError({"", 0, "--html"}, "a slice of a workspace", "a full workspace; --svg and --png draw slices");
    if (!arguments.home.empty() && !arguments.ranges)
      plan.home = parse_home(arguments.home, target.info(), sweep_of(target.info(), plan));
    if (plan.home && !slices.empty()) {
      if (!arguments.home.empty()) throw ConfigError({"", 0, "--home"}, "a slice of a workspace", "a full workspace");
      plan.home.reset();
      out.head.push_back({"note", "a slice shows all components, not only the one that holds the home pose"});
    }
    auto ranges_given = set_grid(plan, target, arguments, kPictureCells, kMaxFieldCells, slices);
    expect_axes(swept_axes(plan, target.info(), slices), arguments);
    apply_slices(plan, target, slices, ranges_given);
    const std::vector<RequestedSolid> solids = requested_solids(arguments, target, plan, slices);
    const std::string mode = parse_mode(target.info(), arguments);
    expect_drawn_fields(target, arguments, mode);
    check_outputs(files, target.files, existing);
    const bool is_coarse = slices.empty() && needs_coarse_fields(plan, files);
    WorkspaceFields found = compute_fields(target, is_coarse ? with_picture_cells(plan) : plan, mode);
    std::optional<WorkspaceFields> fine;
    if (is_coarse) fine = feasible_cells_only(target, plan, found);
    add_exact_fields(target, arguments, found);
    found.touches_box = touches(found, ranges_given);
    if (fine) fine->touches_box = touches(*fine, ranges_given);
    remove_sliced_axes(found, target.info(), slices);
    write_workspace(arguments, target, found);
    if (!arguments.csv.empty()) write_file(arguments.csv, workspace_table(found).text(), existing);
    if (!arguments.html.empty()) {
      const auto motions = target.study ? target.study->motions : std::vector<DesignMotion>();
      const ShownDesigns views =
          evaluate_shown_designs(*target.mechanism, plan, mode, motions, {target.words, target.parameters});
      write_file(arguments.html, html_page(page_data(views, program_words())), existing);
    }
    report_workspace(target, fine.value_or(found), found, out);
    if (slices.empty()) report_components(target, plan, out);
    report_solids(solids, target, out);
    if (arguments.ranges) report_ranges(arguments.home, target, mode, out);
    if (arguments.picture().empty()) return;
    if (plan.home) out.head.push_back({"note", "the picture shows all components of the workspace"});
    const std::vector<Picture> pictures = slice_pictures(target, found, arguments, mode, out);
    const std::vector<std::string> svg = arguments.pictures(arguments.svg), png = arguments.pictures(arguments.png);
    for (std::size_t i = 0; i < svg.size(); ++i) write_file(svg[i], svg_file(pictures[i]), existing);
    for (std::size_t i = 0; i < png.size(); ++i) write_file(png[i], png_file(pictures[i]), existing);
  });
  out.json["files"] = files;
  for (const std::string& file : files) out.text += "wrote " + file + '\n';
  return "";
}

}  // namespace

void add_workspace(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<WorkspaceArguments>(
      app, session, "workspace", "Compute the workspace of one design, and export it to ParaView, tables and CAD.",
      "A cell is feasible if its centre satisfies the limits of the study; a mechanism without a study has no limits.\n"
      "Files are in SI units: axes of lengths in m, axes of angles in rad.\n"
      "Example: pkmopt workspace 4ppa-2par --cut theta=20deg --field conditioning -o map.svg",
      workspace);
  add_grid_options(command, arguments, kPictureCells);
  add_list_option(command, "--fixed", arguments.fixed,
                  "Coordinates to fix at a value; default: those of the study, else at the design's default");
  add_list_option(command, "--cut", arguments.cut, "Values of swept coordinates at which the workspace is sliced");
  add_list_option(command, "--home", arguments.home,
                  "A pose: count only the component of the workspace that holds it (default: that of the study); with "
                  "--ranges, the pose from which the coordinates move");
  command.add_flag("--ranges", arguments.ranges,
                   "Print the range of each coordinate alone, from the pose --home (default: a pose in the middle)");
  add_option(command, "--mode MODE", arguments.mode, "Working mode of the coupling indices; default: the first");
  add_workspace_outputs(command, arguments);
  add_option(command, "--csv FILE", arguments.csv, "Write a row per cell to this file");
  add_option(command, "--html FILE", arguments.html, "Write a page with plots of the design to this file");
  add_option(command, "--svg FILE", arguments.svg,
             "Draw a workspace over two coordinates, such as a slice, to this file");
  add_option(command, "--png FILE", arguments.png, "Draw the same picture to a PNG file");
  add_option(command, "--field NAME", arguments.fields,
             "Draw these fields as maps with contour lines: a picture each (separated by commas, repeatable)")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_option(command, "--joint-error ERROR|NAME=ERROR", arguments.changes.joint_error,
             "Errors of the joints, for the field accuracy; a study gives them by [accuracy]")
      ->allow_extra_args(false);
  add_output_by_extension(command, {{".csv", &arguments.csv},
                                    {".html", &arguments.html},
                                    {".png", &arguments.png},
                                    {".stl", &arguments.stl},
                                    {".svg", &arguments.svg},
                                    {".vtkhdf", &arguments.vtk}});
  add_solid_options(command, arguments);
  add_threads(command, arguments.threads);
}

}  // namespace pkm
