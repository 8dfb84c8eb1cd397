#include "experiments/app/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/unit.hpp"
#include "engine/setup/assignments.hpp"

namespace pkm {
namespace {

/// An objective or a margin of the design, with its derivatives by all parameters.
struct Slope {
  std::string name, unit;
  double value;
  double worse;  ///< which way is: -1 or 1
  std::span<const double> by;
};

std::vector<Slope> slopes_of(const DesignProblem& problem, const DesignReport& report,
                             const std::vector<double>& slopes) {
  const std::size_t width = report.parameters.size() + 1;  // a value before the derivatives
  std::vector<Slope> found;
  const auto add = [&](const std::string& name, const std::string& unit, double value, bool down) {
    found.push_back(
        {name, unit, value, down ? -1.0 : 1.0, std::span(slopes).subspan(found.size() * width + 1, width - 1)});
  };
  for (std::size_t k = 0; k < report.objectives.size(); ++k) {
    const ObjectiveInfo& o = problem.objectives()[k];
    add(o.name, o.unit, report.objectives[k], o.direction == Direction::maximise);
  }
  for (std::size_t k = 0; k < report.margins.size(); ++k) {
    const MarginInfo& m = problem.margins()[k];
    add(m.name + " margin", m.unit, report.margins[k], true);
  }
  return found;
}

/// A row for each parameter with an influence, that with the greatest on the first quantity first; lengths per mm,
/// angles per degree.
void tell_slopes(const std::vector<Parameter>& parameters, const std::vector<Slope>& slopes, Printout& out) {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto per_step = [&](const Slope& slope, std::size_t i) { return slope.by[i] * handy(parameters[i].unit).size; };
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return std::fabs(per_step(slopes[0], i)); });
  std::vector<Row> rows = {{"", "per"}};
  for (const Slope& slope : slopes) rows[0].push_back(slope.name + (slope.unit == "1" ? "" : " [" + slope.unit + "]"));
  for (const std::size_t i : order) {
    if (std::ranges::all_of(slopes, [i](const Slope& slope) { return slope.by[i] == 0; })) continue;
    Row& row = rows.emplace_back(Row{parameters[i].name, handy(parameters[i].unit).unit});
    for (const Slope& slope : slopes) row.push_back(slope.by[i] == 0 ? "0" : formatted("%+.4g", per_step(slope, i)));
  }
  out.section("sensitivities, the rest of the design as it is", rows);
  for (const Slope& slope : slopes) out.json["sensitivities"][slope.name] = values_by_name(parameters, slope.by);
}

/// Tolerances [SI] by parameter: one for all lengths or angles, or by name.
std::vector<double> tolerances(const MechanismInfo& info, const std::vector<std::string>& lists) {
  const SourcePlace place{"", 0, "--tolerance"};
  std::vector<double> each;
  if (lists.size() == 1 && lists[0].find('=') == std::string::npos) {
    const auto length = parse_quantity(lists[0], "m"), angle = parse_quantity(lists[0], "rad");
    if (!length && !angle)
      throw ConfigError(place, "'" + lists[0] + "'", "a length, an angle, or parameters with theirs, such as a=0.1mm");
    for (const Parameter& p : info.parameters)
      each.push_back(p.unit == "m" ? length.value_or(0) : p.unit == "rad" && !length ? *angle : 0);
  } else {
    std::vector<Assignable> known;  // without the bounds of the parameters themselves
    for (const Parameter& p : info.parameters) known.push_back({p.name, p.unit});
    each = parse_some_assignments(lists, place.key, known);
  }
  for (const double one : each)
    if (one < 0) throw ConfigError(place, shortest(one), "a tolerance >= 0");
  return each;
}

/// The worst that parameters within +- their tolerances make of each quantity: to first order, and as the design in the
/// corner is evaluated that the derivatives name.
void tell_tolerances(const DesignProblem& problem, const DesignReport& report, const std::vector<Slope>& slopes,
                     const std::vector<double>& each, Printout& out) {
  std::vector<Row> rows = {{"", "nominal", "worst, to first order", "evaluated there"}};
  out.json["tolerance"] = values_by_name(problem.parts().mechanism->info().parameters, each);
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const Slope& slope = slopes[k];
    std::vector<double> corner = report.parameters;
    double change = 0;
    for (std::size_t i = 0; i < corner.size(); ++i) {
      change += std::fabs(slope.by[i]) * each[i];
      if (slope.by[i] != 0) corner[i] += std::copysign(each[i], slope.worse * slope.by[i]);
    }
    const DesignReport there = problem.report(corner);
    const bool objective = k < report.objectives.size();
    const double evaluated = there.status == Status::failed ? std::nan("")
                             : objective                    ? there.objectives[k]
                                                            : there.margins[k - report.objectives.size()];
    const double worst = slope.value + slope.worse * change;
    rows.push_back(
        {slope.name, number(slope.value, slope.unit), number(worst, slope.unit), number(evaluated, slope.unit)});
    out.json["worst_case"][slope.name] = {{"nominal", slope.value},
                                          {"first_order", worst},
                                          {"evaluated", std::isnan(evaluated) ? Json() : Json(evaluated)}};
  }
  out.section("worst case within the tolerances", rows);
}

}  // namespace

void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments) {
  command.add_flag("--sensitivity", arguments.sensitivity,
                   "What a step of each parameter changes, by derivatives of exact columns");
  add_option(command, "--tolerance TOL|NAME=TOL", arguments.tolerance,
             "Worst case of parameters that are off by as much, as 0.1mm for all lengths, or by name")
      ->allow_extra_args(false);
}

void tell_sensitivities(const DesignProblem& problem, const DesignReport& report, const SensitivityArguments& arguments,
                        Printout& out) {
  if (!arguments.sensitivity && arguments.tolerance.empty()) return;
  if (const Refusal reason = problem.no_derivatives())
    throw ConfigError({"", 0, arguments.sensitivity ? "--sensitivity" : "--tolerance"}, *reason, "derivatives");
  const MechanismInfo& info = problem.parts().mechanism->info();
  std::vector<std::size_t> all(report.parameters.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<double> values = problem.slopes(report.parameters, all);
  const std::vector<Slope> slopes = slopes_of(problem, report, values);
  if (slopes.empty()) return;
  if (arguments.sensitivity) tell_slopes(info.parameters, slopes, out);
  if (!arguments.tolerance.empty())
    tell_tolerances(problem, report, slopes, tolerances(info, arguments.tolerance), out);
}

}  // namespace pkm
