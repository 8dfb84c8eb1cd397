// [workspace]: how a design's workspace is surveyed, and the short form of its limits.

#include <algorithm>
#include <cmath>

#include "engine/config/assignments.hpp"
#include "engine/config/sections.hpp"
#include "engine/config/sweep_section.hpp"
#include "engine/math/portable.hpp"

namespace pkm {
namespace {

constexpr std::array<std::int64_t, 3> kPaperCells{32, 34, 60};  // default grid: the one of the 4PPa-2PaR paper
constexpr std::int64_t kHeldCells = 32;  // and its default where the fixed coordinate is integrated over
constexpr std::int64_t kMostCellsPerAxis = 1 << 20;
constexpr std::int64_t kMostCells = std::int64_t{1} << 28;  // a voxel map takes a byte per cell
constexpr double kFinestTolerance = 1e-13, kCoarsestTolerance = 0.1;
constexpr std::int64_t kMostNodes = 200;
constexpr double kUsualGap = 1e-2;  // of certain = true

bool integrated(const FixedCoordinate& fixed) { return fixed.kind == FixedCoordinate::Kind::integrated; }

/// The coordinates that have cells: the swept ones, then those that are integrated over.
std::vector<std::string> names_with_cells(const MechanismInfo& info, const WorkspacePlan& plan) {
  std::vector<std::string> names = coordinate_names(info, sweep_of(info, plan).swept);
  for (const FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) names.push_back(axis_of(info, fixed.coordinate).name);
  return names;
}

/// Sets the cells of a plan of voxels, each number being cells_of(name). Returns their product along what is swept.
template <class CellsOf>
std::int64_t set_cells(const MechanismInfo& info, WorkspacePlan& plan, const CellsOf& cells_of) {
  const std::vector<int>& swept = sweep_of(info, plan).swept;
  auto& cells = std::get<VoxelOptions>(plan.method).cells;
  std::int64_t all = 1;
  for (std::size_t k = 0; k < swept.size(); ++k) all *= cells[k] = cells_of(axis_of(info, swept[k]).name);  // to 2^60
  for (FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) fixed.cells = cells_of(axis_of(info, fixed.coordinate).name);
  return all;
}

const std::string kFewerCells =
    "at most " + std::to_string(kMostCells) + " (a voxel map takes a byte of memory per cell)";

void read_cells(const ConfigValue& table, const MechanismInfo& info, WorkspacePlan& plan) {
  const std::vector<std::string> known = names_with_cells(info, plan);
  table.expect_table("a table of cell numbers for " + join(known)).allow(known, "coordinate");
  const std::int64_t all = set_cells(info, plan, [&table](const std::string& name) {
    return table.at(name, "a number of cells").integer(1, kMostCellsPerAxis);
  });
  if (all > kMostCells) throw table.error_of(std::to_string(all) + " cells", kFewerCells);
}

/// --cells, of the workspace alone: regions keep theirs.
void override_cells(StudyDraft& draft) {
  WorkspacePlan& plan = draft.parts.plan;
  for (const StudyChanges& changes : draft.changes) {
    if (changes.cells.empty()) continue;
    const SourceLocation place{"", 0, "--cells"};
    if (!plan.voxels())
      throw ConfigError(place, join(changes.cells) + " for a study by exact columns, which has no cells",
                        "a study whose [workspace] has method = \"voxels\"");
    const std::vector<std::string> names = names_with_cells(draft.info(), plan);
    const std::vector<std::int64_t> cells = parse_cells(changes.cells, names);
    const std::int64_t all = set_cells(draft.info(), plan, [&](const std::string& name) {
      return cells[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
    });
    if (all > kMostCells) throw ConfigError(place, std::to_string(all) + " cells", kFewerCells);
  }
}

Box read_box(const ConfigValue& table, const MechanismInfo& info, const std::vector<int>& swept) {
  const std::vector<std::string> known = coordinate_names(info, swept);
  table.expect_table("a table of ranges [from, to] for " + join(known)).allow(known, "coordinate");
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
    if (!(box[k][0] < box[k][1])) throw range.error("a range whose first end is the lower one");
  }
  return box;
}

void read_nodes(const ConfigValue& table, const MechanismInfo& info, const Sweep& sweep, ColumnOptions& columns) {
  std::vector<int> others = sweep.swept;
  std::erase(others, sweep.column);
  const std::vector<std::string> names = coordinate_names(info, others);
  table.expect_table("a table of node numbers for " + join(names)).allow(names, "coordinate");
  for (std::size_t k = 0; k < names.size(); ++k)
    columns.nodes[k] = static_cast<int>(table.at(names[k], "a number of nodes").integer(1, kMostNodes));
}

/// certain = true, or a gap.
std::optional<double> read_certain(const ConfigValue& value, const Mechanism& mechanism) {
  const std::string expected = "true, false, or the gap of the bounds: a number between 0 and 2";
  if (value.is_flag() && !value.flag()) return {};
  if (value.is_text() || value.is_list() || value.is_table()) throw value.error(expected);
  const double gap = value.is_flag() ? kUsualGap : value.number("1");
  if (!(gap > 0 && gap < 2)) throw value.error(expected);
  if (!mechanism.bounds())
    throw value.refusal("certain bounds are of mechanisms from files, whose formulas can be computed over intervals; " +
                        mechanism.info().name + " is written in C++");
  return gap;
}

/// exact = false, true or a time [s]; 0: false.
double read_exact(const ConfigValue& value, const Mechanism& mechanism, double usual) {
  if (value.is_flag() && !value.flag()) return 0;
  const std::string expected = "true, false, or the time that exact values may take: a time > 0 s, such as \"10 s\"";
  if (value.is_list() || value.is_table()) throw value.error(expected);
  const double seconds = value.is_flag() ? usual : value.number("s");
  if (!(seconds > 0)) throw value.error(expected);
  if (!mechanism.columns())
    throw value.refusal("mechanism " + mechanism.info().name + " has no exact columns" +
                        (mechanism.why_no_columns().empty() ? "" : ": " + mechanism.why_no_columns()));
  return seconds;
}

void read_limits(const ConfigValue& table, StudyDraft& draft) {
  const auto& known = draft.info().limits;
  table.expect_table("a table of limits, { name = threshold, ... }").allow(pkm::names_of(known), "limit");
  for (std::size_t i = 0; i < known.size(); ++i)
    if (const auto value = table.find(known[i].name)) {
      draft.parts.plan.limits.given[i] = value->number(known[i].unit, known[i].lower, known[i].upper);
      draft.study.limit_origins[i] = "workspace.limits (" + value->line() + ")";
    }
}

/// Refuses keys that are neither those of a survey, which [workspace] and [[region]] share, nor `own`.
void allow_survey(const ConfigValue& table, const MechanismInfo& info, const std::vector<std::string>& own) {
  std::vector<std::string> keys = {"method", "tolerance", "nodes", "cells", "box", "sweep"};
  for (const int coordinate : holdable(info)) keys.push_back(axis_of(info, coordinate).name);
  keys.insert(keys.end(), own.begin(), own.end());
  table.allow(keys);
}

ConfigError of_other_method(const ConfigValue& key, const WorkspacePlan& plan) {
  return key.refusal(std::string("this key belongs to method = ") +
                     (plan.voxels() ? "\"columns\", but the study's method is \"voxels\""
                                    : "\"voxels\", but the study's method is \"columns\""));
}

void read_survey(const ConfigValue& table, const Mechanism& mechanism, bool of_region, WorkspacePlan& plan) {
  const MechanismInfo& info = mechanism.info();
  const bool columns_support_box = mechanism.columns() && mechanism.columns()->supports_box();
  if (const auto method = table.find("method"); method && method->word({"columns", "voxels"}) == "voxels")
    plan.method = VoxelOptions{};
  for (const std::string key : {"tolerance", "nodes", "cells", "box"}) {
    const bool of_voxels = key == "cells" || key == "box", of_both = key == "box" && columns_support_box;
    if (!of_both && of_voxels != (plan.voxels() != nullptr) && table.has(key))
      throw of_other_method(*table.find(key), plan);
  }
  const auto tolerance = table.find("tolerance"), nodes = table.find("nodes");
  const double relative = tolerance ? tolerance->number("1", kFinestTolerance, kCoarsestTolerance) : 0;
  if (tolerance && nodes)
    throw nodes->refusal("either tolerance (" + tolerance->line() + ") or nodes set the accuracy; give one of them");
  if (const auto list = table.find("sweep")) read_sweep(*list, info, plan);
  read_held_coordinates(table, info, of_region, plan);  // decides which are swept, where the study does not say
  const Sweep& sweep = sweep_of(info, plan);
  if (auto* const columns = std::get_if<ColumnOptions>(&plan.method)) {
    if (tolerance) columns->tolerance = relative;
    if (nodes) read_nodes(*nodes, info, sweep, *columns);
  } else {
    set_usual(info, plan);
    if (const auto cells = table.find("cells")) read_cells(*cells, info, plan);
  }
  if (const auto given = table.find("box"))
    std::visit([&](auto& options) { options.box = read_box(*given, info, sweep.swept); }, plan.method);
}

}  // namespace

void set_usual(const MechanismInfo& info, WorkspacePlan& plan) {
  if (plan.columns()) {
    plan.method = ColumnOptions();
    return;
  }
  VoxelOptions voxels;
  std::copy_n(kPaperCells.begin(), sweep_of(info, plan).swept.size(), voxels.cells.begin());
  plan.method = voxels;
  for (FixedCoordinate& fixed : plan.fixed)
    if (integrated(fixed)) fixed.cells = kHeldCells;
}

void read_workspace(const ConfigValue& root, StudyDraft& draft) {
  const MechanismInfo& info = draft.info();
  WorkspacePlan& plan = draft.parts.plan;
  plan.limits = no_limits(info);
  draft.study.limit_origins.resize(info.limits.size());
  if (const auto table = root.find("workspace")) {
    allow_survey(table->expect_table("a table [workspace]"), info, {"limits", "certain", "exact"});
    read_survey(*table, *draft.parts.mechanism, false, plan);
    if (const auto certain = table->find("certain")) {
      auto* const columns = std::get_if<ColumnOptions>(&plan.method);
      if (!columns) throw of_other_method(*certain, plan);
      columns->certain = read_certain(*certain, *draft.parts.mechanism);
    }
    if (const auto exact = table->find("exact")) {
      if (!plan.voxels()) throw of_other_method(*exact, plan);
      draft.study.exact_seconds = read_exact(*exact, *draft.parts.mechanism, draft.study.exact_seconds);
    }
    if (const auto limits = table->find("limits")) read_limits(*limits, draft);
  }
  override_cells(draft);
}

void read_regions(const ConfigValue& root, StudyDraft& draft) {
  for (const auto& table : tables_of(root, "region")) {
    allow_survey(table, draft.info(), {"name"});
    Region region;
    region.name = new_name(table, "region", draft.parts.regions, "the region's name");
    region.plan.limits = draft.parts.plan.limits;
    read_survey(table, *draft.parts.mechanism, true, region.plan);
    draft.parts.regions.push_back(std::move(region));
  }
}

}  // namespace pkm
