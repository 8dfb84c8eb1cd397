#include "experiments/app/tolerance_report.hpp"

#include <cmath>

#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

using generic::ToleranceViolation;

/// Text of a tolerance in the display unit: "+-0.1181 mm". What is certified is rounded down (direction -1), what is
/// violated up (1).
std::string tolerance_text(double tolerance, const std::string& si_unit, int direction) {
  const DisplayUnit unit = display_unit(si_unit);
  return "+-" + directed_digits(tolerance / unit.size, significant_digits(), direction) +
         (unit.name == "1" ? "" : " " + unit.name);
}

/// Text of a value in a unit that suits its size, with at least seven digits, because the robots differ little.
std::string value_text(double value, const std::string& si_unit) {
  const DisplayUnit unit = display_unit(si_unit);
  return digits(value / unit.size, 7) + (unit.name == "1" ? "" : " " + unit.name);
}

}  // namespace

void ToleranceReport::add_to(Printout& out) const {
  const MechanismInfo& info = target_.info();
  out.json["certified"] = by_name(found_.scale);
  out.head.push_back({"certified", design_fails() ? "none" : text_of(found_.scale, -1)});
  if (found_.violation) {
    const ToleranceViolation& violation = *found_.violation;
    out.json["violation"] = {{"what", violation.constraint},
                             {"tolerance", by_name(violation.scale)},
                             {"parameters", values_by_name(info.parameters, violation.parameters)},
                             {"pose", axes_json(info.coordinates, violation.pose)},
                             {"time", json_or_null(violation.time)}};
    out.head.push_back(
        {"violation", (design_fails() ? "of the design itself: " : "at " + text_of(violation.scale, 1) + ": ") +
                          violation.constraint + " at " +
                          (violation.time ? "t = " + number(*violation.time, "s") + ", " : "") +
                          axes_text(info.coordinates, violation.pose)});
  } else {
    out.json["violation"] = nullptr;
    out.head.push_back({"violation", "none was found up to " + text_of(found_.largest_scale, -1)});
  }
  if (design_fails()) return;
  out.json["singularities"] = found_.no_singularities ? "not examined" : "none";
  out.head.push_back({"singularities", found_.no_singularities ? "not examined, because " + *found_.no_singularities
                                                               : "none within the certified tolerances"});
  out.add("boxes", found_.boxes, std::to_string(found_.boxes) + " examined");
  std::vector<Row> rows = {{"", "design", "certified"}};
  if (found_.violation) rows.front().emplace_back("robot of the violation");
  for (std::size_t i = 0; i < proportions_.parameters.size(); ++i) {
    const Parameter& parameter = info.parameters[proportions_.parameters[i]];
    const double value = target_.parameters[proportions_.parameters[i]];
    rows.push_back({parameter.name, value_text(value, parameter.unit),
                    tolerance_text(tolerance(i, found_.scale), parameter.unit, -1)});
    if (found_.violation)
      rows.back().push_back(value_text(found_.violation->parameters[proportions_.parameters[i]], parameter.unit));
  }
  out.add_table("tolerances", rows);
}

CsvTable ToleranceReport::table() const {
  CsvTable table({"parameter", "unit", "design", "certified", "violation"});
  for (std::size_t i = 0; i < proportions_.parameters.size(); ++i) {
    const std::size_t parameter = proportions_.parameters[i];
    table.row(target_.info().parameters[parameter].name, target_.info().parameters[parameter].unit,
              target_.parameters[parameter], tolerance(i, found_.scale));
    if (found_.violation)
      table.add(found_.violation->parameters[parameter]);
    else
      table.add_empty(1);
  }
  return table;
}

std::string ToleranceReport::shortfall(double gap, std::int64_t max_boxes) const {
  const double target = found_.violation ? found_.violation->scale * (1 - gap) : found_.largest_scale;
  if (design_fails()) return "the design itself does not do the task";
  if (found_.scale >= target) return "";
  if (found_.stopped) return "stopped before the requested gap was reached";
  if (found_.boxes >= static_cast<std::size_t>(max_boxes))
    return "the requested gap needs more than " + std::to_string(max_boxes) + " boxes (--boxes)";
  return "the requested gap cannot be reached: the remaining boxes cannot be decided in double precision";
}

std::string ToleranceReport::text_of(double scale, int direction) const {
  const auto text = [&](std::size_t i) {
    return tolerance_text(tolerance(i, scale), target_.info().parameters[proportions_.parameters[i]].unit, direction);
  };
  for (std::size_t i = 1; i < proportions_.parameters.size(); ++i)
    if (text(i) != text(0)) return relative_text(scale);
  return text(0);
}

std::string ToleranceReport::relative_text(double scale) const {
  if (scale == found_.scale) return "the tolerances below";
  return found_.scale > 0 ? digits(scale / found_.scale) + " times these tolerances"
                          : "the deviations in the last column";
}

Json ToleranceReport::by_name(double scale) const {
  Json all = Json::object();
  for (std::size_t i = 0; i < proportions_.parameters.size(); ++i)
    all[target_.info().parameters[proportions_.parameters[i]].name] = tolerance(i, scale);
  return all;
}

}  // namespace pkm
