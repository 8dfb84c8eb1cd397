// `pkmopt evaluate`: everything that is known of one design.

#include "engine/core/team.hpp"
#include "engine/problem/certain_volume.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/study/stop_request.hpp"
#include "engine/survey/survey_set.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/catalogue.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/sensitivity.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kBareCells = 40;

struct EvaluateArguments : DesignArguments, SensitivityArguments {
  int threads = 0;
  std::string certain;
};

/// The problem of a bare mechanism: exact columns where it has them, unless cells are given, else voxels, and every
/// objective that serves it, and these, by its defaults.
std::shared_ptr<const DesignProblem> default_problem(const Target& target, const Catalogues& catalogues,
                                                     const std::vector<std::string>& cells) {
  ProblemParts parts;
  parts.mechanism = target.mechanism;
  parts.parameters = target.parameters;
  parts.plan.limits = target.limits;
  const Sweep& sweep = target.info().sweeps.front();
  if (!target.mechanism->columns() || !cells.empty()) parts.plan.method = equal_cells(sweep, kBareCells);
  if (!cells.empty())
    std::ranges::copy(parse_cells(cells, coordinate_names(target.info(), sweep.swept)),
                      std::get<VoxelOptions>(parts.plan.method).cells.begin());
  for (const auto& entry : catalogues.objectives) {
    if (needs_options(entry.options) || entry.refusal(*target.mechanism)) continue;
    const Options options = default_options(entry.options);
    const EntryContext context{*target.mechanism, parts.plan, options};
    Demand demand = parts.demand;
    entry.demand(context, demand);
    if (parts.plan.columns() && of_cells_only(demand)) continue;
    parts.demand = demand;
    parts.objectives.push_back({.name = entry.name,
                                .unit = entry.unit(context),
                                .meaning = entry.meaning,
                                .direction = entry.direction,
                                .quantity = entry.make(context),
                                .reads_survey = entry.reads(context)});
  }
  try {
    return std::make_shared<const DesignProblem>(std::move(parts));
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
}

void tell_workspace(const DesignProblem& problem, const Survey<double>& survey, Printout& out) {
  const SurveyPlan& plan = problem.parts().plan;
  const std::string unit = volume_unit(problem.parts().mechanism->info(), plan);
  const std::string method = plan.voxels() ? "voxels" : "columns";
  Json json = {{"method", method}, {"volume", survey.volume}, {"unit", unit}};
  std::vector<Row> rows = {{"method", method}, {"volume", number(survey.volume, unit)}};
  if (plan.voxels()) {
    json["cells"] = survey.cells;
    json["feasible_cells"] = survey.feasible_cells;
    json["cell_volume"] = survey.cell_volume;
    // The default box ends where the mechanism does, so touching it says nothing.
    json["touches_box"] = plan.box() ? Json(survey.touches_box) : Json();
    rows.push_back({"feasible cells", std::to_string(survey.feasible_cells) + " of " + std::to_string(survey.cells)});
    rows.push_back({"cell volume", number(survey.cell_volume, unit)});
    if (plan.box() && survey.touches_box) rows.push_back({"warning", "the feasible set touches the box: it may go on"});
  } else {
    const bool estimated = plan.columns()->nodes[0] == 0;  // fixed nodes come without
    json["columns"] = survey.columns;
    json["relative_error"] = estimated ? Json(survey.error) : Json();
    rows.push_back({"columns", std::to_string(survey.columns)});
    if (estimated) rows.push_back({"relative error", number(survey.error)});
  }
  out.json["workspace"] = json;
  out.section("workspace", rows);
}

/// Bounds of the exact volume that neither rounding nor sampling can make wrong.
/// @param holds  the volume lies within
void tell_bounds(const VolumeBounds& bounds, double wanted, bool holds, const std::string& unit, Printout& out) {
  out.json["certain"] = {
      {"lower", bounds.lower}, {"upper", bounds.upper}, {"unit", unit}, {"gap", bounds.gap()}, {"holds_volume", holds}};
  out.section("certain bounds of the volume", {{"at least", number(bounds.lower, unit)},
                                               {"at most", number(bounds.upper, unit)},
                                               {"gap", number(bounds.gap()) + ", asked for " + number(wanted)}});
}

/// The report fails where its exact volume lies outside.
VolumeBounds bounds_of(const DesignProblem& problem, DesignReport& report, double gap) {
  const StopRequest stop;
  try {
    return check_volume(problem, report, gap, [] { return StopRequest::signal() != 0; });
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, "--certain"}, reason.what());
  }
}

/// The constraints that do not hold, as "no: ...".
std::string verdict(const DesignProblem& problem, const DesignReport& report) {
  if (report.status == Status::feasible) return "yes";
  std::vector<std::string> broken;
  for (std::size_t i = 0; i < report.margins.size(); ++i)
    if (report.margins[i] < 0) broken.push_back(problem.margins()[i].name);
  const std::string reason = report.reason.empty() ? "" : "; " + report.reason;
  return "no: " + (report.status == Status::failed ? report.reason : join(broken) + " violated" + reason);
}

std::string evaluate(const Catalogues& catalogues, const Target& target, const EvaluateArguments& arguments,
                     Printout& out) {
  const auto problem =
      target.study ? target.study->problem : default_problem(target, catalogues, arguments.changes.cells);
  const ColumnOptions* const columns = problem->parts().plan.columns();
  std::optional<double> gap = columns ? columns->certain : std::nullopt;
  if (!arguments.certain.empty()) {
    gap = parse_gap(arguments.certain, "--certain");
    needed(target.mechanism->bounds(), "--certain", "formulas that can be computed over intervals", target.info());
    if (!columns)
      throw ConfigError({"", 0, "--certain"}, "voxels", "workspace.method = \"columns\", whose exact volume it checks");
  }
  DesignReport report;
  std::optional<VolumeBounds> bounds;
  with_team(arguments.threads, [&] {
    report = problem->report(target.parameters);
    if (gap && report.status != Status::failed) bounds = bounds_of(*problem, report, *gap);
  });
  const bool failed = report.status == Status::failed, surveyed = !failed || bounds;

  /// Values with their units and what else is to be said of them.
  const auto tell = [&out](const std::string& key, const std::string& title, const auto& named,
                           const std::vector<double>& values, const auto& remark) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < values.size(); ++i) {
      Row& row = rows.emplace_back(Row{named[i].name, number(values[i], named[i].unit)});
      if (const std::string text = remark(named[i], values[i]); !text.empty()) row.push_back(text);
      row.push_back(named[i].meaning);
    }
    out.json[key] = values_by_name(named, values);
    out.section(title, rows);
  };
  const auto nothing = [](const auto&, double) { return ""; };
  out.say("mechanism", target.info().name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.head.push_back({"feasible", verdict(*problem, report)});
  tell("parameters", "parameters", target.info().parameters, report.parameters, nothing);
  out.json["workspace"] = nullptr;
  if (surveyed) tell_workspace(*problem, report.survey, out);
  if (bounds) tell_bounds(*bounds, *gap, !failed, volume_unit(target.info(), problem->parts().plan), out);
  tell("objectives", "objectives", problem->objectives(), report.objectives,
       [](const ObjectiveInfo& o, double) { return o.direction == Direction::maximise ? "maximise" : "minimise"; });
  tell("constraints", "constraints (margins: >= 0 holds)", problem->margins(), report.margins,
       [](const MarginInfo&, double margin) { return margin >= 0 ? "holds" : "violated"; });
  tell("reports", "reports", problem->reports(), report.reports, nothing);
  if (report.reason.empty())
    with_team(arguments.threads, [&] { tell_sensitivities(*problem, report, arguments, out); });
  out.json["feasible"] = report.status == Status::feasible;
  const NamedValues facts = target.mechanism->facts(report.parameters, problem->parts().plan.limits);
  out.json["facts"] = values_by_name(facts);
  out.section("facts", rows_of(facts));
  return failed ? "the evaluation failed: " + report.reason : "";
}

}  // namespace

void add_evaluate(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<EvaluateArguments>(
      app, session, "evaluate", "One design: all objectives, margins and the workspace.",
      "A study is evaluated as it says, at its baseline, else at its parameters. A bare mechanism is surveyed by\n"
      "exact columns without limits, for every objective that serves it. An infeasible design is no error.\n"
      "Example: pkmopt evaluate experiments/4ppa-2par/paper-problem.toml --set a=0.3,b=1 --json",
      [&session](const Target& target, const EvaluateArguments& given, Printout& out) {
        return evaluate(session.catalogues, target, given, out);
      });
  add_cells_option(command, arguments.changes.cells, "Cells of the study's voxels, or of a bare mechanism's");
  add_option(command, "--certain GAP", arguments.certain,
             "Check the exact volume of columns against certain bounds of this gap, as 'pkmopt certify' has them");
  add_sensitivity_options(command, arguments);
  add_threads(command, arguments.threads);
}

}  // namespace pkm
