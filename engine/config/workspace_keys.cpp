// Keys of [workspace] and [[region]].

#include "engine/config/key_specs.hpp"
#include "engine/config/study_keys.hpp"

namespace pkm {
namespace {

constexpr double kMaxNodes = 200, kMaxCellsPerAxis = 1 << 20;
constexpr double kFinestTolerance = 1e-13, kCoarsestTolerance = 0.1;

/// Keys that [workspace] and [[region]] share.
std::vector<OptionSpec> analysis_keys() {
  static const TableSpec nodes = {
      .meaning = "numbers of nodes",
      .keys = {},
      .named = {{.kind = OptionKind::integer, .lower = 1, .upper = kMaxNodes, .meaning = "number of nodes"}},
      .noun = "coordinate"};
  static const TableSpec cells = {
      .meaning = "numbers of cells",
      .keys = {},
      .named = {{.kind = OptionKind::integer, .lower = 1, .upper = kMaxCellsPerAxis, .meaning = "number of cells"}},
      .noun = "coordinate"};
  static const TableSpec box = {.meaning = "ranges of the swept coordinates",
                                .keys = {},
                                .named = {{.kind = OptionKind::list,
                                           .meaning = "range [from, to]; angles in [-pi, pi]",
                                           .count = 2,
                                           .parts = {{.unit = kUnitOfEntry}}}},
                                .noun = "coordinate"};
  static const TableSpec home = {.meaning = "a pose: the values of all swept coordinates",
                                 .keys = {},
                                 .named = {{.unit = kUnitOfEntry, .meaning = "value of the coordinate"}},
                                 .noun = "coordinate"};
  return {{.name = "method",
           .kind = OptionKind::word,
           .initial = "columns",
           .choices = {"columns", "voxels"},
           .meaning = "exact volume by cylindrical decomposition (columns), or cells of a grid (voxels)"},
          {.name = "tolerance",
           .initial = 1e-8,
           .lower = kFinestTolerance,
           .upper = kCoarsestTolerance,
           .meaning = "columns: relative accuracy of the volume"},
          table_key("nodes", nodes,
                    "columns: fixed numbers of Gauss-Legendre nodes per smooth subinterval, instead of `tolerance`"),
          table_key("cells", cells, "voxels: numbers of cells along the swept coordinates, at most 2^28 in all"),
          table_key("box", box, "box that restricts the workspace; with voxels it also defines the grid"),
          table_key("home", home,
                    "measure only the component of the workspace that holds this pose, which the robot can move in "
                    "without leaving limits and without crossing a singularity"),
          {.name = "sweep",
           .kind = OptionKind::list,
           .meaning = "swept coordinates, one to three; default: those that are not fixed, or the mechanism's",
           .parts = {{.kind = OptionKind::word}}}};
}

/// Description of the keys that fix a coordinate: y, phi, ...
OptionSpec fixed_coordinate() {
  return {.kind = OptionKind::any_of,
          .unit = kUnitOfEntry,
          .meaning =
              "a fixed coordinate: its default value (\"middle\"), a number, or \"integrated\" over its range; in a "
              "[[region]] also a list of values",
          .parts = {{.unit = kUnitOfEntry},
                    {.kind = OptionKind::word, .choices = {"middle", "integrated"}},
                    {.kind = OptionKind::list, .parts = {{.unit = kUnitOfEntry}}}}};
}

}  // namespace

const TableSpec& workspace_keys() {
  static const TableSpec sides = {
      .meaning = "minimum and maximum of a quantity",
      .keys = {{.name = "min", .unit = kUnitOfEntry, .meaning = "minimum allowed value of the quantity"},
               {.name = "max", .unit = kUnitOfEntry, .meaning = "maximum allowed value of the quantity"}}};
  static const TableSpec limits = {
      .meaning = "thresholds of constraints of poses, and of quantities",
      .keys = {},
      .named = {{.kind = OptionKind::any_of,
                 .unit = kUnitOfEntry,
                 .meaning = "threshold of a constraint of poses; minimum and maximum of a quantity",
                 .parts = {{.unit = kUnitOfEntry}, {.kind = OptionKind::table, .table = &sides}}}},
      .noun = "limit"};
  static const TableSpec spec = [] {
    TableSpec table = {.header = "[workspace]",
                       .meaning = "method and extent of the workspace analysis",
                       .keys = analysis_keys(),
                       .named = {fixed_coordinate()}};
    table.keys.push_back(table_key("limits", limits, "thresholds of constraints of poses, the short form"));
    table.keys.push_back({.name = "certified",
                          .kind = OptionKind::any_of,
                          .meaning =
                              "columns: compare the volumes of the final designs with certified bounds of this gap "
                              "(true: 1e-2)",
                          .parts = {{.kind = OptionKind::flag}, {.upper = 2, .positive = true}}});
    table.keys.push_back({.name = "exact",
                          .kind = OptionKind::any_of,
                          .unit = "s",
                          .meaning =
                              "voxels: also compute exact values of the best design and the baseline, by columns; a "
                              "time limits the computation (true: 10 s, the default)",
                          .parts = {{.kind = OptionKind::flag}, {.unit = "s", .positive = true}}});
    return table;
  }();
  return spec;
}

const TableSpec& region_keys() {
  static const TableSpec spec = [] {
    TableSpec table = {
        .header = "[[region]]",
        .meaning = "part of the workspace with a workspace analysis of its own, under the study's limits",
        .keys = analysis_keys(),
        .named = {fixed_coordinate()}};
    table.keys.push_back({.name = "name",
                          .kind = OptionKind::word,
                          .required = true,
                          .meaning = "name for objectives, constraints and outputs to refer to"});
    return table;
  }();
  return spec;
}

}  // namespace pkm
