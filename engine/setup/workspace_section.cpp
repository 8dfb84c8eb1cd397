// [workspace]: how a design's workspace is surveyed, and the short form of its limits.

#include <algorithm>
#include <cmath>

#include "engine/math/portable.hpp"
#include "engine/setup/sections.hpp"

namespace pkm {
namespace {

constexpr std::array<std::int64_t, 3> kPaperCells{32, 34, 60};  // default grid: the one of the 4PPa-2PaR paper
constexpr std::int64_t kHeldCells = 32;  // and its default where the held coordinate is integrated over
constexpr std::int64_t kMostCellsPerAxis = 1 << 20;
constexpr std::int64_t kMostCells = std::int64_t{1} << 28;  // a voxel map takes a byte per cell
constexpr double kFinestTolerance = 1e-13, kCoarsestTolerance = 0.1;
constexpr std::int64_t kMostNodes = 200;

std::string unit_of_coordinate(int coordinate) { return coordinate == 3 ? "rad" : "m"; }

const std::string& name_of(const MechanismInfo& info, int coordinate) {
  return info.coordinates[static_cast<std::size_t>(coordinate)];
}

std::array<std::string, 3> swept_names(const MechanismInfo& info, const SurveyPlan& plan) {
  std::array<std::string, 3> names;
  for (std::size_t k = 0; k < 3; ++k) names[k] = name_of(info, sweep_of(info, plan).swept[k]);
  return names;
}

void read_cells(const ConfigValue& table, const MechanismInfo& info, SurveyPlan& plan) {
  const auto swept = swept_names(info, plan);
  std::vector<std::string> known(swept.begin(), swept.end());
  const bool integrated = plan.held.kind == HeldCoordinate::Kind::integrated;
  if (integrated) known.push_back(name_of(info, sweep_of(info, plan).held));
  table.expect_table("a table of cell numbers for " + join(known)).allow(known, "coordinate");
  const auto read = [&table](const std::string& name) {
    return table.at(name, "a number of cells").integer(1, kMostCellsPerAxis);
  };
  std::int64_t all = 1;
  for (std::size_t k = 0; k < 3; ++k) all *= plan.cells[k] = read(known[k]);  // at most 2^60
  if (integrated) plan.held_cells = read(known[3]);
  if (all > kMostCells)
    throw table.error_of(std::to_string(all) + " cells",
                         "at most " + std::to_string(kMostCells) + " (a voxel map takes a byte of memory per cell)");
}

/// A bare number beyond pi was most likely meant in degrees.
std::string angle_expectation(const ConfigValue& written, double value) {
  const std::string range = "an angle in [-pi, pi] rad";
  return written.is_text() ? range : range + "; write \"" + shortest(value) + " deg\" for degrees";
}

void read_box(const ConfigValue& table, const MechanismInfo& info, SurveyPlan& plan) {
  const auto names = swept_names(info, plan);
  const std::vector<std::string> known(names.begin(), names.end());
  table.expect_table("a table of ranges [from, to] for " + join(known)).allow(known, "coordinate");
  plan.box.emplace();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string expected = "a range [from, to]", unit = unit_of_coordinate(sweep_of(info, plan).swept[k]);
    const ConfigValue range = table.at(names[k], expected);
    const auto ends = range.elements(expected);
    if (ends.size() != 2) throw range.error(expected);
    for (std::size_t end = 0; end < 2; ++end) {
      const double value = ends[end].number(unit);
      if (unit == "rad" && std::fabs(value) > kPi) throw ends[end].error(angle_expectation(ends[end], value));
      (*plan.box)[k][end] = value;
    }
    if (!((*plan.box)[k][0] < (*plan.box)[k][1])) throw range.error("a range whose first end is the lower one");
  }
}

void read_nodes(const ConfigValue& table, const MechanismInfo& info, SurveyPlan& plan) {
  std::vector<std::string> names;
  const Sweep sweep = sweep_of(info, plan);
  for (const int coordinate : sweep.swept)
    if (coordinate != sweep.column) names.push_back(name_of(info, coordinate));
  table.expect_table("a table of node numbers for " + join(names)).allow(names, "coordinate");
  for (std::size_t k = 0; k < plan.nodes.size(); ++k)
    plan.nodes[k] = static_cast<int>(table.at(names[k], "a number of nodes").integer(1, kMostNodes));
}

/// The key of the coordinate that is not swept: "middle", "integrated" or a number.
HeldCoordinate read_held(const ConfigValue& value, const MechanismInfo& info, int coordinate) {
  using Kind = HeldCoordinate::Kind;
  const std::string choices =
      info.held_can_integrate ? "\"middle\", \"integrated\" or a number in " : "\"middle\" or a number in ";
  const std::string unit = unit_of_coordinate(coordinate), expected = choices + unit;
  if (value.is_text()) {
    const std::string& word = value.text(expected);
    if (word == "middle") return {Kind::middle, 0, coordinate};
    if (word == "integrated" && info.held_can_integrate) return {Kind::integrated, 0, coordinate};
    if (word == "integrated")
      throw value.refusal("the mechanism " + info.name + " cannot integrate its workspace over " +
                          name_of(info, coordinate) + "; give " + expected);
  }
  double number = 0;
  try {
    number = value.number(unit);
  } catch (const ConfigError&) {
    const std::string word = value.is_text() ? nearest_name(value.text(""), {"middle", "integrated"}) : "";
    throw value.error(expected, word);
  }
  if (unit == "rad" && std::fabs(number) > kPi) throw value.error(angle_expectation(value, number));
  return {Kind::value, number, coordinate};
}

/// A list of values of the held coordinate.
void read_held_values(const ConfigValue& list, const MechanismInfo& info, int coordinate, SurveyPlan& plan) {
  const std::string expected = "a list of values of " + name_of(info, coordinate);
  for (const ConfigValue& value : list.elements(expected))
    plan.held_values.push_back(read_held(value, info, coordinate).value);
  if (plan.held_values.empty()) throw list.error(expected);
  plan.held = {HeldCoordinate::Kind::value, plan.held_values.front(), coordinate};
}

/// The one coordinate, of those that the mechanism's surveys can hold, that the study names.
void read_held_coordinate(const ConfigValue& table, const MechanismInfo& info, bool of_region, SurveyPlan& plan) {
  std::string first;
  for (const Sweep& sweep : sweeps_of(info)) {
    const std::string& name = name_of(info, sweep.held);
    const auto value = table.find(name);
    if (!value) continue;
    if (!first.empty())
      throw value->refusal("a survey holds one coordinate and sweeps the others, but both " + first + " and " + name +
                           " are given");
    first = name;
    if (of_region && value->is_list())
      read_held_values(*value, info, sweep.held, plan);
    else
      plan.held = read_held(*value, info, sweep.held);
  }
}

void read_limits(const ConfigValue& table, StudyDraft& draft) {
  const auto& known = draft.info().limits;
  table.expect_table("a table of limits, { name = threshold, ... }").allow(names_of(known), "limit");
  for (std::size_t i = 0; i < known.size(); ++i)
    if (const auto value = table.find(known[i].name)) {
      draft.parts.plan.limits.given[i] = value->number(known[i].unit, known[i].lower, known[i].upper);
      draft.study.limit_origins[i] = "workspace.limits (" + value->line() + ")";
    }
}

/// The keys of a survey, which [workspace] and [[region]] share.
std::vector<std::string> survey_keys(const MechanismInfo& info) {
  std::vector<std::string> keys = {"method", "tolerance", "nodes", "cells", "box"};
  for (const Sweep& sweep : sweeps_of(info)) keys.push_back(name_of(info, sweep.held));
  return keys;
}

void read_survey(const ConfigValue& table, const MechanismInfo& info, bool of_region, SurveyPlan& plan) {
  if (const auto method = table.find("method"))
    plan.method = method->word({"columns", "voxels"}) == "voxels" ? Method::voxels : Method::columns;
  const bool voxels = plan.method == Method::voxels;
  for (const std::string key : {"tolerance", "nodes", "cells", "box"}) {
    const bool of_voxels = key == "cells" || key == "box", of_both = key == "box" && info.columns_take_box;
    if (!of_both && of_voxels != voxels && table.has(key))
      throw table.find(key)->refusal(std::string("this key belongs to method = ") +
                                     (of_voxels ? "\"voxels\", but the study's method is \"columns\""
                                                : "\"columns\", but the study's method is \"voxels\""));
  }
  if (const auto tolerance = table.find("tolerance")) {
    plan.tolerance = tolerance->number("1", kFinestTolerance, kCoarsestTolerance);
    if (table.has("nodes"))
      throw table.find("nodes")->refusal("either tolerance (" + tolerance->line() +
                                         ") or nodes set the accuracy; give one of them");
  }
  read_held_coordinate(table, info, of_region, plan);  // decides which coordinates are swept
  if (const auto nodes = table.find("nodes")) read_nodes(*nodes, info, plan);
  if (voxels) {
    plan.cells = kPaperCells;
    if (plan.held.kind == HeldCoordinate::Kind::integrated) plan.held_cells = kHeldCells;
  }
  if (const auto cells = table.find("cells")) read_cells(*cells, info, plan);
  if (const auto box = table.find("box")) read_box(*box, info, plan);
}

}  // namespace

void read_workspace(const ConfigValue& root, StudyDraft& draft) {
  const MechanismInfo& info = draft.info();
  SurveyPlan& plan = draft.parts.plan;
  plan.limits = no_limits(info);
  draft.study.limit_origins.resize(info.limits.size());
  const auto table = root.find("workspace");
  if (!table) return;
  std::vector<std::string> keys = survey_keys(info);
  keys.push_back("limits");
  table->expect_table("a table [workspace]").allow(keys, "key");
  read_survey(*table, info, false, plan);
  if (const auto limits = table->find("limits")) read_limits(*limits, draft);
}

void read_regions(const ConfigValue& root, StudyDraft& draft) {
  const MechanismInfo& info = draft.info();
  for (const auto& table : tables_of(root, "region")) {
    std::vector<std::string> keys = survey_keys(info);
    keys.push_back("name");
    table.allow(keys, "key");
    Region region;
    const ConfigValue name = table.at("name", "the region's name");
    region.name = name.text("the region's name");
    if (region.name.empty()) throw name.error("the region's name");
    for (const Region& other : draft.parts.regions)
      if (other.name == region.name) throw name.refusal("there is already a region called '" + region.name + "'");
    region.plan.limits = draft.parts.plan.limits;
    read_survey(table, info, true, region.plan);
    draft.parts.regions.push_back(std::move(region));
  }
}

}  // namespace pkm
