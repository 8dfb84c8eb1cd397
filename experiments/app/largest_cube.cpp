#include "experiments/app/largest_cube.hpp"

#include <algorithm>

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/workspace/largest_cube.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

/// The minimum value of --least for each field of the workspace; std::nullopt: no minimum.
std::vector<std::optional<double>> minimum_values(const WorkspaceFields& workspace, const CubeArguments& arguments) {
  std::vector<Assignable> known;
  for (const WorkspaceField& field : workspace.fields)
    known.push_back({field.name, field.unit == "mixed" ? "1" : field.unit});
  return parse_assignments(arguments.least, "--least", known);
}

/// For each cell: whether it is feasible and satisfies all minimum values.
std::vector<bool> good_cells(const WorkspaceFields& workspace, const CubeArguments& arguments) {
  const auto least = minimum_values(workspace, arguments);
  const std::vector<double>& feasible = workspace.field("feasible").values;
  std::vector<bool> good(feasible.size());
  for (std::size_t cell = 0; cell < good.size(); ++cell) {
    good[cell] = feasible[cell] > 0;
    for (std::size_t f = 0; f < least.size(); ++f)
      if (least[f] && !(workspace.fields[f].values[cell] >= *least[f])) good[cell] = false;
  }
  return good;
}

}  // namespace

void add_cube_options(CLI::App& command, CubeArguments& arguments) {
  CLI::Option* const cube =
      command.add_flag("--cube", arguments.cube, "Find the largest cube of feasible cells (of two lengths: square)");
  add_option(command, "--least FIELD=VALUE", arguments.least,
             "Minimum field value of the cube's cells, such as conditioning=0.3 (repeatable)")
      ->allow_extra_args(false)
      ->needs(cube);
}

void expect_length_axes(const Axes& swept, const CubeArguments& arguments) {
  if (!arguments.cube) return;
  const bool lengths = std::ranges::all_of(swept, [](const AxisInfo& axis) { return axis.unit == "m"; });
  if (!lengths || swept.size() < 2)
    throw ConfigError({"", 0, "--cube"}, "a workspace over " + join(names_of(swept)),
                      "two or three lengths; --cut fixes an angle");
}

void expect_known_fields(const WorkspaceFields& workspace, const MechanismInfo& info, const CubeArguments& arguments) {
  const auto least = minimum_values(workspace, arguments);
  const Unsupported undefined = why_no_conditioning(info);
  for (std::size_t i = 0; i < least.size(); ++i)
    if (least[i] && undefined && workspace.fields[i].name == kConditioning.name)
      throw ConfigError({"", 0, "--least"}, *undefined);
}

void report_largest_cube(const WorkspaceFields& workspace, const CubeArguments& arguments, Printout& out) {
  if (!arguments.cube) return;
  const std::string title = workspace.axes.size() == 3 ? "largest cube" : "largest square";
  const auto cube = largest_cube(workspace, good_cells(workspace, arguments));
  out.json["cube"] = nullptr;
  if (!cube) {
    out.text += '\n' + title + ": none, no cell satisfies the conditions\n";
    return;
  }
  std::vector<std::string> box;
  out.json["cube"] = {{"side", cube->side}, {"box", Json::object()}};
  for (std::size_t a = 0; a < workspace.axes.size(); ++a) {
    const WorkspaceAxis& axis = workspace.axes[a];
    const double from = axis.lower + static_cast<double>(cube->first[a]) * workspace.grid().step[a],
                 to = from + cube->side;
    box.push_back(axis.name + "=" + formatted("%.9g", from) + ":" + formatted("%.9g", to));
    out.json["cube"]["box"][axis.name] = {from, to};
  }
  out.add_table(title + ", judged by cell centres", {{"side", number(cube->side, "m")}, {"box", join(box, ",")}});
}

}  // namespace pkm
