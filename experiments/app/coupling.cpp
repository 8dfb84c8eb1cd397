// `pkmopt coupling`: statistics of the dynamic coupling indices over a grid of poses, and a table of their values.

#include <algorithm>
#include <stdexcept>

#include "engine/config/assignments.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/export/tables.hpp"
#include "engine/math/rounding.hpp"
#include "engine/problem/pose_statistic.hpp"
#include "engine/storage/safe_file.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/grid.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kDefaultCouplingCells = 20;
constexpr double kMaxCouplingCells = 1e8;
using Kind = FixedCoordinate::Kind;

struct CouplingArguments : DesignArguments, GridArguments, TableOutput {
  std::string phi, mode;
};

/// The voxel grid of the command line. Values that are not given there, and the limits, are those of the study. With
/// --phi, the last fixed coordinate is phi, which takes each of the listed values.
WorkspacePlan plan_of(const Target& target, const CouplingArguments& arguments) {
  const MechanismInfo& info = target.info();
  WorkspacePlan plan = target.plan();
  for (FixedCoordinate& fixed : plan.fixed)
    if (fixed.kind == Kind::listed) fixed = {fixed.coordinate, Kind::value, fixed.values.front()};
  set_grid(plan, target, arguments, kDefaultCouplingCells, kMaxCouplingCells);
  if (arguments.phi.empty()) return plan;
  const std::vector<std::string> fixed = coordinate_names(info, sweep_of(info, plan).fixed);
  if (std::ranges::find(fixed, "phi") == fixed.end())
    throw ConfigError({"", 0, "--phi"},
                      "phi is not a fixed coordinate; fixed: " + (fixed.empty() ? "none" : join(fixed)));
  const AxisInfo& phi = *find_named(info.coordinates, "phi");
  const int coordinate = static_cast<int>(&phi - info.coordinates.data());
  std::erase_if(plan.fixed, [&](const FixedCoordinate& each) { return each.coordinate == coordinate; });
  plan.fixed.push_back({.coordinate = coordinate,
                        .kind = Kind::listed,
                        .values = parse_values(arguments.phi, "--phi", {phi.name, phi.unit})});
  return plan;
}

/// Statistics over the sampled poses, as JSON and as table rows: for the coupling index of each joint, and for the
/// largest and the mean index of each pose.
std::pair<Json, std::vector<Row>> statistics(const MechanismInfo& info, const WorkspaceResult<double>& survey) {
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
      // A difference of equal values, which is only a rounding error, becomes 0.
      row.push_back(number(zero_if_rounding_error(value, mean)));
    }
    rows.push_back(row);
  };
  for (std::size_t i = 0; i < info.joints.size(); ++i) add(std::to_string(i + 1), info.joints[i].name);
  add("worst", "maximum of the limbs");
  add("mean", "mean of the limbs");
  return {json, rows};
}

std::string coupling(const Target& target, const CouplingArguments& arguments, Printout& out) {
  const MechanismInfo& info = target.info();
  if (const Unsupported reason = why_no_joint_forces(*target.mechanism))
    throw ConfigError({"", 0, "coupling"}, *reason + ", so it has no coupling indices");
  const FieldRequest request{
      .fields = {&kCouplingIndex}, .poses = true, .mode = parse_mode(info, {arguments.mode, ""})};
  const WorkspacePlan plan = plan_of(target, arguments);
  // Runs an action, and converts a std::invalid_argument that it throws into a ConfigError.
  const auto with_config_errors = [&info](const auto& action) {
    try {
      return action();
    } catch (const std::invalid_argument& reason) {
      throw ConfigError({"", 0, info.name}, reason.what());
    }
  };
  const auto survey = [&](const WorkspacePlan& cells) {
    return with_config_errors([&] {
      WorkspaceResult<double> found;
      evaluate_once<double>(*prepare_workspace(*target.mechanism, cells, request), target.parameters, found);
      return found;
    });
  };
  with_config_errors([&] { return prepare_workspace(*target.mechanism, plan, request); });
  check_outputs({arguments.csv}, target.files, if_forced(arguments.force));
  const auto title = [](const std::string& of, const WorkspaceResult<double>& found) {
    return of + ": " + std::to_string(found.feasible_cells) + " of " + std::to_string(found.cells) + " cells feasible";
  };

  out.add("mechanism", info.name);
  out.add("mode", request.mode);
  out.add("masses", target.mechanism->dynamics()->mass_model());
  out.json["box"] = nullptr;
  const std::vector<std::string> swept = coordinate_names(info, sweep_of(info, plan).swept);
  for (std::size_t k = 0; k < swept.size(); ++k) {
    out.json["cells"][swept[k]] = plan.voxels()->cells[k];
    if (plan.box()) out.json["box"][swept[k]] = (*plan.box())[k];
  }
  const WorkspaceResult<double> all = survey(plan);
  const auto [json, rows] = statistics(info, all);
  out.json["statistics"] = json;
  Json& each = out.json["each"] = Json::array();
  WorkspacePlan one = plan;
  for (const double phi : arguments.phi.empty() ? std::vector<double>() : plan.fixed.back().values) {
    one.fixed.back() = {plan.fixed.back().coordinate, Kind::value, phi};
    const WorkspaceResult<double> found = survey(one);
    const auto [json_of_one, rows_of_one] = statistics(info, found);
    each.push_back(json_of_one);
    each.back()["phi"] = phi;
    out.add_table(title("phi = " + number(phi, find_named(info.coordinates, "phi")->unit), found), rows_of_one);
  }
  if (each.size() != 1) out.add_table(title(each.empty() ? "coupling indices" : "all angles", all), rows);
  if (!arguments.csv.empty()) write_table(arguments, coupling_table(info, all));
  return "";
}

}  // namespace

void add_coupling(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_design_command<CouplingArguments>(
      app, session, "coupling", "Compute statistics of the dynamic coupling indices over a box of poses.",
      "A cell is counted if its centre satisfies the limits of the study; without a study there are no limits. The\n"
      "maximum depends on how close the limbs may be to their singularities (limit s_min): state s_min with the "
      "result.\n"
      "Example: pkmopt coupling 3crr-r-cru --box x=60mm:240mm,y=110mm:290mm,z=150mm:270mm --phi 0,30deg",
      coupling);
  add_grid_options(command, arguments, kDefaultCouplingCells);
  add_option(command, "--phi ANGLES", arguments.phi,
             "Angles: a list 0,30deg or from:to:count (default: the study's, else 0)");
  add_option(command, "--mode MODE", arguments.mode,
             "Working mode (see 'pkmopt list mechanisms NAME'; default: the first)");
  add_table_output(command, arguments, "Write the coupling indices of every feasible cell to this file");
}

}  // namespace pkm
