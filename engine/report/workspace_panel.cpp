// Computes the data of the panel "Workspace": feasible cells, their fields, and the boundary surface of each design.
#include <algorithm>
#include <optional>

#include "engine/core/catalogue.hpp"
#include "engine/export/isosurface.hpp"
#include "engine/mechanism/design_facts.hpp"
#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

/// Returns true if the page includes a field. Quantities of inertia require ShownDesigns::coupling; margins and joint
/// positions require PageDetail::joints.
bool is_shown(const ShownDesigns& shown, const std::string& field) {
  for (const PoseQuantity* const quantity : pose_quantities(shown.mechanism.info())) {
    const std::string name = quantity->name;
    if (field == name || (quantity->per_joint && field.starts_with(name + "_")))
      return shown.coupling || !quantity->needs_inertia();
  }
  return shown.detail.joints;
}

/// The boundary surface: one packed column for each coordinate of the vertices, and the vertices of its triangles.
/// @param shown, design  null if only the feasible cells are known: vertices are then interpolated
Json surface_json(const ShownDesigns* shown, const ShownDesign* design, const WorkspaceFields& workspace) {
  std::optional<PoseMargin> margin;
  if (shown) margin.emplace(shown->mechanism, design->parameters, shown->plan.limits);
  const Isosurface found = isosurface(workspace, margin ? &*margin : nullptr);
  std::vector<std::int64_t> indices;
  for (const auto& triangle : found.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  Json vertices = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& vertex : found.vertices) values.push_back(vertex[axis]);
    vertices.push_back(packed_quantised(values));
  }
  return {{"vertices", vertices}, {"triangles", packed_integers(indices)}};
}

/// JSON of a solid, which is a product of balls (a cylinder: of a disc and an interval): its name, shape, volume and
/// centre, its extents by axis, and the axes and the dimension of each ball.
Json solid_json(const ShownSolid& shown) {
  Json json = {{"name", shown.name}, {"shape", shown.shape.name()}, {"volume", shown.volume}};
  for (std::size_t axis = 0; axis < shown.shape.axes(); ++axis) {
    json["centre"].push_back(shown.solid.centre[axis]);
    json["extents"].push_back(shown.solid.dimensions[shown.shape.ball_of(axis)]);
  }
  for (std::size_t ball = 0; ball < shown.shape.balls(); ++ball) {
    json["balls"].push_back(shown.shape.axes_of(ball));
    json["dimensions"].push_back({{"name", shown.dimension_names[ball]}, {"value", shown.solid.dimensions[ball]}});
  }
  return json;
}

Json axis_json(const WorkspaceAxis& axis) {
  Json json = axis_data(axis.name, axis.unit);
  json["coordinate"] = axis.coordinate;
  return json;
}

/// JSON of the workspace of a design.
/// @param shown, design  null if only the feasible cells are known
Json workspace_json(const std::string& name, const WorkspaceFields& found, const ShownDesigns* shown,
                    const ShownDesign* design) {
  Json json = {{"name", name}, {"axes", Json::array()}, {"fixed", Json::array()}};
  for (const WorkspaceAxis& axis : found.axes) {
    json["axes"].push_back(axis_json(axis));
    json["axes"].back().update({{"lower", axis.lower}, {"upper", axis.upper}, {"cells", axis.cells}});
  }
  for (std::size_t i = 0; i < found.fixed.size(); ++i) {
    json["fixed"].push_back(axis_json(found.fixed[i]));
    json["fixed"].back().update({{"value", found.fixed[i].lower}, {"note", found.fixed_note[i]}});
  }
  json["volume"] = found.volume;
  json["volume_unit"] = found.volume_unit;
  const std::vector<double>& feasible = found.field("feasible").values;
  json["feasible"] = packed_bits(std::vector<std::uint8_t>(feasible.begin(), feasible.end()));
  json["fields"] = Json::array();
  for (const WorkspaceField& field : found.fields) {
    if (field.name == "feasible" || (shown && !is_shown(*shown, field.name))) continue;
    std::vector<double> values;
    for (const std::size_t cell : found.feasible_cells()) values.push_back(field.values[cell]);
    json["fields"].push_back(
        {{"name", field.name}, {"unit", field.unit}, {"meaning", field.meaning}, {"values", packed_quantised(values)}});
  }
  if (!surface_unsupported(names_of(found.axes))) json["surface"] = surface_json(shown, design, found);
  if (!design) return json;
  for (const ShownSolid& solid : design->solids) json["solids"].push_back(solid_json(solid));
  for (const ShownSolid& solid : design->sizes) json["sizes"].push_back(solid_json(solid));
  json["joints"] = axes_data(shown->mechanism.info().joints);
  if (const DesignFacts* const facts = find_design_facts(shown->mechanism)) {
    const auto ranges = facts->joint_ranges(design->parameters);
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (ranges[i]) json["joints"][i]["range"] = *ranges[i];
  }
  return json;
}

/// Converts the map in a study file to fields. The map contains the feasible cells of the best design, but not the
/// values of the fixed coordinates. The margin is set to 1 or -1; the isosurface then runs half-way between feasible
/// and infeasible cells.
WorkspaceFields fields_of_map(const MapRecord& map, const DesignRecord& best, const std::string& volume_unit) {
  WorkspaceFields found;
  for (std::size_t i = 0; i < map.axes.size() && !map.axes[i].empty(); ++i)
    found.axes.push_back({static_cast<int>(i), map.axes[i], map.units[i], map.voxels.lower[i], map.voxels.upper[i],
                          map.voxels.cells[i]});
  found.volume = best.volume;
  found.volume_unit = volume_unit;
  std::vector<double> margin;
  for (const std::uint8_t feasible : map.voxels.feasible) margin.push_back(feasible ? 1 : -1);
  found.fields.push_back({"feasible", "1", "", {map.voxels.feasible.begin(), map.voxels.feasible.end()}});
  found.fields.push_back({"margin", "1", "", std::move(margin)});
  return found;
}

}  // namespace

Json workspace_data(const ShownDesigns& shown) {
  const WorkspacePlan& plan = shown.plan;
  const MechanismInfo& info = shown.mechanism.info();
  Json json = {{"column", info.coordinates[static_cast<std::size_t>(sweep_of(info, plan).column)].name},
               {"designs", Json::array()},
               {"problems", Json::array()}};
  for (const ShownDesign& design : shown.designs) {
    if (!design.workspace) {
      json["problems"].push_back("The design “" + design.name + "” is not shown: " + design.problem + ".");
      continue;
    }
    json["designs"].push_back(workspace_json(design.name, *design.workspace, &shown, &design));
  }
  return json;
}

Json plain_workspace(const std::string& name, const WorkspaceFields& found) {
  Json json = workspace_json(name, found, nullptr, nullptr);
  json["fields"].clear();
  return json;
}

Json workspace_data(const StudyContents& contents) {
  if (!contents.final || !contents.final->map || !contents.final->best) return {};
  const FinalRecord& final = *contents.final;
  const Json best = plain_workspace("best", fields_of_map(*final.map, *final.best, final.volume_unit));
  return {{"column", best["axes"].back()["name"]}, {"designs", {best}}, {"problems", Json::array()}};
}

}  // namespace pkm
