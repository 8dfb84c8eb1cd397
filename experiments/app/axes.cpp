#include "experiments/app/axes.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace pkm {

AxisVector<double> axis_vector(std::span<const double> values) {
  AxisVector<double> vector(values.size());
  std::ranges::copy(values, vector.begin());
  return vector;
}

std::string axes_text(const Axes& axes, std::span<const double> values) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < axes.size(); ++i) texts.push_back(axes[i].name + " = " + number(values[i], axes[i].unit));
  return join(texts);
}

std::string large_angle_note(const Axes& axes, std::span<const double> values) {
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].unit == "rad" && std::fabs(values[i]) > 2 * std::numbers::pi)
      return axes[i].name + " exceeds one revolution; for degrees, write " + axes[i].name + "=" +
             formatted("%.6g", values[i]) + "deg";
  return "";
}

Json axes_json(const Axes& axes, const std::optional<AxisVector<double>>& values) {
  return values ? values_by_name(axes, *values) : Json();
}

Json matrix_json(const std::optional<AxisMatrix<double>>& matrix) {
  Json rows;
  for (std::size_t i = 0; matrix && i < matrix->rows(); ++i)
    rows.push_back(vector_json({matrix->begin() + i * matrix->cols(), matrix->cols()}));
  return rows;
}

std::string matrix_text(const std::string& title, const AxisMatrix<double>& matrix) {
  std::string text = '\n' + title + '\n';
  const std::size_t width = 8 + static_cast<std::size_t>(significant_digits());  // "-1.234e-05", two blanks before it
  for (std::size_t i = 0; i < matrix.rows(); ++i, text += '\n')
    for (std::size_t j = 0; j < matrix.cols(); ++j) {
      const std::string cell = digits(matrix(i, j));
      text += std::string(cell.size() < width ? width - cell.size() : 1, ' ') + cell;
    }
  return text;
}

void report_pose(const MechanismInfo& info, const Pose<double>& at, const PoseReport& report, Printout& out) {
  out.add("pose", axes_json(info.coordinates, at), axes_text(info.coordinates, at));
  if (const std::string note = large_angle_note(info.coordinates, at); !note.empty())
    out.head.push_back({"note", note});
  out.json["feasible"] = report.feasible;
  out.add("assembles", report.assembles, report.assembles ? "yes" : "no: " + report.reason);
  out.json["reason"] = text_or_null(report.reason);
  out.head.push_back({"feasible", report.feasible ? "yes" : "no"});
}

std::string assembly_error(const std::string& mode, const PoseReport& report) {
  return report.assembles ? "" : "the pose does not assemble in mode " + mode + ": " + report.reason;
}

}  // namespace pkm
