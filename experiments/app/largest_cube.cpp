#include "experiments/app/largest_cube.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/problem/availability.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/voxel_grid.hpp"

namespace pkm {
namespace {

using CellIndex = std::array<std::size_t, 3>;

/// The minimum value of --least for each field of the workspace; std::nullopt: no minimum.
std::vector<std::optional<double>> minimum_values(const WorkspaceFields& workspace, const CubeArguments& arguments) {
  std::vector<Assignable> known;
  for (const WorkspaceField& field : workspace.fields)
    known.push_back({field.name, field.unit == "mixed" ? "1" : field.unit});
  return parse_assignments(arguments.least, "--least", known);
}

/// By cell: whether it is feasible and reaches all minimum values.
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

/// Summed-area table (3-D prefix sums) of the cells that are not good: counts them in any box of cells in constant
/// time.
class BadCellCounts {
 public:
  BadCellCounts(const CellIndex& cells, const std::vector<bool>& good) : cells_(cells) {
    sums_.resize((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
    std::size_t cell = 0;
    for (std::size_t i = 0; i < cells[0]; ++i)
      for (std::size_t j = 0; j < cells[1]; ++j)
        for (std::size_t k = 0; k < cells[2]; ++k, ++cell)
          sums_[node_index(i + 1, j + 1, k + 1)] =
              (good[cell] ? 0 : 1) + sum({i, j + 1, k + 1}) + sum({i + 1, j, k + 1}) + sum({i + 1, j + 1, k}) -
              sum({i, j, k + 1}) - sum({i, j + 1, k}) - sum({i + 1, j, k}) + sum({i, j, k});
  }

  /// @param a  first cell of the box  @param b  one past its last cell, in each coordinate
  std::int64_t within(const CellIndex& a, const CellIndex& b) const {
    return sum(b) - sum({a[0], b[1], b[2]}) - sum({b[0], a[1], b[2]}) - sum({b[0], b[1], a[2]}) +
           sum({a[0], a[1], b[2]}) + sum({a[0], b[1], a[2]}) + sum({b[0], a[1], a[2]}) - sum(a);
  }

 private:
  std::size_t node_index(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k;
  }
  std::int64_t sum(const CellIndex& at) const { return sums_[node_index(at[0], at[1], at[2])]; }

  CellIndex cells_;
  std::vector<std::int64_t> sums_;  ///< at each grid node: bad cells whose indices are all less than those of the node
};

struct Cube {
  double side = 0;
  CellIndex first{};  ///< its cell with the lowest indices
};

/// @return std::nullopt if not even one cell is good
std::optional<Cube> largest_cube(const WorkspaceFields& workspace, const std::vector<bool>& good) {
  const VoxelGrid grid = workspace.grid();
  const std::size_t axes = workspace.axes.size();
  CellIndex cells{};
  for (std::size_t a = 0; a < 3; ++a) cells[a] = static_cast<std::size_t>(grid.cells[a]);
  const BadCellCounts bad(cells, good);
  std::vector<double> sides;  // candidates: the whole numbers of cells along each axis
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t k = 1; k <= cells[a]; ++k) sides.push_back(static_cast<double>(k) * grid.step[a]);
  std::ranges::sort(sides);
  const auto fits = [&](const CellIndex& first, double side) {
    CellIndex end = {first[0] + 1, first[1] + 1, first[2] + 1};
    for (std::size_t a = 0; a < axes; ++a) {
      constexpr double kRounding = 1e-9;  // [cells]: smaller excesses of the quotient are rounding errors
      end[a] = first[a] + static_cast<std::size_t>(std::ceil(side / grid.step[a] - kRounding));
      if (end[a] > cells[a]) return false;
    }
    return bad.within(first, end) == 0;
  };
  const auto each_cell = [&cells](const auto& visit) {
    for (CellIndex cell{}; cell[0] < cells[0]; ++cell[0])
      for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
        for (cell[2] = 0; cell[2] < cells[2]; ++cell[2]) visit(cell);
  };
  std::size_t found = 0;  // number of candidates that fit somewhere; if one fits, all smaller ones do
  each_cell([&](const CellIndex& cell) {
    while (found < sides.size() && fits(cell, sides[found])) ++found;
  });
  if (found == 0) return {};
  const double side = sides[found - 1];
  std::vector<CellIndex> positions;
  each_cell([&](const CellIndex& cell) {
    if (fits(cell, side)) positions.push_back(cell);
  });
  std::array<double, 3> mean{};
  for (const CellIndex& at : positions)
    for (std::size_t a = 0; a < 3; ++a) mean[a] += static_cast<double>(at[a]) / static_cast<double>(positions.size());
  const auto square_distance = [&](const CellIndex& at) {
    double square = 0;
    for (std::size_t a = 0; a < axes; ++a) square += std::pow((static_cast<double>(at[a]) - mean[a]) * grid.step[a], 2);
    return square;
  };
  return Cube{side, *std::ranges::min_element(positions, {}, square_distance)};
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
