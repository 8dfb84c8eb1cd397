// `pkmopt coupling`: statistics of the dynamic coupling indices over a box of poses, and the map behind them.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/math/statistics.hpp"
#include "engine/problem/inertia_options.hpp"
#include "engine/report/csv_table.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/survey/survey_set.hpp"
#include "experiments/app/commands.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/print.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kUsualCells = 20;
constexpr double kMostCells = 1e8;

struct CouplingArguments : DesignArguments, GridArguments {
  std::string phi, mode, csv;
};

/// Statistics of one field over samples.
struct Statistics {
  double max, mean, std, p95;
};

Statistics statistics(const Survey<double>& survey, const std::string& limb) {
  const std::vector<double> field = coupling_of(survey, limb);
  return {greatest(field), weighted_mean(survey.weight, field), weighted_deviation(survey.weight, field),
          weighted_quantile(survey.weight, field, 0.95)};
}

const std::vector<std::string>& fields() {
  static const std::vector<std::string> names = {"1", "2", "3", "4", "worst", "mean"};
  return names;
}

Assignable held_coordinate(const MechanismInfo& info) {
  return {info.coordinates[static_cast<std::size_t>(info.held)], info.held == 3 ? "rad" : "m"};
}

/// The voxels asked for: the study's limits, its plan where the command line says nothing.
SurveyPlan plan_of(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  SurveyPlan plan;
  if (target.study) plan = target.study->problem->parts().plan;
  plan.limits = target.limits;
  plan.method = Method::voxels;
  plan.held_values.clear();
  const Sweep sweep = sweep_of(info, plan);
  set_grid(plan, info, arguments, kUsualCells, kMostCells);
  const Assignable held = held_coordinate(info);
  if (!arguments.phi.empty()) {
    if (sweep.held != info.held || held.name != "phi")
      throw ConfigError({"", 0, "--phi"}, "the survey does not hold phi: it holds " +
                                              info.coordinates[static_cast<std::size_t>(sweep.held)]);
    plan.held_values = parse_values(arguments.phi, "--phi", held);
  }
  return plan;
}

/// The surveys at each value of the held coordinate, and all of them as one.
struct Found {
  SurveyPlan plan;
  std::string mode;
  std::vector<double> held;  ///< empty: the plan's own
  std::vector<Survey<double>> each;
  Survey<double> all;
};

Found find(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  if (!info.has_dynamics)
    throw ConfigError({"", 0, "coupling"}, "mechanism " + info.name + " has no masses, so no coupling indices");
  Found f;
  f.mode = known_mode(info, {arguments.mode, ""});
  f.plan = plan_of(target, arguments);
  f.held = f.plan.held_values;
  Demand demand;
  demand.dci = true;
  demand.poses = true;
  demand.mode = f.mode;
  try {
    SurveyPlan one = f.plan;
    one.held_values.clear();
    for (const double value : f.held) {
      one.held.kind = HeldCoordinate::Kind::value;
      one.held.value = value;
      f.each.emplace_back();
      target.mechanism->prepare(one, demand)->survey(target.parameters, f.each.back());
    }
    prepare_survey(*target.mechanism, f.plan, demand)->survey(target.parameters, f.all);
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, info.name}, reason.what());
  }
  return f;
}

Json statistics_json(const Survey<double>& survey) {
  Json json = {{"samples", survey.weight.size()}, {"cells", survey.cells}, {"volume", survey.volume}};
  for (const char* name : {"max", "mean", "std", "p95"}) json[name] = Json::object();
  if (survey.weight.empty()) return json;
  for (const std::string& field : fields()) {
    const Statistics s = statistics(survey, field);
    json["max"][field] = s.max;
    json["mean"][field] = s.mean;
    json["std"][field] = s.std;
    json["p95"][field] = s.p95;
  }
  return json;
}

Json coupling_json(const MechanismInfo& info, const Found& f) {
  const Sweep sweep = sweep_of(info, f.plan);
  Json json = {{"mechanism", info.name}, {"mode", f.mode}, {"masses", info.mass_model}, {"box", nullptr}};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string& name = info.coordinates[static_cast<std::size_t>(sweep.swept[k])];
    json["cells"][name] = f.plan.cells[k];
    if (f.plan.box) json["box"][name] = (*f.plan.box)[k];
  }
  json["statistics"] = statistics_json(f.all);
  json["each"] = Json::array();
  for (std::size_t k = 0; k < f.each.size(); ++k) {
    Json one = statistics_json(f.each[k]);
    one[info.coordinates[static_cast<std::size_t>(sweep.held)]] = f.held[k];
    json["each"].push_back(one);
  }
  return json;
}

void print_statistics(const std::string& title, const MechanismInfo& info, const Survey<double>& survey) {
  std::vector<Row> rows = {{"", "mean", "std", "p95", "max"}};
  for (const std::string& field : fields()) {
    const Statistics s = statistics(survey, field);
    const bool limb = field.size() == 1;
    rows.push_back({limb               ? info.joints[static_cast<std::size_t>(field[0] - '1')]
                    : field == "worst" ? "largest of a pose"
                                       : "mean of a pose",
                    number(s.mean), number(s.std), number(s.p95), number(s.max)});
  }
  if (survey.weight.empty()) rows = {{"no feasible pose"}};
  print_section(
      std::cout,
      title + ": " + std::to_string(survey.feasible_cells) + " of " + std::to_string(survey.cells) + " cells feasible",
      rows);
}

void print_coupling(const MechanismInfo& info, const Found& f) {
  std::cout << aligned({{"mechanism", info.name}, {"mode", f.mode}, {"masses", info.mass_model}});
  const Sweep sweep = sweep_of(info, f.plan);
  const std::string& held = info.coordinates[static_cast<std::size_t>(sweep.held)];
  for (std::size_t k = 0; k < f.each.size(); ++k)
    print_statistics(held + " = " + number(f.held[k], sweep.held == 3 ? "rad" : "m"), info, f.each[k]);
  if (f.each.size() != 1) print_statistics(f.each.empty() ? "coupling indices" : "all of them", info, f.all);
}

/// One line per feasible cell.
CsvTable table_of(const MechanismInfo& info, const Survey<double>& survey) {
  std::vector<std::string> columns{info.coordinates.begin(), info.coordinates.end()};
  columns.insert(columns.end(), {"dci_1", "dci_2", "dci_3", "dci_4", "dci_worst"});
  CsvTable table(columns);
  const std::vector<double> worst = coupling_of(survey, "worst");
  for (std::size_t k = 0; k < survey.weight.size(); ++k) {
    const Pose<double>& at = survey.pose[k];
    table.begin_row();
    for (const double value : {at.x, at.y, at.z, at.angle}) table.add(value);
    for (const auto& limb : survey.dci) table.add(limb[k]);
    table.add(worst[k]);
  }
  return table;
}

int coupling(const Catalogues& catalogues, const CouplingArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Found found = find(target, arguments);
  if (!arguments.csv.empty()) table_of(target.info(), found.all).write(arguments.csv);
  if (arguments.json)
    print_json(std::cout, coupling_json(target.info(), found));
  else
    print_coupling(target.info(), found);
  return kDone;
}

}  // namespace

void add_coupling(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<CouplingArguments>();
  CLI::App* command =
      app.add_subcommand("coupling", "Statistics of the dynamic coupling indices over a box of poses, and their map.");
  add_design_arguments(*command, *arguments);
  add_grid_options(*command, *arguments, kUsualCells);
  command->add_option("--phi", arguments->phi, "Angles: a list 0,30deg or from:to:count; default: the study's, else 0")
      ->type_name("ANGLES");
  command->add_option("--mode", arguments->mode, "Working mode (see 'pkmopt list mechanisms NAME'); default: the first")
      ->type_name("MODE");
  command->add_option("--csv", arguments->csv, "Write the indices of every feasible cell to this file")
      ->type_name("FILE");
  command->footer(
      "Cells count where their centre is feasible under the study's limits; a bare mechanism has none. The maximum is\n"
      "governed by the distance from the limbs' singularities (s_min): quote it.\n"
      "Example: pkmopt coupling 3crr-r-cru --box x=60mm:240mm,y=110mm:290mm,z=150mm:270mm --phi 0,30deg");
  command->callback([&session, arguments] { session.exit_code = coupling(session.catalogues, *arguments); });
}

}  // namespace pkm
