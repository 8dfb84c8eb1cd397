// `pkmopt coupling`: statistics of the dynamic coupling indices over a box of poses, and the map behind them.

#include <algorithm>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/math/rounding.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/report/csv_table.hpp"
#include "engine/setup/assignments.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/survey/survey_set.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kUsualCells = 20;
constexpr double kMostCells = 1e8;
using Kind = HeldCoordinate::Kind;

struct CouplingArguments : DesignArguments, GridArguments, TableOutput {
  std::string phi, mode;
};

/// The voxels asked for: the study's limits, its plan where the command line says nothing. With --phi, what is held
/// last are its values.
SurveyPlan plan_of(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  SurveyPlan plan = target.plan();
  for (HeldCoordinate& held : plan.held)
    if (held.kind == Kind::listed) held = {held.coordinate, Kind::value, held.values.front()};
  set_grid(plan, target, arguments, kUsualCells, kMostCells);
  if (arguments.phi.empty()) return plan;
  const std::vector<std::string> held = coordinate_names(info, sweep_of(info, plan).held);
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

/// Statistics of the indices over the samples, as JSON and as rows: the joints by their numbers, and what is said of
/// all of a pose.
std::pair<Json, std::vector<Row>> statistics(const MechanismInfo& info, const Survey<double>& survey) {
  Json json = {{"samples", survey.weight.size()}, {"cells", survey.cells}, {"volume", survey.volume}};
  for (const char* name : {"max", "mean", "std", "p95"}) json[name] = Json::object();
  if (survey.weight.empty()) return {json, {{"no feasible pose"}}};
  std::vector<Row> rows = {{"", "mean", "std", "p95", "max"}};
  Scratch scratch;
  const auto add = [&](const std::string& limb, const std::string& words) {
    Row row = {words};
    for (const char* name : {"mean", "std", "p95", "max"}) {
      const double value = PoseStatistic{kCouplingIndex, name, limb}(survey, scratch);
      json[name][limb] = value;
      const double mean = json["mean"][limb];
      row.push_back(number(beyond_rounding(value, mean)));  // all alike leave roundings
    }
    rows.push_back(row);
  };
  for (std::size_t i = 0; i < info.joints.size(); ++i) add(std::to_string(i + 1), info.joints[i].name);
  add("worst", "largest of a pose");
  add("mean", "mean of a pose");
  return {json, rows};
}

/// One line per feasible cell.
CsvTable table_of(const MechanismInfo& info, const Survey<double>& survey) {
  std::vector<std::string> columns = names_of(info.coordinates);
  for (std::size_t i = 1; i <= info.joints.size(); ++i) columns.push_back("dci_" + std::to_string(i));
  columns.emplace_back("dci_worst");
  CsvTable table(columns);
  Scratch scratch;
  const std::vector<double>& worst = field_of(survey, kCouplingIndex, "worst", scratch);
  for (std::size_t k = 0; k < survey.weight.size(); ++k) {
    table.begin_row();
    table.add(survey.pose[k]);
    for (std::size_t i = 0; i < info.joints.size(); ++i) table.add(survey.of(kCouplingIndex, i)[k]);
    table.add(worst[k]);
  }
  return table;
}

std::string coupling(const Target& target, const CouplingArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  if (const Refusal reason = no_joint_forces(*target.mechanism))
    throw ConfigError({"", 0, "coupling"}, *reason + ", so no coupling indices");
  const Demand demand{.fields = {&kCouplingIndex}, .poses = true, .mode = known_mode(info, {arguments.mode, ""})};
  const SurveyPlan plan = plan_of(target, arguments);
  const auto explained = [&info](const auto& action) {
    try {
      return action();
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, info.name}, reason.what());
    }
  };
  const auto survey = [&](const SurveyPlan& cells) {
    return explained([&] {
      Survey<double> found;
      survey_once<double>(*prepare_survey(*target.mechanism, cells, demand), target.parameters, found);
      return found;
    });
  };
  explained([&] { return prepare_survey(*target.mechanism, plan, demand); });
  check_outputs({arguments.csv}, target.files, if_forced(arguments.force));
  const auto title = [](const std::string& of, const Survey<double>& found) {
    return of + ": " + std::to_string(found.feasible_cells) + " of " + std::to_string(found.cells) + " cells feasible";
  };

  out.say("mechanism", info.name);
  out.say("mode", demand.mode);
  out.say("masses", target.mechanism->dynamics()->mass_model());
  out.json["box"] = nullptr;
  const std::vector<std::string> swept = coordinate_names(info, sweep_of(info, plan).swept);
  for (std::size_t k = 0; k < swept.size(); ++k) {
    out.json["cells"][swept[k]] = plan.voxels()->cells[k];
    if (plan.box()) out.json["box"][swept[k]] = (*plan.box())[k];
  }
  const Survey<double> all = survey(plan);
  const auto [json, rows] = statistics(info, all);
  out.json["statistics"] = json;
  Json& each = out.json["each"] = Json::array();
  SurveyPlan one = plan;
  for (const double phi : arguments.phi.empty() ? std::vector<double>() : plan.held.back().values) {
    one.held.back() = {plan.held.back().coordinate, Kind::value, phi};
    const Survey<double> found = survey(one);
    const auto [json_of_one, rows_of_one] = statistics(info, found);
    each.push_back(json_of_one);
    each.back()["phi"] = phi;
    out.section(title("phi = " + position(phi, find_named(info.coordinates, "phi")->unit), found), rows_of_one);
  }
  if (each.size() != 1) out.section(title(each.empty() ? "coupling indices" : "all of them", all), rows);
  if (!arguments.csv.empty()) write_table(arguments, table_of(info, all));
  return "";
}

}  // namespace

void add_coupling(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<CouplingArguments>(
      app, session, "coupling", "Statistics of the dynamic coupling indices over a box of poses, and their map.",
      "Cells count where their centre is feasible under the study's limits; a bare mechanism has none. The maximum is\n"
      "governed by the distance from the limbs' singularities (s_min): quote it.\n"
      "Example: pkmopt coupling 3crr-r-cru --box x=60mm:240mm,y=110mm:290mm,z=150mm:270mm --phi 0,30deg",
      coupling);
  add_grid_options(command, arguments, kUsualCells);
  add_option(command, "--phi ANGLES", arguments.phi,
             "Angles: a list 0,30deg or from:to:count; default: the study's, else 0");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'); default: the first");
  add_table_output(command, arguments, "Write the indices of every feasible cell to this file");
}

}  // namespace pkm
