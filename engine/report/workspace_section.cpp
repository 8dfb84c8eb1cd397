#include <algorithm>
#include <optional>

#include "engine/core/catalogue.hpp"
#include "engine/report/isosurface.hpp"
#include "engine/report/packed.hpp"
#include "engine/report/sections.hpp"
#include "engine/survey/pose_quantities.hpp"

namespace pkm {
namespace {

/// Which fields a page has room for, and a reader use.
bool is_shown(const Views& views, const std::string& field) {
  for (const PoseQuantity* const quantity : pose_quantities()) {
    const std::string name = quantity->name;
    if (field == name || field.starts_with(name + "_")) return views.coupling || !quantity->needs_inertia();
  }
  return views.detail.joints;
}

/// Vertices by coordinate, and the fields beside them by name.
Json surface(const Views* views, const View* view, const WorkspaceFields& workspace) {
  std::optional<PoseMargin> margin;
  if (views) margin.emplace(views->mechanism, view->parameters, views->plan.limits);
  const Isosurface found = isosurface(workspace, margin ? &*margin : nullptr);
  std::vector<std::int64_t> corners;
  for (const auto& triangle : found.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  Json vertices = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const auto& vertex : found.vertices) values.push_back(vertex[axis]);
    vertices.push_back(packed_levels(values));
  }
  Json json = {{"vertices", vertices}, {"triangles", packed_integers(corners)}, {"values", Json::object()}};
  if (!views) return json;
  std::vector<Pose<double>> poses;
  for (const auto& place : found.inside) poses.push_back(workspace.pose(place));
  for (const WorkspaceField& field :
       fields_at(views->mechanism, view->parameters, views->plan.limits, views->mode, poses))
    if (is_shown(*views, field.name)) json["values"][field.name] = packed_levels(field.values);
  return json;
}

Json axis_of(const WorkspaceAxis& axis) {
  Json json = axis_data(axis.name, axis.unit);
  json["coordinate"] = axis.coordinate;
  return json;
}

/// @param views, view  null: nothing is known but the cells
Json workspace(const std::string& name, const WorkspaceFields& found, const Views* views, const View* view) {
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
    if (field.name == "feasible" || (views && !is_shown(*views, field.name))) continue;
    std::vector<double> values;
    for (const std::size_t cell : found.feasible_cells()) values.push_back(field.values[cell]);
    json["fields"].push_back(
        {{"name", field.name}, {"unit", field.unit}, {"meaning", field.meaning}, {"values", packed_levels(values)}});
  }
  if (!refuse_surface(names_of(found.axes))) json["surface"] = surface(views, view, found);
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
    json["designs"].push_back(workspace(view.name, *view.workspace, &views, &view));
  }
  return json;
}

Json workspace_data(const StudyContents& contents) {
  if (!contents.final || !contents.final->map || !contents.final->best) return {};
  const FinalRecord& final = *contents.final;
  Json design = workspace("best", fields_of(*final.map, *final.best, final.volume_unit), nullptr, nullptr);
  design["fields"].clear();  // the margin is only made up for the surface
  return {{"column", design["axes"].back()["name"]}, {"designs", {design}}, {"problems", Json::array()}};
}

}  // namespace pkm
