// Reader of [workspace] and [[region]]: method and extent of a workspace analysis, and the short form of limits.

#include <algorithm>
#include <cmath>

#include "engine/config/assignments.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/study_draft.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/swept_coordinates.hpp"
#include "engine/math/portable.hpp"
#include "engine/mechanism/availability.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

constexpr std::array<std::int64_t, 3> kPaperCells{32, 34, 60};  // default grid, taken from the 4PPa-2PaR paper
// Default number of cells along a coordinate that is integrated over.
constexpr std::int64_t kIntegratedCells = 32;
// Maximum total number of cells; a voxel map takes one byte per cell.
constexpr std::int64_t kMaxCells = std::int64_t{1} << 28;
constexpr double kDefaultGap = 1e-2;  // relative gap of the bounds for `certified = true`

bool integrated(const FixedCoordinate& fixed) { return fixed.kind == FixedCoordinate::Kind::integrated; }

/// Names of the coordinates that have cells: the swept ones, followed by those that are integrated over.
std::vector<std::string> names_with_cells(const MechanismInfo& info, const WorkspacePlan& plan) {
  std::vector<std::string> names = coordinate_names(info, sweep_of(info, plan).swept);
  for (const FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) names.push_back(axis_of(info, fixed.coordinate).name);
  return names;
}

/// Sets the numbers of cells along all axes of a voxel plan to cells_of(name). @return the product of the numbers along
/// the swept coordinates
template <class CellsOf>
std::int64_t set_cells(const MechanismInfo& info, WorkspacePlan& plan, const CellsOf& cells_of) {
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  auto& cells = std::get<VoxelOptions>(plan.method).cells;
  std::int64_t all = 1;
  // The product cannot overflow, because each factor is at most 2^20.
  for (std::size_t k = 0; k < swept.size(); ++k) all *= cells[k] = cells_of(axis_of(info, swept[k]).name);
  for (FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) fixed.cells = cells_of(axis_of(info, fixed.coordinate).name);
  return all;
}

const std::string kFewerCells =
    "at most " + std::to_string(kMaxCells) + " (a voxel map takes a byte of memory per cell)";

void read_cells(const ConfigValue& table, const MechanismInfo& info, WorkspacePlan& plan) {
  const ConfigValue cells = table.table_of_names(names_with_cells(info, plan));
  const std::int64_t all = set_cells(
      info, plan, [&cells](const std::string& name) { return cells.at(name, "a number of cells").integer(); });
  if (all > kMaxCells) throw table.error_of(std::to_string(all) + " cells", kFewerCells);
}

/// Applies --cells to the workspace; regions keep their cells.
void override_cells(StudyDraft& draft) {
  WorkspacePlan& plan = draft.parts.plan;
  for (const StudyChanges& changes : draft.changes) {
    if (changes.cells.empty()) continue;
    const SourceLocation place{"", 0, "--cells"};
    if (!plan.voxels())
      throw ConfigError(place, join(changes.cells) + " although the study uses exact columns, which have no cells",
                        "a study whose [workspace] has method = \"voxels\"");
    const std::vector<std::string> names = names_with_cells(draft.info(), plan);
    const std::vector<std::int64_t> cells = parse_cells(changes.cells, names);
    const std::int64_t all = set_cells(draft.info(), plan, [&](const std::string& name) {
      return cells[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
    });
    if (all > kMaxCells) throw ConfigError(place, std::to_string(all) + " cells", kFewerCells);
  }
}

Box read_box(const ConfigValue& given, const MechanismInfo& info, const std::vector<int>& swept) {
  const std::vector<std::string> known = coordinate_names(info, swept);
  const ConfigValue table = given.table_of_names(known);
  Box box;
  box.fill({0, 1});
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const std::string expected = "a range [from, to]", unit = axis_of(info, swept[k]).unit;
    const ConfigValue range = table.at(known[k], expected);
    const auto ends = range.elements(expected);
    if (ends.size() != 2) throw range.error(expected);
    for (std::size_t end = 0; end < 2; ++end) {
      const double value = ends[end].number(unit);
      if (unit == "rad" && std::fabs(value) > kPi) throw ends[end].error(angle_expectation(ends[end], value));
      box[k][end] = value;
    }
    if (!(box[k][0] < box[k][1])) throw range.error("a range [from, to] with from < to");
  }
  return box;
}

/// Reads `home`: the values of the swept coordinates.
std::array<double, 3> read_home(const ConfigValue& given, const MechanismInfo& info, const std::vector<int>& swept) {
  const std::vector<std::string> known = coordinate_names(info, swept);
  const ConfigValue table = given.table_of_names(known);
  std::array<double, 3> home{};
  for (std::size_t k = 0; k < swept.size(); ++k)
    home[k] = table.at(known[k], "a value of the coordinate").number(axis_of(info, swept[k]).unit);
  return home;
}

void read_nodes(const ConfigValue& given, const MechanismInfo& info, const Sweep& sweep, ColumnOptions& columns) {
  std::vector<int> others = sweep.swept;
  std::erase(others, sweep.column);
  const std::vector<std::string> names = coordinate_names(info, others);
  const std::string& along = info.coordinates[static_cast<std::size_t>(sweep.column)].name;
  if (const auto own = given.table().find(along))
    throw own->refusal("columns run along " + along + ", which has no nodes; expected " + join(names));
  const ConfigValue table = given.table_of_names(names);
  for (std::size_t k = 0; k < names.size(); ++k)
    columns.nodes[k] = static_cast<int>(table.at(names[k], "a number of nodes").integer());
}

/// Reads `certified`: true, or the relative gap of the bounds.
std::optional<double> read_certified(const ConfigValue& value, const Mechanism& mechanism) {
  const std::string expected = "true, false, or the relative gap of the bounds, a number between 0 and 2";
  if (value.is_flag() && !value.flag()) return {};
  if (value.is_text() || value.is_list() || value.is_table()) throw value.error(expected);
  const double gap = value.is_flag() ? kDefaultGap : value.number("1");
  if (!(gap > 0 && gap < 2)) throw value.error(expected);
  if (!mechanism.bounds())
    throw value.refusal(
        "certified bounds evaluate the formulas of a mechanism file in interval arithmetic, but mechanism " +
        mechanism.info().name + " is written in C++");
  return gap;
}

/// Reads `exact`: false, true, or a time limit.
/// @param default_seconds  time limit for `exact = true`
/// @return time limit of the exact values [s]; 0: they are not computed
double read_exact(const ConfigValue& value, const Mechanism& mechanism, double default_seconds) {
  if (value.is_flag() && !value.flag()) return 0;
  const std::string expected = "true, false, or a time limit of the exact values > 0 s, such as \"10 s\"";
  if (value.is_list() || value.is_table()) throw value.error(expected);
  const double seconds = value.is_flag() ? default_seconds : value.number("s");
  if (!(seconds > 0)) throw value.error(expected);
  if (!mechanism.columns())
    throw value.refusal("mechanism " + mechanism.info().name + " has no exact columns" +
                        (mechanism.why_no_columns().empty() ? "" : ": " + mechanism.why_no_columns()));
  return seconds;
}

/// Reads limits = { NAME = threshold, QUANTITY = { min = threshold, max = threshold } }.
void read_limits(const ConfigValue& given, StudyDraft& draft) {
  const auto& known = draft.info().limits;
  std::vector<std::string> names;
  for (const LimitInfo& limit : known)
    if (limit.group != kQuantityLimit) names.push_back(limit.name);
  const auto& built_in = all_mechanisms();
  const bool is_generic = draft.study.description ||
                          std::ranges::find(built_in, draft.info().name, &MechanismEntry::name) != built_in.end();
  if (is_generic)  // mechanisms implemented in C++ have no limits of quantities
    for (const PoseQuantity* const quantity : pose_quantities(draft.info()))
      if (!quantity->needs_inertia()) names.emplace_back(quantity->name);
  const ConfigValue table = given.table_of_names(names);
  const auto read = [&](const std::string& limit, const ConfigValue& value) {
    const auto i = static_cast<std::size_t>(find_named(known, limit) - known.data());
    draft.parts.plan.limits.given[i] = value.number(known[i].unit, known[i].lower, known[i].upper);
    draft.study.limit_origins[i] = "workspace.limits (" + value.line() + ")";
  };
  for (const std::string& name : table.keys()) {
    const ConfigValue value = *table.find(name);
    if (find_named(known, name)) {
      read(name, value);
      continue;
    }
    const std::string expected = "a table { min = .., max = .. }, since " + name + " is a quantity";
    const ConfigValue sides = value.expect_table(expected).table();
    if (sides.keys().empty()) throw value.error(expected);
    if (const Unsupported reason = why_unavailable(*draft.parts.mechanism, pose_quantity_called(draft.info(), name)))
      throw value.refusal(*reason);
    for (const std::string& side : sides.keys()) read(name + "_" + side, *sides.find(side));
  }
}

/// Names of the coordinates that an analysis can fix: keys of [workspace] and [[region]].
std::vector<std::string> fixable_coordinates(const MechanismInfo& info) {
  return coordinate_names(info, fixable(info));
}

ConfigError error_of_other_method(const ConfigValue& key, const WorkspacePlan& plan) {
  return key.refusal(std::string("this key requires method = ") +
                     (plan.voxels() ? "\"columns\", but the study's method is \"voxels\""
                                    : "\"voxels\", but the study's method is \"columns\""));
}

void read_survey(const ConfigValue& table, const Mechanism& mechanism, bool of_region, WorkspacePlan& plan) {
  const MechanismInfo& info = mechanism.info();
  const bool columns_support_box = mechanism.columns() && mechanism.columns()->supports_box();
  if (table.word_at("method") == "voxels") plan.method = VoxelOptions{};
  for (const std::string key : {"tolerance", "nodes", "cells", "box"}) {
    const bool of_voxels = key == "cells" || key == "box", of_both = key == "box" && columns_support_box;
    if (!of_both && of_voxels != (plan.voxels() != nullptr) && table.has(key))
      throw error_of_other_method(*table.find(key), plan);
  }
  const auto tolerance = table.find("tolerance"), nodes = table.find("nodes");
  const double relative = table.number_at("tolerance");
  if (tolerance && nodes)
    throw nodes->refusal("tolerance (" + tolerance->line() + ") and nodes both set the accuracy; give one of them");
  if (const auto list = table.find("sweep")) read_sweep(*list, info, plan);
  read_fixed_coordinates(table, info, of_region,
                         plan);  // determines which coordinates are swept, if the study does not name them
  const Sweep& sweep = sweep_of(info, plan);
  if (auto* const columns = std::get_if<ColumnOptions>(&plan.method)) {
    if (tolerance) columns->tolerance = relative;
    if (nodes) read_nodes(*nodes, info, sweep, *columns);
  } else {
    set_defaults(info, plan);
    if (const auto cells = table.find("cells")) read_cells(*cells, info, plan);
  }
  if (const auto home = table.find("home")) {
    if (const auto fixed = std::ranges::find_if(plan.fixed, integrated); fixed != plan.fixed.end())
      throw home->refusal("components need a single value of " + axis_of(info, fixed->coordinate).name +
                          ", but the workspace analysis integrates over it; fix it at one value, or sweep it");
    plan.home = read_home(*home, info, sweep.swept);
  }
  if (const auto given = table.find("box"))
    std::visit([&](auto& options) { options.box = read_box(*given, info, sweep.swept); }, plan.method);
}

}  // namespace

void set_defaults(const MechanismInfo& info, WorkspacePlan& plan) {
  if (plan.columns()) {
    plan.method = ColumnOptions();
    return;
  }
  VoxelOptions voxels;
  std::copy_n(kPaperCells.begin(), sweep_of(info, plan).swept.size(), voxels.cells.begin());
  plan.method = voxels;
  for (FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) fixed.cells = kIntegratedCells;
}

void read_workspace(const ConfigValue& root, StudyDraft& draft) {
  const MechanismInfo& info = draft.info();
  WorkspacePlan& plan = draft.parts.plan;
  plan.limits = no_limits(info);
  draft.study.limit_origins.resize(info.limits.size());
  if (const auto table = root.find_table("workspace", named_keys(workspace_keys(), fixable_coordinates(info)))) {
    read_survey(*table, *draft.parts.mechanism, false, plan);
    if (const auto certified = table->find("certified")) {
      auto* const columns = std::get_if<ColumnOptions>(&plan.method);
      if (!columns) throw error_of_other_method(*certified, plan);
      if (plan.home && !(certified->is_flag() && !certified->flag()))
        throw certified->refusal(
            "certified bounds of a volume count all components of the workspace, but `home` singles out one; remove "
            "`certified` or `home`");
      columns->certified = read_certified(*certified, *draft.parts.mechanism);
    }
    if (const auto exact = table->find("exact")) {
      if (!plan.voxels()) throw error_of_other_method(*exact, plan);
      draft.study.exact_seconds = read_exact(*exact, *draft.parts.mechanism, draft.study.exact_seconds);
    }
    if (const auto limits = table->find("limits")) read_limits(*limits, draft);
  }
  override_cells(draft);
}

void read_regions(const ConfigValue& root, StudyDraft& draft) {
  for (const auto& table : root.tables("region", named_keys(region_keys(), fixable_coordinates(draft.info())))) {
    Region region;
    region.name = new_name(table, "region", draft.parts.regions, "the region's name");
    region.plan.limits = draft.parts.plan.limits;
    read_survey(table, *draft.parts.mechanism, true, region.plan);
    draft.parts.regions.push_back(std::move(region));
  }
}

}  // namespace pkm
