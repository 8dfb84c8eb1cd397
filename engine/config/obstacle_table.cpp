// Reader of [[obstacle]].

#include <algorithm>

#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

/// Reads a list of three numbers [x, y, z].
Point3<double> read_triple(const ConfigValue& table, const std::string& key, const std::string& expected) {
  const ConfigValue list = table.at(key, expected);
  const std::vector<ConfigValue> elements = list.elements(expected);
  if (elements.size() != 3) throw list.error(expected);
  return {elements[0].number(), elements[1].number(), elements[2].number()};
}

Point3<double> point(const ConfigValue& table, const std::string& key) {
  return read_triple(table, key, "a point [x, y, z] in the base's frame");
}

Obstacle read_obstacle(const ConfigValue& table, const Obstacles& others) {
  const std::string& shape = table.at("shape").word();
  const auto named = [&] { return new_name(table, "[[obstacle]]", others, "a name, for messages and pictures"); };
  const auto radius = [&] { return table.at("radius", "the radius").number(); };
  if (shape == "box") {
    const Point3<double> size = read_triple(table, "size", "the sizes [along x, along y, along z]");
    return {named(), SolidBox{point(table, "centre"), {size[0] / 2, size[1] / 2, size[2] / 2}}};
  }
  if (shape == "sphere") {
    const Point3<double> centre = point(table, "centre");
    return {named(), Capsule<double>{{centre, centre}, radius()}};
  }
  return {named(), Capsule<double>{{point(table, "from"), point(table, "to")}, radius()}};
}

}  // namespace

void read_obstacles(const ConfigValue& root, StudyDraft& draft) {
  const std::vector<ConfigValue> tables = root.tables("obstacle");
  if (tables.empty()) return;
  const MechanismInfo& info = draft.info();
  WorkspacePlan& plan = draft.parts.plan;
  const auto limit = std::ranges::find(info.limits, "clearance", &LimitInfo::group);
  if (limit == info.limits.end())
    throw tables.front().refusal("obstacles need links with a radius, and mechanism " + info.name +
                                 " has none that could collide with them");
  for (const ConfigValue& table : tables) plan.limits.obstacles.push_back(read_obstacle(table, plan.limits.obstacles));
  if (!requires_clearance(info, plan))
    draft.study.warnings.push_back(
        "the obstacles do not restrict the workspace, because no clearance is required; add a [[constraint]] with "
        "type = \"clearance\"");
}

}  // namespace pkm
