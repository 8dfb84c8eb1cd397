// Values of coordinates and joints, from the command line, as text and as JSON; matrices between them.
#pragma once

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/setup/sweep_section.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

using Axes = std::vector<AxisInfo>;

AxisVector<double> axis_vector(std::span<const double> values);

/// Each unit of a list once, in its order, with `behind` after it: "m/s, rad/s".
template <class List>
std::string units_of(const List& list, const std::string& behind = "") {
  std::vector<std::string> units;
  for (const auto& item : list)
    if (std::ranges::find(units, item.unit + behind) == units.end()) units.push_back(item.unit + behind);
  return join(units);
}

/// "x = 0.25 m, theta = 0.5 rad"
std::string axes_text(const Axes& axes, std::span<const double> values);
/// What an angle of more than a turn was perhaps meant to be: a number without a unit is in rad. "": there is none.
std::string turns_note(const Axes& axes, std::span<const double> values);
/// By name; null where they do not exist.
Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values);
/// A list.
inline Json vector_json(std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); }
/// A list of rows; null where there is none.
Json matrix_json(const std::optional<AxisMatrix<double>>& matrix);
std::string matrix_text(const std::string& title, const AxisMatrix<double>& matrix);

/// A pose, whether it assembles and whether it is feasible.
void say_pose(const MechanismInfo& info, const Pose<double>& at, const PoseReport& report, Printout& out);
/// Why a pose does not assemble; "" where it does.
std::string no_assembly(const std::string& mode, const PoseReport& report);

}  // namespace pkm
