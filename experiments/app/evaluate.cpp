// `pkmopt evaluate`: computes all objectives, constraint margins and outputs of one design and the measure of its
// workspace, or of all designs of a table.

#include <limits>

#include "engine/config/assignments.hpp"
#include "engine/core/team.hpp"
#include "engine/mechanism/proven_volume.hpp"
#include "engine/problem/volume_check.hpp"
#include "engine/runner/run_study.hpp"
#include "engine/runner/stop_request.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/catalogue.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/sensitivity.hpp"
#include "experiments/app/table_input.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kDefaultCells = 40;  // number of cells along each axis, for mechanisms without a study

struct EvaluateArguments : DesignArguments, SensitivityArguments {
  int threads = 0, workers = 0;
  std::string certified;
  TableJob designs;
};

/// The problem of a mechanism without a study: all objectives of its workspace that the mechanism and the method
/// support, with their default options. Objectives that need the pose of every sample are omitted, because most closed
/// forms do not store poses.
/// @param cells  number of cells along each axis, as given by --cells; empty: kDefaultCells
DesignProblem problem_of_all_objectives(const Target& target, const Catalogues& catalogues, bool by_columns,
                                        const std::vector<std::string>& cells) {
  ProblemParts parts;
  parts.mechanism = target.mechanism;
  parts.parameters = target.parameters;
  parts.plan.limits = target.limits;
  const Sweep& sweep = target.info().sweeps.front();
  if (!by_columns) parts.plan.method = equal_cells(sweep, kDefaultCells);
  if (!cells.empty())
    std::ranges::copy(parse_cells(cells, coordinate_names(target.info(), sweep.swept)),
                      std::get<VoxelOptions>(parts.plan.method).cells.begin());
  for (const auto& entry : catalogues.objectives) {
    if (needs_options(entry.options) || entry.refusal(*target.mechanism)) continue;
    const Options options = default_options(entry.options);
    const EntryContext context{*target.mechanism, parts.plan, options};
    FieldRequest request = parts.request;
    entry.request(context, request);
    if (!entry.reads(context) || request.poses) continue;
    if (parts.plan.columns() && first_cellwise_field(request)) continue;
    parts.request = request;
    parts.objectives.push_back({.name = entry.name,
                                .unit = entry.unit(context),
                                .meaning = entry.meaning,
                                .direction = entry.direction,
                                .quantity = entry.make(context),
                                .uses_workspace = entry.reads(context)});
  }
  return DesignProblem(std::move(parts));
}

struct ProblemOfMechanism {
  std::shared_ptr<const DesignProblem> problem;
  std::string why_voxels;  ///< the reason why voxels are used although the mechanism has columns; otherwise ""
};

/// The problem of a mechanism without a study: by exact columns if the mechanism has them and no numbers of cells are
/// given, otherwise by voxels.
ProblemOfMechanism default_problem(const Target& target, const Catalogues& catalogues,
                                   const std::vector<std::string>& cells) {
  ProblemOfMechanism made;
  const auto make = [&](bool by_columns) {
    made.problem =
        std::make_shared<const DesignProblem>(problem_of_all_objectives(target, catalogues, by_columns, cells));
  };
  try {
    if (target.mechanism->columns() && cells.empty()) make(true);
  } catch (const std::invalid_argument& reason) {
    made.why_voxels = reason.what();
  }
  try {
    if (!made.problem) make(false);
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, target.info().name}, reason.what());
  }
  return made;
}

/// The relative error of an exact volume, which follows from proven bounds of the volume; std::nullopt if there are
/// none. If the volume contradicts them, sets the status of `report` to failed.
std::optional<double> proven_error(const DesignProblem& problem, DesignReport& report) {
  const WorkspaceResult<double>& survey = report.workspace;
  if (!problem.parts().plan.columns() || survey.is_sampled || !(survey.volume > 0)) return {};
  // The evaluator is prepared for the working mode of the problem's own analysis.
  const auto evaluator =
      prepare_workspace(*problem.parts().mechanism, problem.parts().plan, {.mode = problem.parts().request.mode});
  const auto* const prover = dynamic_cast<const VolumeProver*>(evaluator.get());
  const auto bounds = prover ? prover->proven_volume(report.parameters) : std::nullopt;
  if (!bounds) return {};
  const double error = survey.volume * (survey.error + problem.parts().plan.columns()->tolerance);
  if (survey.volume + error < bounds->lower || survey.volume - error > bounds->upper) {
    report.status = Status::failed;
    report.reason = "its volume " + shortest(survey.volume) + " lies outside of the proven bounds " +
                    shortest(bounds->lower) + " and " + shortest(bounds->upper);
    return {};
  }
  return std::max(survey.volume - bounds->lower, bounds->upper - survey.volume) / survey.volume;
}

/// Number of digits of the workspace volume that its method determines.
int known_digits(const DesignProblem& problem, const WorkspaceResult<double>& survey) {
  const WorkspacePlan& plan = problem.parts().plan;
  if (!plan.voxels()) return kFullDigits;
  return known_digits_of_voxels(survey.feasible_cells, sweep_of(problem.parts().mechanism->info(), plan).swept.size());
}

/// Adds the measure of the workspace (volume, area or length) to the output.
/// @param proven  proven relative error of an exact volume; std::nullopt: none
/// @param note    remark on the method; may be empty
void report_workspace(const DesignProblem& problem, const WorkspaceResult<double>& survey,
                      const std::optional<double>& proven, const std::string& note, Printout& out) {
  const WorkspacePlan& plan = problem.parts().plan;
  const std::string unit = volume_unit(problem.parts().mechanism->info(), plan);
  const std::string method = plan.voxels() ? "voxels" : "columns";
  Json json = {{"method", method}, {"volume", survey.volume}, {"unit", unit}};
  const int known = known_digits(problem, survey);
  std::vector<Row> rows = {{"method", method},
                           {measure_name(sweep_of(problem.parts().mechanism->info(), plan).swept.size()),
                            number(survey.volume, unit, known)}};
  if (plan.voxels()) {
    json["cells"] = survey.cells;
    json["feasible_cells"] = survey.feasible_cells;
    json["cell_volume"] = survey.cell_volume;
    // The default box encloses all reachable poses, so that touching it has no meaning.
    json["touches_box"] = plan.box() ? Json(survey.touches_box) : Json();
    rows.push_back({"feasible cells", std::to_string(survey.feasible_cells) + " of " + std::to_string(survey.cells)});
    rows.push_back({"cell volume", number(survey.cell_volume, unit)});
    if (plan.box() && survey.touches_box)
      rows.push_back({"warning", "the feasible set touches the box: it may extend beyond"});
  } else {
    // False if the numbers of nodes are fixed, so that there is no error estimate.
    const bool estimated = plan.columns()->nodes[0] == 0;
    json["columns"] = survey.columns;
    const double tolerance = plan.columns()->tolerance;
    const bool certified = estimated && proven && *proven <= tolerance;
    json["relative_error"] = certified ? Json(*proven) : estimated ? Json(survey.error) : Json();
    json["certified"] = certified;
    rows.push_back({"columns", std::to_string(survey.columns)});
    if (certified)
      rows.push_back({"relative error", number(*proven) + ", certified to " + number(tolerance)});
    else if (estimated)
      rows.push_back(
          {"relative error", number(survey.error) + (survey.is_sampled ? ", as far as sampled" : ", estimated")});
  }
  if (plan.home) rows.push_back({"component", "only the one that holds the home pose counts"});
  if (!note.empty()) rows.push_back({"note", note});
  out.json["workspace"] = json;
  out.add_table("workspace", rows);
}

/// Adds certified bounds on the exact volume to the output.
/// @param holds  true if the computed volume lies within the bounds
void report_bounds(const VolumeBounds& bounds, double requested_gap, bool holds, const std::string& unit,
                   Printout& out) {
  const auto [lower, upper] = bounds_text(bounds.lower, bounds.upper, unit);
  out.json["certified"] = {
      {"lower", bounds.lower}, {"upper", bounds.upper}, {"unit", unit}, {"gap", bounds.gap()}, {"holds_volume", holds}};
  out.add_table("certified bounds", {{"at least", lower},
                                     {"at most", upper},
                                     {"gap", number(bounds.gap()) + ", requested " + number(requested_gap)}});
}

/// Computes certified bounds on the volume; sets the status of `report` to failed if its volume lies outside of them.
VolumeBounds certified_bounds(const DesignProblem& problem, DesignReport& report, double gap) {
  const StopRequest stop;
  try {
    return verify_volume(problem, report, gap, [] { return StopRequest::signal() != 0; });
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, "--certified"}, reason.what());
  }
}

/// Text that states whether a design is feasible: "yes", or "no: " with the violated constraints or the reason of the
/// failure.
std::string feasibility_text(const DesignProblem& problem, const DesignReport& report) {
  if (report.status == Status::feasible) return "yes";
  std::vector<std::string> violated;
  for (std::size_t i = 0; i < report.margins.size(); ++i)
    if (report.margins[i] < 0) violated.push_back(problem.margins()[i].name);
  const std::string reason = report.reason.empty() ? "" : "; " + report.reason;
  return "no: " + (report.status == Status::failed ? report.reason : join(violated) + " violated" + reason);
}

/// Evaluates the designs of a table, whose columns are parameters. Parameters without a column have the values of the
/// target.
void evaluate_table(const DesignProblem& problem, const Target& target, const EvaluateArguments& arguments,
                    const std::string& program, Printout& out) {
  // The ranges of the parameters are not used, so that a design outside of them fails instead of being refused.
  std::vector<Assignable> parameters;
  for (const Parameter& p : target.info().parameters) parameters.push_back({p.name, p.unit});
  const CsvColumns given = read_table(arguments.designs, parameters, false, program);
  const auto reports = computed_rows<DesignReport>(given.rows, arguments.threads, [&](std::size_t row) {
    std::vector<double> design = target.parameters;
    for (std::size_t i = 0; i < design.size(); ++i)
      if (given.values[i]) design[i] = (*given.values[i])[row];
    DesignReport report;
    if (const Unsupported reason = target.mechanism->refuse(design)) {
      report.parameters = design;
      for (auto* const values : {&report.objectives, &report.margins, &report.reports}) values->clear();
      report.reason = *reason;
    } else {
      report = problem.report(design);
      report.workspace = {};  // releases the samples, because those of many designs would not fit into memory
    }
    return report;
  });

  std::vector<std::string> columns;
  const auto add_columns = [&columns](const std::string& prefix, const auto& named) {
    for (const auto& each : named) columns.push_back(column_header(prefix + each.name, each.unit));
  };
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (given.values[i]) columns.push_back(column_header(parameters[i].name, parameters[i].unit));
  columns.emplace_back("status");
  add_columns("objective ", problem.objectives());
  add_columns("margin ", problem.margins());
  add_columns("output ", problem.reports());
  columns.emplace_back("reason");
  CsvTable table(columns);
  std::vector<Json> objects;
  std::size_t feasible = 0;
  for (const DesignReport& report : reports) {
    Json design = Json::object();
    table.begin_row();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (!given.values[i]) continue;
      table.add(report.parameters[i]);
      design[parameters[i].name] = report.parameters[i];
    }
    table.add(words(report.status));
    const auto values = [&table](std::vector<double> found, const auto& named) {
      found.resize(named.size(), std::numeric_limits<double>::quiet_NaN());
      table.add(found);
      return values_by_name(named, found);
    };
    Json object = {{"design", design}, {"status", words(report.status)}};
    object["objectives"] = values(report.objectives, problem.objectives());
    object["constraints"] = values(report.margins, problem.margins());
    object["outputs"] = values(report.reports, problem.reports());
    object["reason"] = text_or_null(report.reason);
    table.add(report.reason);
    objects.push_back(std::move(object));
    feasible += report.status == Status::feasible;
  }
  report_table(arguments.designs, table, std::move(objects),
               std::to_string(feasible) + " of " + std::to_string(given.rows) + " designs are feasible", out);
}

/// Starts the worker processes for the Python functions of the study. If the study is read from a study file, the
/// functions must be those that are recorded in it.
void start_python_functions(const Study& study, const EvaluateArguments& arguments) {
  if (study.problem->external_calls().empty()) return;
  if (arguments.from.empty()) return start_python(study, arguments.target, arguments.workers, arguments.threads);
  connect_functions(study, read_study(arguments.from), arguments.from,
                    {.threads = arguments.threads, .python = {.workers = arguments.workers}});
}

/// Adds the yield with its confidence interval to the output, and the constraints that machines violate.
void report_yield(const Yield& yield, const DesignProblem& machine, Printout& out) {
  const auto [lower, upper] = yield.interval();
  std::vector<Row> rows = {
      {"machines", std::to_string(yield.machines)},
      {"satisfy all constraints", std::to_string(yield.good)},
      {"yield", digits(yield.share()), digits(lower) + " .. " + digits(upper) + " with 95 % confidence"}};
  Json violated = Json::object();
  for (std::size_t k = 0; k < yield.violated.size(); ++k) {
    const std::string& name = machine.margins()[k].name;
    violated[name] = yield.violated[k];
    if (yield.violated[k] > 0) rows.push_back({"violate " + name, std::to_string(yield.violated[k])});
  }
  if (yield.failed > 0) rows.push_back({"cannot be evaluated", std::to_string(yield.failed)});
  out.json["yield"] = {{"machines", yield.machines}, {"good", yield.good},   {"share", yield.share()},
                       {"interval", {lower, upper}}, {"violated", violated}, {"failed", yield.failed}};
  out.add_table("yield of the built machines", rows);
}

std::string evaluate(const Session& session, const Target& target, const EvaluateArguments& arguments, Printout& out) {
  const ProblemOfMechanism found = target.study ? ProblemOfMechanism{target.study->problem, ""}
                                                : default_problem(target, session.catalogues, arguments.changes.cells);
  const auto& problem = found.problem;
  if (arguments.changes.machines && !problem->parts().built)
    throw ConfigError({"", 0, "--samples"}, "no statistic over built machines",
                      "a study with [tolerance], and with a yield or the key robust");
  expect_table(arguments.designs, "--designs");
  if (target.study) start_python_functions(*target.study, arguments);
  if (!arguments.designs.input.empty()) {
    evaluate_table(*problem, target, arguments, session.program, out);
    return "";
  }
  const ColumnOptions* const columns = problem->parts().plan.columns();
  std::optional<double> gap = columns ? columns->certified : std::nullopt;
  if (!arguments.certified.empty()) {
    gap = parse_gap(arguments.certified, "--certified");
    require_capability(target.mechanism->bounds(), "--certified", "formulas for interval arithmetic", target.info());
    if (!columns)
      throw ConfigError({"", 0, "--certified"}, "voxels", "workspace.method = \"columns\", whose volume it checks");
  }
  DesignReport report;
  std::optional<VolumeBounds> bounds;
  std::optional<double> proven;
  with_team(arguments.threads, [&] {
    report = problem->report(target.parameters);
    if (report.status != Status::failed) proven = proven_error(*problem, report);
    if (gap && report.status != Status::failed) bounds = certified_bounds(*problem, report, *gap);
  });
  const bool failed = report.status == Status::failed, surveyed = !failed || bounds;

  /// Adds named values to the output, each with its unit, a remark and its meaning.
  const auto report_values = [&](const std::string& key, const std::string& title, const auto& named,
                                 const std::vector<double>& values, const auto& remark, const auto& text_of) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < values.size(); ++i) {
      Row& row = rows.emplace_back(Row{named[i].name, text_of(values[i], named[i].unit)});
      if (const std::string text = remark(named[i], values[i]); !text.empty()) row.push_back(text);
      row.push_back(named[i].meaning);
    }
    out.json[key] = values_by_name(named, values);
    out.add_table(title, rows);
  };
  const auto no_remark = [](const auto&, double) { return ""; };
  const auto parameter_text = [](double value, const std::string& unit) { return number(value, unit); };
  const auto value_text = [&](double value, const std::string& unit) {
    // A voxel volume has the digits that its grid supports, whatever the study calls it.
    const bool is_volume = surveyed && value == report.workspace.volume;
    return result_text(value, unit, is_volume ? known_digits(*problem, report.workspace) : kFullDigits);
  };
  out.add("mechanism", target.info().name);
  if (target.study) out.head.push_back({"study", target.study->name});
  out.head.push_back({"feasible", feasibility_text(*problem, report)});
  report_values("parameters", "parameters", target.info().parameters, report.parameters, no_remark, parameter_text);
  out.json["workspace"] = nullptr;
  if (surveyed) report_workspace(*problem, report.workspace, proven, found.why_voxels, out);
  if (bounds) report_bounds(*bounds, *gap, !failed, volume_unit(target.info(), problem->parts().plan), out);
  report_values(
      "objectives", "objectives", problem->objectives(), report.objectives,
      [](const ObjectiveInfo& o, double) { return o.direction == Direction::maximise ? "maximise" : "minimise"; },
      value_text);
  report_values(
      "constraints", "constraints (margins, satisfied if >= 0)", problem->margins(), report.margins,
      [](const MarginInfo&, double margin) { return margin >= 0 ? "satisfied" : "violated"; }, value_text);
  report_values("outputs", "outputs", problem->reports(), report.reports, no_remark, value_text);
  if (report.yield) report_yield(*report.yield, *problem->parts().built->problem, out);
  if (report.reason.empty())
    with_team(arguments.threads, [&] { report_sensitivities(*problem, report, arguments, out); });
  out.json["feasible"] = report.status == Status::feasible;
  const NamedValues facts = quantities_of_design(*target.mechanism, report.parameters, problem->parts().plan.limits);
  out.json["facts"] = values_by_name(facts);
  std::vector<Row> rows;
  for (const auto& [name, value] : facts) {
    const QuantityInfo* const quantity = find_named(target.info().quantities, name);
    rows.push_back({name, number(value, quantity ? quantity->unit : "1")});
  }
  out.add_table("facts", rows);
  return failed ? "the evaluation failed: " + report.reason : "";
}

}  // namespace

void add_evaluate(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<EvaluateArguments>(
      app, session, "evaluate", "Evaluate one design: objectives, constraint margins and workspace.",
      "A study is evaluated at its baseline, otherwise at its parameters. For a mechanism without a study, computes\n"
      "the workspace without limits (by exact columns if possible) and all objectives that support the mechanism.\n"
      "An infeasible design is not an error.\n"
      "Example: pkmopt evaluate experiments/4ppa-2par/paper-problem.toml --set a=0.3,b=1 --json",
      [&session](const Target& target, const EvaluateArguments& given, Printout& out) {
        return evaluate(session, target, given, out);
      });
  add_cells_option(command, arguments.changes.cells, "Voxels along each swept coordinate, instead of the study's");
  add_integer(command, "--samples N", arguments.changes.machines, 2, 10'000'000,
              "Number of built machines of a study with [tolerance], instead of the study's");
  add_option(command, "--certified GAP", arguments.certified,
             "Check the exact volume against guaranteed bounds with this relative gap (see certify)");
  auto* const designs =
      add_option(command, "--designs FILE", arguments.designs.input,
                 "Evaluate every row of this table (CSV), whose columns are parameters, such as \"l_a [mm]\"");
  add_table_output(command, arguments.designs, "Write the results of --designs to this file");
  add_sensitivity_options(command, arguments);
  for (const char* const of_single_designs : {"--certified", "--sensitivity", "--tolerance"})
    designs->excludes(command.get_option(of_single_designs));
  add_threads(command, arguments.threads);
  add_workers(command, arguments.workers);
}

}  // namespace pkm
