// Values of the pose coordinates and of the joints, and matrices between them, as text and as JSON; output that the
// commands which evaluate a single pose share.
#pragma once

#include <algorithm>

#include "engine/config/swept_coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

using Axes = std::vector<AxisInfo>;

AxisVector<double> axis_vector(std::span<const double> values);

/// The different units of a list in the order of their first appearance, each followed by `suffix`: "m/s, rad/s".
template <class List>
std::string units_of(const List& list, const std::string& suffix = "") {
  std::vector<std::string> units;
  for (const auto& item : list)
    if (std::ranges::find(units, item.unit + suffix) == units.end()) units.push_back(item.unit + suffix);
  return join(units);
}

/// Names and values as text, for example "x = 0.25 m, theta = 0.5 rad".
std::string axes_text(const Axes& axes, std::span<const double> values);
/// A hint if an angle exceeds one revolution: its value was probably given in degrees without a unit, but plain numbers
/// are in rad. Otherwise "".
std::string large_angle_note(const Axes& axes, std::span<const double> values);
/// JSON object {name: value, ...} with a value for each axis; null if there are no values.
Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values);
/// JSON array of numbers.
inline Json vector_json(std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); }
/// JSON array of the rows of a matrix; null if there is no matrix.
Json matrix_json(const std::optional<AxisMatrix<double>>& matrix);
/// Text of a matrix below a title: one line per row, aligned columns.
std::string matrix_text(const std::string& title, const AxisMatrix<double>& matrix);

/// Adds a pose to the output, and states whether it can be assembled and whether it is feasible.
void report_pose(const MechanismInfo& info, const Pose<double>& at, const PoseReport& report, Printout& out);
/// Error message if the mechanism cannot be assembled at the pose in `mode`; "" if it can.
std::string assembly_error(const std::string& mode, const PoseReport& report);

}  // namespace pkm
