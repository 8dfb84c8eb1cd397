#include "experiments/app/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/config/assignments.hpp"
#include "engine/core/team.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/tolerance_analysis.hpp"
#include "experiments/app/running.hpp"

namespace pkm {
namespace {

/// Reports the derivatives of all quantities, per mm of lengths and per degree of angles: a row for each parameter that
/// has an influence, in decreasing order of the influence on the first quantity.
void report_gradients(const std::vector<Parameter>& parameters, const std::vector<QuantityGradient>& gradients,
                      Printout& out) {
  std::vector<std::size_t> order(parameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto per_unit = [&](const QuantityGradient& g, std::size_t i) {
    return g.by[i] * display_unit(parameters[i].unit).size;
  };
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return std::fabs(per_unit(gradients[0], i)); });
  std::vector<Row> rows = {{"", "per unit"}};
  for (const QuantityGradient& g : gradients) rows[0].push_back(g.name + (g.unit == "1" ? "" : " [" + g.unit + "]"));
  for (const std::size_t i : order) {
    if (std::ranges::all_of(gradients, [i](const QuantityGradient& g) { return g.by[i] == 0; })) continue;
    Row& row = rows.emplace_back(Row{parameters[i].name, display_unit(parameters[i].unit).name});
    for (const QuantityGradient& g : gradients) row.push_back(g.by[i] == 0 ? "0" : signed_digits(per_unit(g, i)));
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
    // Names, units and ranges of the tolerances. A tolerance is not restricted to the bounds of its parameter.
    std::vector<Assignable> known;
    for (const Parameter& p : info.parameters) known.push_back({p.name, p.unit});
    each = parse_some_assignments(lists, place.key, known);
  }
  for (const double one : each)
    if (one < 0) throw ConfigError(place, shortest(one), "a tolerance >= 0");
  return each;
}

// Contributions that are smaller, relative to the largest one, are rounding errors.
constexpr double kNegligible = 1e-9;

/// Reports the contributions of the tolerances to the change of each quantity, the largest first.
void report_contributions(const std::vector<Parameter>& parameters, const std::vector<QuantityGradient>& gradients,
                          const std::vector<double>& each, Printout& out) {
  for (const QuantityGradient& g : gradients) {
    std::vector<std::pair<double, std::size_t>> contributions;
    Json json = Json::object();
    double squares = 0;
    double largest = 0;
    for (std::size_t i = 0; i < each.size(); ++i) largest = std::fmax(largest, std::fabs(g.by[i]) * each[i]);
    for (std::size_t i = 0; i < each.size(); ++i) {
      const double contribution = std::fabs(g.by[i]) * each[i];
      if (each[i] > 0) json[parameters[i].name] = contribution;
      if (contribution > kNegligible * largest) contributions.emplace_back(contribution, i);
      squares += contribution * contribution;
    }
    out.json["contributions"][g.name] = json;
    if (contributions.empty()) continue;
    std::ranges::stable_sort(contributions, std::greater(), [](const auto& one) { return one.first; });
    std::vector<Row> rows = {
        {"", "tolerance", "change" + (g.unit == "1" ? "" : " [" + g.unit + "]"), "share of the variance [%]"}};
    for (const auto& [contribution, i] : contributions) {
      const DisplayUnit unit = display_unit(parameters[i].unit);
      rows.push_back({parameters[i].name, "+-" + digits(each[i] / unit.size) + " " + unit.name, digits(contribution),
                      formatted("%.1f", 100 * contribution * contribution / squares)});
    }
    out.add_table("contributions to " + g.name, rows);
  }
}

/// Reports the worst case of each quantity for parameters within +- their tolerances: to first order, and evaluated at
/// the vertex of the tolerance box that is worst to first order; and the root of the sum of squared contributions.
void report_worst_cases(const DesignProblem& problem, const DesignReport& report,
                        const std::vector<QuantityGradient>& gradients, const std::vector<double>& each,
                        Printout& out) {
  std::vector<Row> rows = {{"", "nominal", "worst case, first order", "evaluated at that corner", "RSS"}};
  out.json["tolerance"] = values_by_name(problem.parts().mechanism->info().parameters, each);
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    const QuantityGradient& g = gradients[k];
    const auto [worst, rss, evaluated] = worst_case(problem, report, gradients, k, each);
    rows.push_back({g.name, result_text(g.value, g.unit), result_text(worst, g.unit), result_text(evaluated, g.unit),
                    "+-" + result_text(rss, g.unit)});
    out.json["worst_case"][g.name] = {{"nominal", g.value},
                                      {"first_order", worst},
                                      {"evaluated", std::isnan(evaluated) ? Json() : Json(evaluated)},
                                      {"rss", rss}};
  }
  out.add_table("worst case within the tolerances", rows);
}

struct SensitivityCommand : DesignArguments, SensitivityArguments {
  int threads = 0;
};

/// Reports contributions and worst cases for machines built within the tolerances of the table [tolerance] of the
/// study.
void report_built_machine(const Study& study, const std::vector<double>& parameters, Printout& out) {
  const DesignProblem& machine = *study.machine;
  if (const Unsupported reason = machine.why_no_derivatives())
    throw ConfigError({study.file_name, 0, "tolerance"}, "contributions need derivatives, but " + *reason);
  std::vector<double> built = parameters;
  built.resize(built.size() + study.tolerances->copies.size());
  for (const auto& [own, common] : study.tolerances->copies) built[own] = parameters[common];
  std::vector<double> each(built.size());
  for (const ParameterError& error : study.tolerances->errors) each[error.parameter] = error.bound;
  const DesignReport report = machine.report(built);
  if (!report.reason.empty()) throw DesignError(report.reason);
  const std::vector<QuantityGradient> gradients = quantity_gradients(machine, report);
  report_contributions(machine.parts().mechanism->info().parameters, gradients, each, out);
  report_worst_cases(machine, report, gradients, each, out);
}

std::string analyse_sensitivity(const Target& target, const SensitivityCommand& arguments, Printout& out) {
  if (!target.study)
    throw ConfigError({arguments.target, 0, ""}, "a mechanism",
                      "a study, whose objectives and constraints are analysed; see 'pkmopt evaluate --sensitivity'");
  const Study& study = *target.study;
  const bool has_tolerances = study.tolerances && arguments.tolerance.empty();
  out.add("mechanism", target.info().name);
  out.head.push_back({"study", study.name});
  std::string failure;
  with_team(arguments.threads, [&] {
    const DesignReport report = study.problem->report(target.parameters);
    failure = report.reason;
    if (!failure.empty()) return;
    SensitivityArguments requested = arguments;
    requested.sensitivity = !has_tolerances || !study.problem->why_no_derivatives();
    report_sensitivities(*study.problem, report, requested, out);
    if (has_tolerances) report_built_machine(study, target.parameters, out);
  });
  return failure.empty() ? "" : "the evaluation failed: " + failure;
}

/// Declares --tolerance.
void add_tolerance_option(CLI::App& command, SensitivityArguments& arguments) {
  add_option(command, "--tolerance TOL|NAME=TOL", arguments.tolerance,
             "Print the worst case within tolerances: 0.1mm for all lengths, or by name such as a=0.1mm")
      ->allow_extra_args(false);
}

}  // namespace

void add_sensitivity(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<SensitivityCommand>(
      app, session, "sensitivity", "Rank the effects of parameters and of their tolerances.",
      "Prints the derivatives of all objectives and margins of a study, and for its table [tolerance] the "
      "contribution\n"
      "of every error, the worst corner of the tolerance box to first order and evaluated, and the root of the sum of\n"
      "squares (RSS). Needs derivatives (workspace.method columns).\n"
      "Example: pkmopt sensitivity experiments/mechanisms/tolerances/delta-robust.toml",
      [](const Target& target, const SensitivityCommand& given, Printout& out) {
        return analyse_sensitivity(target, given, out);
      });
  add_tolerance_option(command, arguments);
  add_threads(command, arguments.threads);
}

void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments) {
  command.add_flag("--sensitivity", arguments.sensitivity,
                   "Print the derivatives of objectives and margins by each parameter (workspace.method columns)");
  add_tolerance_option(command, arguments);
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
  if (!arguments.tolerance.empty()) {
    const std::vector<double> each = tolerances(info, arguments.tolerance);
    report_contributions(info.parameters, gradients, each, out);
    report_worst_cases(problem, report, gradients, each, out);
  }
}

}  // namespace pkm
