// `pkmopt evaluate`: everything that is known of one design.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/core/team.hpp"
#include "experiments/app/catalogue_json.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kBareCells = 40;

/// The problem of a bare mechanism: exact columns where it has them, else voxels, no limits, and every objective that
/// serves it by its defaults.
std::shared_ptr<const DesignProblem> default_problem(const Target& target, const Catalogues& catalogues) {
  ProblemParts parts;
  parts.mechanism = target.mechanism;
  parts.parameters = target.parameters;
  parts.plan.limits = target.limits;
  if (!target.mechanism->columns()) parts.plan.method = equal_cells(target.info().sweeps.front(), kBareCells);
  for (const auto& entry : catalogues.objectives) {
    if (needs_options(entry.options) || !entry.refusal(*target.mechanism).empty()) continue;
    const Options options = default_options(entry.options);
    const EntryContext context{*target.mechanism, parts.plan, options};
    entry.demand(context, parts.demand);
    parts.objectives.push_back({entry.name,
                                entry.unit(context),
                                entry.meaning,
                                entry.direction,
                                entry.make(context),
                                0,
                                entry.reads_survey,
                                {},
                                {}});
  }
  try {
    return std::make_shared<const DesignProblem>(std::move(parts));
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
}

Json workspace_json(const DesignProblem& problem, const Survey<double>& survey) {
  const SurveyPlan& plan = problem.parts().plan;
  const bool voxels = plan.voxels();
  Json json = {{"method", voxels ? "voxels" : "columns"},
               {"volume", survey.volume},
               {"unit", volume_unit(problem.parts().mechanism->info(), plan)}};
  if (voxels) {
    json["cells"] = survey.cells;
    json["feasible_cells"] = survey.feasible_cells;
    json["cell_volume"] = survey.cell_volume;
    // The default box ends where the mechanism does, so touching it says nothing.
    json["touches_box"] = plan.box() ? Json(survey.touches_box) : Json();
  } else {
    json["columns"] = survey.columns;
    // Fixed nodes come without an estimate.
    json["relative_error"] = plan.columns()->nodes[0] > 0 ? Json() : Json(survey.error);
  }
  return json;
}

Json report_json(const DesignProblem& problem, const DesignReport& report) {
  const ProblemParts& parts = problem.parts();
  const MechanismInfo& info = parts.mechanism->info();
  return {{"mechanism", info.name},
          {"parameters", values_by_name(info.parameters, report.parameters)},
          {"workspace", report.status == Status::failed ? Json() : workspace_json(problem, report.survey)},
          {"objectives", values_by_name(problem.objectives(), report.objectives)},
          {"constraints", values_by_name(problem.margins(), report.margins)},
          {"reports", values_by_name(problem.reports(), report.reports)},
          {"feasible", report.status == Status::feasible},
          {"facts", values_by_name(parts.mechanism->facts(report.parameters, parts.plan.limits))}};
}

/// The constraints that do not hold, as "no: ...".
std::string verdict(const DesignProblem& problem, const DesignReport& report) {
  if (report.status == Status::feasible) return "yes";
  std::vector<std::string> broken;
  for (std::size_t i = 0; i < report.margins.size(); ++i)
    if (report.margins[i] < 0) broken.push_back(problem.margins()[i].name);
  return "no: " + (report.status == Status::failed ? report.reason : join(broken) + " violated");
}

std::vector<Row> workspace_rows(const DesignProblem& problem, const Survey<double>& survey) {
  const SurveyPlan& plan = problem.parts().plan;
  const std::string unit = volume_unit(problem.parts().mechanism->info(), plan);
  const bool voxels = plan.voxels();
  std::vector<Row> rows = {{"method", voxels ? "voxels" : "columns"}, {"volume", number(survey.volume, unit)}};
  if (voxels) {
    rows.push_back({"feasible cells", std::to_string(survey.feasible_cells) + " of " + std::to_string(survey.cells)});
    rows.push_back({"cell volume", number(survey.cell_volume, unit)});
    if (plan.box() && survey.touches_box) rows.push_back({"warning", "the feasible set touches the box: it may go on"});
  } else {
    rows.push_back({"columns", std::to_string(survey.columns)});
    if (plan.columns()->nodes[0] == 0) rows.push_back({"relative error", number(survey.error)});
  }
  return rows;
}

void print_report(const Target& target, const DesignProblem& problem, const DesignReport& report) {
  const MechanismInfo& info = target.info();
  std::vector<Row> head = {{"mechanism", info.name}};
  if (target.study) head.push_back({"study", target.study->name});
  head.push_back({"feasible", verdict(problem, report)});
  std::cout << aligned(head);

  std::vector<Row> parameters, objectives, margins, reports, facts;
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    parameters.push_back(
        {info.parameters[i].name, number(report.parameters[i], info.parameters[i].unit), info.parameters[i].meaning});
  for (std::size_t i = 0; i < report.objectives.size(); ++i) {
    const ObjectiveInfo& o = problem.objectives()[i];
    objectives.push_back({o.name, number(report.objectives[i], o.unit),
                          o.direction == Direction::maximise ? "maximise" : "minimise", o.meaning});
  }
  for (std::size_t i = 0; i < report.margins.size(); ++i) {
    const MarginInfo& m = problem.margins()[i];
    margins.push_back(
        {m.name, number(report.margins[i], m.unit), report.margins[i] >= 0 ? "holds" : "violated", m.meaning});
  }
  for (std::size_t i = 0; i < report.reports.size(); ++i) {
    const ReportInfo& r = problem.reports()[i];
    reports.push_back({r.name, number(report.reports[i], r.unit), r.meaning});
  }
  for (const auto& [name, value] : target.mechanism->facts(report.parameters, problem.parts().plan.limits))
    facts.push_back({name, number(value)});
  print_section(std::cout, "parameters", parameters);
  if (report.status != Status::failed) print_section(std::cout, "workspace", workspace_rows(problem, report.survey));
  print_section(std::cout, "objectives", objectives);
  print_section(std::cout, "constraints (margins: >= 0 holds)", margins);
  print_section(std::cout, "reports", reports);
  print_section(std::cout, "facts", facts);
}

int evaluate(const Catalogues& catalogues, const DesignArguments& arguments, int threads) {
  const Target target = find_target(catalogues, arguments);
  const auto problem = target.study ? target.study->problem : default_problem(target, catalogues);
  DesignReport report;
  with_team(threads, [&] { report = problem->report(target.parameters); });
  if (arguments.json)
    print_json(std::cout, report_json(*problem, report));
  else
    print_report(target, *problem, report);
  if (report.status == Status::failed) throw std::runtime_error("the evaluation failed: " + report.reason);
  return kDone;
}

}  // namespace

void add_evaluate(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<DesignArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "One design: all objectives, margins and the workspace.");
  add_design_arguments(*command, *arguments);
  command->footer(
      "A study is evaluated as it says, at its baseline, else at its parameters. A bare mechanism is surveyed by\n"
      "exact columns without limits, for every objective that serves it. An infeasible design is no error.\n"
      "Example: pkmopt evaluate experiments/4ppa-2par/paper-problem.toml --set a=0.3,b=1 --json");
  const auto threads = std::make_shared<int>(0);
  add_threads(*command, *threads);
  command->callback(
      [&session, arguments, threads] { session.exit_code = evaluate(session.catalogues, *arguments, *threads); });
}

}  // namespace pkm
