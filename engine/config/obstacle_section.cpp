// [[obstacle]] of a study.

#include <algorithm>

#include "engine/config/sections.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

/// [x, y, z], each number by `read`.
template <class Read>
Point3<double> three(const ConfigValue& list, const std::string& expected, const Read& read) {
  const std::vector<ConfigValue> elements = list.elements(expected);
  if (elements.size() != 3) throw list.error(expected);
  return {read(elements[0]), read(elements[1]), read(elements[2])};
}

Point3<double> point(const ConfigValue& table, const std::string& key) {
  const std::string expected = "a point [x, y, z] in the base's frame";
  return three(table.at(key, expected), expected, [](const ConfigValue& value) { return value.number("m"); });
}

Obstacle read_obstacle(const ConfigValue& table, const Obstacles& others) {
  const std::string& shape = type_of(table, "shape", {"box", "sphere", "capsule"});
  const auto named = [&] { return new_name(table, "[[obstacle]]", others, "a name, for messages and pictures"); };
  const auto radius = [&] { return table.at("radius", "its radius").positive("m"); };
  if (shape == "box") {
    table.allow({"name", "shape", "centre", "size"});
    const std::string expected = "its sizes [along x, along y, along z]";
    Point3<double> half =
        three(table.at("size", expected), expected, [](const ConfigValue& value) { return value.positive("m") / 2; });
    return {named(), SolidBox{point(table, "centre"), half}};
  }
  if (shape == "sphere") {
    table.allow({"name", "shape", "centre", "radius"});
    const Point3<double> centre = point(table, "centre");
    return {named(), Capsule<double>{{centre, centre}, radius()}};
  }
  table.allow({"name", "shape", "from", "to", "radius"});
  return {named(), Capsule<double>{{point(table, "from"), point(table, "to")}, radius()}};
}

}  // namespace

void read_obstacles(const ConfigValue& root, StudyDraft& draft) {
  const std::vector<ConfigValue> tables = tables_of(root, "obstacle");
  if (tables.empty()) return;
  const MechanismInfo& info = draft.info();
  WorkspacePlan& plan = draft.parts.plan;
  const auto limit = std::ranges::find(info.limits, "clearance", &LimitInfo::group);
  if (limit == info.limits.end())
    throw tables.front().refusal("links keep clear of obstacles, and mechanism " + info.name +
                                 " has no links with a radius that could meet anything");
  for (const ConfigValue& table : tables) plan.limits.obstacles.push_back(read_obstacle(table, plan.limits.obstacles));
  if (!requires_clearance(info, plan))
    draft.study.warnings.push_back(
        "the obstacles cut nothing from the workspace, because the study asks for no clearance; [[constraint]] type = "
        "\"clearance\" does");
}

}  // namespace pkm
