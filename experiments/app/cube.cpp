#include "experiments/app/cube.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/core/catalogue.hpp"
#include "engine/problem/no_conditioning.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "engine/survey/voxel_grid.hpp"

namespace pkm {
namespace {

using Corner = std::array<std::size_t, 3>;

/// Least values by field; none: any will do.
std::vector<std::optional<double>> least_values(const WorkspaceFields& workspace, const CubeArguments& arguments) {
  std::vector<Assignable> known;
  for (const WorkspaceField& field : workspace.fields)
    known.push_back({field.name, field.unit == "mixed" ? "1" : field.unit});
  return parse_assignments(arguments.least, "--least", known);
}

std::vector<bool> good_cells(const WorkspaceFields& workspace, const CubeArguments& arguments) {
  const auto least = least_values(workspace, arguments);
  const std::vector<double>& feasible = workspace.field("feasible").values;
  std::vector<bool> good(feasible.size());
  for (std::size_t cell = 0; cell < good.size(); ++cell) {
    good[cell] = feasible[cell] > 0;
    for (std::size_t f = 0; f < least.size(); ++f)
      if (least[f] && !(workspace.fields[f].values[cell] >= *least[f])) good[cell] = false;
  }
  return good;
}

/// How many cells of a box are not good, by one look at each of its eight corners.
class Faults {
 public:
  Faults(const Corner& cells, const std::vector<bool>& good) : cells_(cells) {
    sums_.resize((cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1));
    std::size_t cell = 0;
    for (std::size_t i = 0; i < cells[0]; ++i)
      for (std::size_t j = 0; j < cells[1]; ++j)
        for (std::size_t k = 0; k < cells[2]; ++k, ++cell)
          sums_[place(i + 1, j + 1, k + 1)] = (good[cell] ? 0 : 1) + sum({i, j + 1, k + 1}) + sum({i + 1, j, k + 1}) +
                                              sum({i + 1, j + 1, k}) - sum({i, j, k + 1}) - sum({i, j + 1, k}) -
                                              sum({i + 1, j, k}) + sum({i, j, k});
  }

  std::int64_t within(const Corner& a, const Corner& b) const {
    return sum(b) - sum({a[0], b[1], b[2]}) - sum({b[0], a[1], b[2]}) - sum({b[0], b[1], a[2]}) +
           sum({a[0], a[1], b[2]}) + sum({a[0], b[1], a[2]}) + sum({b[0], a[1], a[2]}) - sum(a);
  }

 private:
  std::size_t place(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * (cells_[1] + 1) + j) * (cells_[2] + 1) + k;
  }
  std::int64_t sum(const Corner& at) const { return sums_[place(at[0], at[1], at[2])]; }

  Corner cells_;
  std::vector<std::int64_t> sums_;  ///< of the cells before a corner
};

struct Cube {
  double side = 0;
  Corner first{};  ///< its lowest cell
};

std::optional<Cube> largest_cube(const WorkspaceFields& workspace, const std::vector<bool>& good) {
  const VoxelGrid grid = workspace.grid();
  const std::size_t axes = workspace.axes.size();
  Corner cells{};
  for (std::size_t a = 0; a < 3; ++a) cells[a] = static_cast<std::size_t>(grid.cells[a]);
  const Faults faults(cells, good);
  std::vector<double> sides;  // a cube is as long as some cells along one axis or another
  for (std::size_t a = 0; a < axes; ++a)
    for (std::size_t k = 1; k <= cells[a]; ++k) sides.push_back(static_cast<double>(k) * grid.step[a]);
  std::ranges::sort(sides);
  const auto fits = [&](const Corner& first, double side) {
    Corner end = {first[0] + 1, first[1] + 1, first[2] + 1};
    for (std::size_t a = 0; a < axes; ++a) {
      constexpr double kRounding = 1e-9;
      end[a] = first[a] + static_cast<std::size_t>(std::ceil(side / grid.step[a] - kRounding));
      if (end[a] > cells[a]) return false;
    }
    return faults.within(first, end) == 0;
  };
  const auto each_cell = [&cells](const auto& visit) {
    for (Corner cell{}; cell[0] < cells[0]; ++cell[0])
      for (cell[1] = 0; cell[1] < cells[1]; ++cell[1])
        for (cell[2] = 0; cell[2] < cells[2]; ++cell[2]) visit(cell);
  };
  std::size_t found = 0;  // sides before this one fit somewhere
  each_cell([&](const Corner& cell) {
    while (found < sides.size() && fits(cell, sides[found])) ++found;
  });
  if (found == 0) return {};
  const double side = sides[found - 1];
  std::vector<Corner> places;
  each_cell([&](const Corner& cell) {
    if (fits(cell, side)) places.push_back(cell);
  });
  std::array<double, 3> middle{};
  for (const Corner& place : places)
    for (std::size_t a = 0; a < 3; ++a) middle[a] += static_cast<double>(place[a]) / static_cast<double>(places.size());
  const auto off = [&](const Corner& place) {
    double square = 0;
    for (std::size_t a = 0; a < axes; ++a)
      square += std::pow((static_cast<double>(place[a]) - middle[a]) * grid.step[a], 2);
    return square;
  };
  return Cube{side, *std::ranges::min_element(places, {}, off)};
}

}  // namespace

void add_cube_options(CLI::App& command, CubeArguments& arguments) {
  CLI::Option* const cube =
      command.add_flag("--cube", arguments.cube, "Tell the largest cube of feasible cells, or square of two lengths");
  add_option(command, "--least FIELD=VALUE", arguments.least,
             "Cells of the cube have at least this conditioning, say; separated by commas or repeated")
      ->allow_extra_args(false)
      ->needs(cube);
}

void expect_lengths(const Axes& swept, const CubeArguments& arguments) {
  if (!arguments.cube) return;
  const bool lengths = std::ranges::all_of(swept, [](const AxisInfo& axis) { return axis.unit == "m"; });
  if (!lengths || swept.size() < 2)
    throw ConfigError({"", 0, "--cube"}, "a workspace over " + join(names_of(swept)),
                      "one over two or three lengths; --cut leaves an angle at a value");
}

void expect_fields(const WorkspaceFields& workspace, const MechanismInfo& info, const CubeArguments& arguments) {
  const auto least = least_values(workspace, arguments);
  const Refusal undefined = no_conditioning(info);
  for (std::size_t i = 0; i < least.size(); ++i)
    if (least[i] && undefined && workspace.fields[i].name == kConditioning.name)
      throw ConfigError({"", 0, "--least"}, *undefined);
}

void tell_cube(const WorkspaceFields& workspace, const CubeArguments& arguments, Printout& out) {
  if (!arguments.cube) return;
  const std::string title = workspace.axes.size() == 3 ? "largest cube" : "largest square";
  const auto cube = largest_cube(workspace, good_cells(workspace, arguments));
  out.json["cube"] = nullptr;
  if (!cube) {
    out.text += '\n' + title + ": none, no cell is good enough\n";
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
  out.section(title + ", by the centres of cells", {{"side", number(cube->side, "m")}, {"box", join(box, ",")}});
}

}  // namespace pkm
