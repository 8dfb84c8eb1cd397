#include "experiments/app/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/config/assignments.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/tolerance_analysis.hpp"

namespace pkm {
namespace {

/// Reports the derivatives, per mm of lengths and per degree of angles: a row for each parameter that has an influence,
/// in decreasing order of the influence on the first quantity.
void report_gradients(const std::vector<Parameter>& parameters, const std::vector<QuantityGradient>& gradients,
                      Printout& out) {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto per_unit = [&](const QuantityGradient& g, std::size_t i) {
    return g.by[i] * display_unit(parameters[i].unit).size;
  };
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return std::fabs(per_unit(gradients[0], i)); });
  std::vector<Row> rows = {{"", "per"}};
  for (const QuantityGradient& g : gradients) rows[0].push_back(g.name + (g.unit == "1" ? "" : " [" + g.unit + "]"));
  for (const std::size_t i : order) {
    if (std::ranges::all_of(gradients, [i](const QuantityGradient& g) { return g.by[i] == 0; })) continue;
    Row& row = rows.emplace_back(Row{parameters[i].name, display_unit(parameters[i].unit).name});
    for (const QuantityGradient& g : gradients) row.push_back(g.by[i] == 0 ? "0" : formatted("%+.4g", per_unit(g, i)));
  }
  out.add_table("sensitivities: derivatives with all other parameters fixed", rows);
  for (const QuantityGradient& g : gradients) out.json["sensitivities"][g.name] = values_by_name(parameters, g.by);
}

/// Parses --tolerance: one tolerance for all lengths or all angles, or tolerances of parameters by name.
/// @return tolerances [SI] of all parameters, >= 0
std::vector<double> tolerances(const MechanismInfo& info, const std::vector<std::string>& lists) {
  const SourceLocation place{"", 0, "--tolerance"};
  std::vector<double> each;
  if (lists.size() == 1 && lists[0].find('=') == std::string::npos) {
    const auto length = parse_quantity(lists[0], "m"), angle = parse_quantity(lists[0], "rad");
    if (!length && !angle)
      throw ConfigError(place, "'" + lists[0] + "'", "a length, an angle, or tolerances by name such as a=0.1mm");
    for (const Parameter& p : info.parameters)
      each.push_back(p.unit == "m" ? length.value_or(0) : p.unit == "rad" && !length ? *angle : 0);
  } else {
    std::vector<Assignable> known;  // a tolerance is not subject to the bounds of its parameter
    for (const Parameter& p : info.parameters) known.push_back({p.name, p.unit});
    each = parse_some_assignments(lists, place.key, known);
  }
  for (const double one : each)
    if (one < 0) throw ConfigError(place, shortest(one), "a tolerance >= 0");
  return each;
}

/// Reports the worst case of each quantity for parameters within +- their tolerances: to first order, and evaluated at
/// the corner of the tolerance box that is the worst to first order.
void report_worst_cases(const DesignProblem& problem, const DesignReport& report,
                        const std::vector<QuantityGradient>& gradients, const std::vector<double>& each,
                        Printout& out) {
  std::vector<Row> rows = {{"", "nominal", "worst case, first order", "evaluated at that corner"}};
  out.json["tolerance"] = values_by_name(problem.parts().mechanism->info().parameters, each);
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    const QuantityGradient& g = gradients[k];
    const auto [worst, evaluated] = worst_case(problem, report, gradients, k, each);
    rows.push_back({g.name, number(g.value, g.unit), number(worst, g.unit), number(evaluated, g.unit)});
    out.json["worst_case"][g.name] = {
        {"nominal", g.value}, {"first_order", worst}, {"evaluated", std::isnan(evaluated) ? Json() : Json(evaluated)}};
  }
  out.add_table("worst case within the tolerances", rows);
}

}  // namespace

void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments) {
  command.add_flag("--sensitivity", arguments.sensitivity,
                   "Print the derivatives of objectives and margins by each parameter (workspace.method columns)");
  add_option(command, "--tolerance TOL|NAME=TOL", arguments.tolerance,
             "Print the worst case within tolerances: 0.1mm for all lengths, or by name such as a=0.1mm")
      ->allow_extra_args(false);
}

void report_sensitivities(const DesignProblem& problem, const DesignReport& report,
                          const SensitivityArguments& arguments, Printout& out) {
  if (!arguments.sensitivity && arguments.tolerance.empty()) return;
  if (const Unsupported reason = problem.why_no_derivatives())
    throw ConfigError({"", 0, arguments.sensitivity ? "--sensitivity" : "--tolerance"},
                      "needs derivatives, but " + *reason);
  const MechanismInfo& info = problem.parts().mechanism->info();
  const std::vector<QuantityGradient> gradients = quantity_gradients(problem, report);
  if (gradients.empty()) return;
  if (arguments.sensitivity) report_gradients(info.parameters, gradients, out);
  if (!arguments.tolerance.empty())
    report_worst_cases(problem, report, gradients, tolerances(info, arguments.tolerance), out);
}

}  // namespace pkm
