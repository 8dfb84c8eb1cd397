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

/// The distinct units of a list in order of first appearance, each followed by `suffix`: "m/s, rad/s".
template <class List>
std::string units_of(const List& list, const std::string& suffix = "") {
  std::vector<std::string> units;
  for (const auto& item : list)
    if (std::ranges::find(units, item.unit + suffix) == units.end()) units.push_back(item.unit + suffix);
  return join(units);
}

/// "x = 0.25 m, theta = 0.5 rad"
std::string axes_text(const Axes& axes, std::span<const double> values);
/// A hint if an angle exceeds one revolution, which suggests degrees entered without a unit (plain numbers are in rad);
/// otherwise "".
std::string large_angle_note(const Axes& axes, std::span<const double> values);
/// {name: value, ...}; null if there are no values.
Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values);
/// A JSON array.
inline Json vector_json(std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); }
/// A JSON array of rows; null if there is no matrix.
Json matrix_json(const std::optional<AxisMatrix<double>>& matrix);
/// The rows of a matrix in aligned columns, below a title.
std::string matrix_text(const std::string& title, const AxisMatrix<double>& matrix);

/// Adds the pose to the output, with whether it can be assembled and whether it is feasible.
void report_pose(const MechanismInfo& info, const Pose<double>& at, const PoseReport& report, Printout& out);
/// Error message if the mechanism cannot be assembled at the pose in `mode`; "" if it can.
std::string assembly_error(const std::string& mode, const PoseReport& report);

}  // namespace pkm
