// Values of coordinates and joints, from the command line, as text and as JSON; matrices between them.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "experiments/app/print.hpp"

namespace pkm {

using Axes = std::vector<AxisInfo>;

AxisVector<double> axis_vector(std::span<const double> values);

/// Of the force that drives a joint: "N" or "N m".
inline std::string force_unit(const AxisInfo& joint) { return joint.turns() ? "N m" : "N"; }
/// Each unit once, in the order of the axes, with `behind` after it: "m/s, rad/s".
std::string units_of(const Axes& axes, const std::string& behind = "");
std::string force_units_of(const Axes& joints);

/// "x = 0.25 m, theta = 0.5 rad"
std::string axes_text(const Axes& axes, std::span<const double> values);
/// By name; null where they do not exist.
Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values);
/// A list.
Json vector_json(std::span<const double> values);
/// A list of rows.
Json matrix_json(const AxisMatrix<double>& matrix);
void print_matrix(std::ostream& out, const std::string& title, const AxisMatrix<double>& matrix);

}  // namespace pkm
