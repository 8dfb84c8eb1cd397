// `pkmopt coupling`: statistics of the dynamic coupling indices over a box of poses, and the map behind them.

#include <algorithm>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "engine/core/catalogue.hpp"
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

/// The joints by their numbers, and what is said of all of a pose.
std::vector<std::string> fields(const MechanismInfo& info) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= info.joints.size(); ++i) names.push_back(std::to_string(i));
  names.insert(names.end(), {"worst", "mean"});
  return names;
}

std::vector<std::string> held_names(const MechanismInfo& info, const SurveyPlan& plan) {
  std::vector<std::string> names;
  for (const int held : sweep_of(info, plan).held)
    names.push_back(info.coordinates[static_cast<std::size_t>(held)].name);
  return names;
}

/// The voxels asked for: the study's limits, its plan where the command line says nothing.
SurveyPlan plan_of(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  SurveyPlan plan;
  if (target.study) plan = target.study->problem->parts().plan;
  plan.limits = target.limits;
  using Kind = HeldCoordinate::Kind;
  for (HeldCoordinate& held : plan.held)
    if (held.kind == Kind::listed) held = {held.coordinate, Kind::value, held.values.front()};
  set_grid(plan, info, arguments, kUsualCells, kMostCells);
  if (arguments.phi.empty()) return plan;
  const std::vector<std::string> held = held_names(info, plan);
  if (std::ranges::find(held, "phi") == held.end())
    throw ConfigError({"", 0, "--phi"},
                      "the survey does not hold phi: it holds " + (held.empty() ? "nothing" : join(held)));
  const AxisInfo& phi = *find_named(info.coordinates, "phi");
  const int coordinate = static_cast<int>(&phi - info.coordinates.data());
  std::erase_if(plan.held, [&](const HeldCoordinate& each) { return each.coordinate == coordinate; });
  plan.held.push_back({.coordinate = coordinate,
                       .kind = Kind::listed,
                       .values = parse_values(arguments.phi, "--phi", {phi.name, phi.unit})});
  return plan;
}

/// The surveys at each value of --phi, and all of them as one.
struct Found {
  SurveyPlan plan;
  std::string mode;
  std::vector<double> phi;  ///< empty: the plan's own
  std::vector<Survey<double>> each;
  Survey<double> all;
};

Found find(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  if (!target.mechanism->dynamics())
    throw ConfigError({"", 0, "coupling"}, "mechanism " + info.name + " has no masses, so no coupling indices");
  Found f;
  f.mode = known_mode(info, {arguments.mode, ""});
  f.plan = plan_of(target, arguments);
  Demand demand;
  demand.dci = true;
  demand.poses = true;
  demand.mode = f.mode;
  try {
    const auto survey = [&](const SurveyPlan& plan) {
      Survey<double> found;
      survey_once<double>(*prepare_survey(*target.mechanism, plan, demand), target.parameters, found);
      return found;
    };
    if (!arguments.phi.empty()) {
      SurveyPlan one = f.plan;
      HeldCoordinate& phi = one.held.back();
      f.phi = phi.values;
      for (const double value : f.phi) {
        phi = {phi.coordinate, HeldCoordinate::Kind::value, value};
        f.each.push_back(survey(one));
      }
    }
    f.all = survey(f.plan);
  } catch (const std::invalid_argument& reason) {
    throw ConfigError({"", 0, info.name}, reason.what());
  }
  return f;
}

Json statistics_json(const MechanismInfo& info, const Survey<double>& survey) {
  Json json = {{"samples", survey.weight.size()}, {"cells", survey.cells}, {"volume", survey.volume}};
  for (const char* name : {"max", "mean", "std", "p95"}) json[name] = Json::object();
  if (survey.weight.empty()) return json;
  for (const std::string& field : fields(info)) {
    const Statistics s = statistics(survey, field);
    json["max"][field] = s.max;
    json["mean"][field] = s.mean;
    json["std"][field] = s.std;
    json["p95"][field] = s.p95;
  }
  return json;
}

Json coupling_json(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  const std::vector<int>& swept = sweep_of(info, f.plan).swept;
  Json json = {
      {"mechanism", info.name}, {"mode", f.mode}, {"masses", mechanism.dynamics()->mass_model()}, {"box", nullptr}};
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const std::string& name = info.coordinates[static_cast<std::size_t>(swept[k])].name;
    json["cells"][name] = f.plan.voxels()->cells[k];
    if (f.plan.box()) json["box"][name] = (*f.plan.box())[k];
  }
  json["statistics"] = statistics_json(info, f.all);
  json["each"] = Json::array();
  for (std::size_t k = 0; k < f.each.size(); ++k) {
    Json one = statistics_json(info, f.each[k]);
    one["phi"] = f.phi[k];
    json["each"].push_back(one);
  }
  return json;
}

void print_statistics(const std::string& title, const MechanismInfo& info, const Survey<double>& survey) {
  std::vector<Row> rows = {{"", "mean", "std", "p95", "max"}};
  for (const std::string& field : fields(info)) {
    const Statistics s = statistics(survey, field);
    const bool limb = field.size() == 1;
    rows.push_back({limb               ? info.joints[static_cast<std::size_t>(field[0] - '1')].name
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

void print_coupling(const Mechanism& mechanism, const Found& f) {
  const MechanismInfo& info = mechanism.info();
  std::cout << aligned({{"mechanism", info.name}, {"mode", f.mode}, {"masses", mechanism.dynamics()->mass_model()}});
  for (std::size_t k = 0; k < f.each.size(); ++k)
    print_statistics("phi = " + number(f.phi[k], find_named(info.coordinates, "phi")->unit), info, f.each[k]);
  if (f.each.size() != 1) print_statistics(f.each.empty() ? "coupling indices" : "all of them", info, f.all);
}

/// One line per feasible cell.
CsvTable table_of(const MechanismInfo& info, const Survey<double>& survey) {
  std::vector<std::string> columns = names_of(info.coordinates);
  for (std::size_t i = 1; i <= info.joints.size(); ++i) columns.push_back("dci_" + std::to_string(i));
  columns.emplace_back("dci_worst");
  CsvTable table(columns);
  const std::vector<double> worst = coupling_of(survey, "worst");
  for (std::size_t k = 0; k < survey.weight.size(); ++k) {
    table.begin_row();
    table.add(survey.pose[k]);
    for (std::size_t i = 0; i < info.joints.size(); ++i) table.add(survey.dci[i][k]);
    table.add(worst[k]);
  }
  return table;
}

int coupling(const Catalogues& catalogues, const CouplingArguments& arguments) {
  const Target target = find_target(catalogues, arguments);
  const Found found = find(target, arguments);
  if (!arguments.csv.empty()) table_of(target.info(), found.all).write(arguments.csv);
  if (arguments.json)
    print_json(std::cout, coupling_json(*target.mechanism, found));
  else
    print_coupling(*target.mechanism, found);
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
