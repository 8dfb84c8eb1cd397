#include "engine/report/isosurface.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"

namespace pkm {
namespace {

/// Vertices by coordinate, each with the feasible cell next to it: its number among the feasible ones.
Json surface(const WorkspaceFields& workspace, const PoseMargin* margin) {
  const Isosurface found = isosurface(workspace, margin);
  std::vector<std::int64_t> number(workspace.cells()), cells, corners;
  for (std::int64_t k = 0; const std::size_t cell : workspace.feasible_cells()) number[cell] = k++;
  for (const std::size_t cell : found.cell) cells.push_back(number[cell]);
  for (const auto& triangle : found.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  Json vertices = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& vertex : found.vertices) values.push_back(vertex[axis]);
    vertices.push_back(packed_levels(values));
  }
  return {{"vertices", vertices}, {"cells", packed_integers(cells)}, {"triangles", packed_integers(corners)}};
}

Json axis_of(const WorkspaceAxis& axis) {
  Json json = axis_data(axis.name, axis.unit);
  json["coordinate"] = axis.coordinate;
  return json;
}

Json workspace(const std::string& name, const WorkspaceFields& found, const PoseMargin* margin) {
  Json json = {{"name", name}, {"axes", Json::array()}, {"held", Json::array()}};
  for (const WorkspaceAxis& axis : found.axes) {
    json["axes"].push_back(axis_of(axis));
    json["axes"].back().update({{"lower", axis.lower}, {"upper", axis.upper}, {"cells", axis.cells}});
  }
  for (std::size_t i = 0; i < found.held.size(); ++i) {
    json["held"].push_back(axis_of(found.held[i]));
    json["held"].back().update({{"value", found.held[i].lower}, {"note", found.held_note[i]}});
  }
  json["volume"] = found.volume;
  json["volume_unit"] = found.volume_unit;
  const std::vector<double>& feasible = found.field("feasible").values;
  json["feasible"] = packed_bits(std::vector<std::uint8_t>(feasible.begin(), feasible.end()));
  json["fields"] = Json::array();
  for (const WorkspaceField& field : found.fields) {
    if (field.name == "feasible") continue;
    std::vector<double> values;
    for (const std::size_t cell : found.feasible_cells()) values.push_back(field.values[cell]);
    json["fields"].push_back(
        {{"name", field.name}, {"unit", field.unit}, {"meaning", field.meaning}, {"values", packed_levels(values)}});
  }
  if (!refuse_surface(found)) json["surface"] = surface(found, margin);
  return json;
}

/// All that a file's own map says: which cells of the best design are feasible, not where the rest is held.
WorkspaceFields fields_of(const MapRecord& map, const DesignRecord& best, const std::string& volume_unit) {
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

Json workspace_data(const Views& views) {
  const SurveyPlan& plan = views.plan;
  const MechanismInfo& info = views.mechanism.info();
  Json json = {{"column", info.coordinates[static_cast<std::size_t>(sweep_of(info, plan).column)].name},
               {"designs", Json::array()},
               {"problems", Json::array()}};
  for (const View& view : views.designs) {
    if (!view.workspace) {
      json["problems"].push_back("The design “" + view.name + "” is not shown: " + view.problem + ".");
      continue;
    }
    const PoseMargin margin(views.mechanism, view.parameters, plan.limits);
    json["designs"].push_back(workspace(view.name, *view.workspace, &margin));
  }
  return json;
}

Json workspace_data(const StudyContents& contents) {
  if (!contents.final || !contents.final->map || !contents.final->best) return {};
  const FinalRecord& final = *contents.final;
  Json design = workspace("best", fields_of(*final.map, *final.best, final.volume_unit), nullptr);
  design["fields"].clear();  // the margin is only made up for the surface
  return {{"column", design["axes"].back()["name"]}, {"designs", {design}}, {"problems", Json::array()}};
}

}  // namespace pkm
