// Text of `pkmopt check` for a study: the resolved problem with all defaults.

#include <sstream>

#include "engine/config/study_draft.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/display_unit.hpp"
#include "engine/core/printable.hpp"
#include "engine/core/text_table.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

using Row = std::vector<std::string>;

/// "(default)" if a value equals the default, whether or not the study sets it; otherwise "".
const char* mark(bool is_default) { return is_default ? "(default)" : ""; }

void write_parameters(std::ostream& out, const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const auto& known = parts.mechanism->info().parameters;
  std::vector<Row> varying, fixed;
  for (std::size_t v = 0; v < parts.varies.size(); ++v) {
    const std::size_t i = parts.varies[v];
    const Variable& variable = parts.space[v];
    std::string bounds = display_range(variable.lower, variable.upper, variable.unit);
    const auto choice = std::ranges::find(parts.choices, i, &Choice::parameter);
    if (choice != parts.choices.end())
      bounds = "one of " + join(choice->rows);
    else if (variable.step > 0)
      bounds += " in steps of " + display_text(variable.step, variable.unit);
    std::string base;
    if (study.baseline) {
      const double value = (*study.baseline)[i];
      base = "baseline " +
             (choice == parts.choices.end() ? display_text(value, variable.unit) : choice->rows[choice->row(value)]);
      if (value < variable.lower || value > variable.upper) base += " (outside the bounds)";
    }
    varying.push_back({variable.name, bounds, base, known[i].meaning});
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (contains(parts.varies, i)) continue;
    const double value = parts.parameters[i];
    std::string note = mark(value == known[i].nominal);
    if (study.baseline && (*study.baseline)[i] != value)
      note += (note.empty() ? "" : " ") + ("baseline " + display_text((*study.baseline)[i], known[i].unit));
    fixed.push_back({known[i].name, display_text(value, known[i].unit), note, known[i].meaning});
  }
  out << format_titled_table("variables", varying);
  out << format_titled_table("fixed parameters", fixed);
}

/// Text that describes the value of a fixed coordinate.
std::string fixed_text(const FixedCoordinate& fixed, const std::string& unit) {
  using Kind = FixedCoordinate::Kind;
  if (fixed.kind == Kind::default_value) return "default of each design";
  if (fixed.kind == Kind::integrated) return "integrated over its range";
  if (fixed.kind == Kind::value) return display_text(fixed.value, unit);
  return join_texts(fixed.values, [&unit](double value) { return display_text(value, unit); });
}

std::vector<Row> survey_rows(const MechanismInfo& info, const WorkspacePlan& plan) {
  const auto coordinate = [&info](int i) { return info.coordinates[static_cast<std::size_t>(i)]; };
  const Sweep& sweep = sweep_of(info, plan);
  WorkspacePlan usual = plan;
  set_defaults(info, usual);
  bool usual_cells = true;
  std::vector<std::string> swept, cells, nodes, box;
  for (std::size_t k = 0; k < sweep.swept.size(); ++k) {
    const AxisInfo axis = coordinate(sweep.swept[k]);
    swept.push_back(axis.name);
    if (plan.voxels()) {
      cells.push_back(axis.name + " = " + std::to_string(plan.voxels()->cells[k]));
      usual_cells = usual_cells && plan.voxels()->cells[k] == usual.voxels()->cells[k];
    }
    if (plan.columns() && sweep.swept[k] != sweep.column)
      nodes.push_back(axis.name + " = " + std::to_string(plan.columns()->nodes[nodes.size()]));
    if (const auto& given = plan.box())
      box.push_back(axis.name + " = " + display_range((*given)[k][0], (*given)[k][1], axis.unit));
  }
  for (std::size_t k = 0; k < plan.fixed.size(); ++k) {
    const FixedCoordinate& fixed = plan.fixed[k];
    if (fixed.cells == 0) continue;
    cells.push_back(coordinate(fixed.coordinate).name + " = " + std::to_string(fixed.cells));
    usual_cells = usual_cells && fixed.cells == usual.fixed[k].cells;
  }
  std::vector<Row> rows = {{"method", plan.voxels() ? "voxels" : "columns", mark(!plan.voxels())}};
  const bool usual_sweep = &sweep == info.sweeps.data();
  if (!usual_sweep) rows.push_back({"sweep", join(swept)});
  if (plan.voxels()) rows.push_back({"cells", join(cells), mark(usual_cells)});
  if (plan.voxels() || !box.empty())
    rows.push_back({"box", box.empty() ? "derived from each design" : join(box), mark(box.empty())});
  if (plan.home) {
    std::vector<std::string> home;
    for (std::size_t k = 0; k < sweep.swept.size(); ++k)
      home.push_back(swept[k] + " = " + display_text((*plan.home)[k], coordinate(sweep.swept[k]).unit));
    rows.push_back({"home", join(home) + "; only the component that holds this pose counts"});
  }
  if (const ColumnOptions* const columns = plan.columns()) {
    if (columns->nodes[0] > 0)
      rows.push_back({"nodes", join(nodes) + " per smooth subinterval"});
    else
      rows.push_back({"tolerance", shortest(columns->tolerance) + " relative",
                      mark(columns->tolerance == usual.columns()->tolerance)});
    if (columns->certified)
      rows.push_back({"certified", "by bounds with the relative gap " + shortest(*columns->certified)});
  }
  for (const int i : sweep.fixed) {
    const FixedCoordinate fixed = how_fixed(plan, i);
    rows.push_back({coordinate(i).name, fixed_text(fixed, coordinate(i).unit),
                    mark(fixed.kind == FixedCoordinate::Kind::default_value)});
  }
  return rows;
}

std::vector<Row> limit_rows(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const auto& known = parts.mechanism->info().limits;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto& limit = known[i];
    const char* const inactive = "(default: inactive)";
    std::string value = display_text(limit.inactive, limit.unit), origin = inactive;
    if (const Parameter* own = find_named(parts.mechanism->info().parameters, limit.name)) {
      value = "the parameter";
      origin = "(default: " + own->name + " of the design)";
    }
    if (!study.limit_origins[i].empty()) {
      const std::optional<double>& given = parts.plan.limits.given[i];
      const bool is_default = given && *given == limit.inactive && origin == inactive;
      value = given ? display_text(*given, limit.unit) : limit.derivation;
      origin = "from " + study.limit_origins[i] + (is_default ? std::string(" ") + inactive : "");
    }
    rows.push_back({limit.name, value, origin, limit.meaning});
  }
  return rows;
}

std::vector<Row> obstacle_rows(const Obstacles& obstacles) {
  const auto triple = [](const Point3<double>& p) {
    return "(" + shortest(p[0]) + ", " + shortest(p[1]) + ", " + shortest(p[2]) + ") m";
  };
  std::vector<Row> rows;
  for (const Obstacle& obstacle : obstacles) {
    if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape)) {
      const auto& h = box->half;
      rows.push_back(
          {obstacle.name, "box", "centre " + triple(box->centre), "sizes " + triple({2 * h[0], 2 * h[1], 2 * h[2]})});
      continue;
    }
    const auto& [axis, radius] = std::get<Capsule<double>>(obstacle.shape);
    const bool is_sphere = axis.from == axis.to;
    rows.push_back({obstacle.name, is_sphere ? "sphere" : "capsule",
                    is_sphere ? "centre " + triple(axis.from) : triple(axis.from) + " to " + triple(axis.to),
                    "radius " + with_unit(radius, "m")});
  }
  return rows;
}

std::vector<Row> tolerance_rows(const Study& study) {
  const ToleranceModel& model = *study.tolerances;
  const auto& parameters = study.machine->parts().mechanism->info().parameters;
  std::vector<Row> rows = {{"samples", std::to_string(model.samples)}};
  for (const ParameterError& error : model.errors) {
    const std::string& unit = parameters[error.parameter].unit;
    rows.push_back({error.name, "+-" + display_text(error.bound, unit),
                    error.sigma == 0 ? "uniform" : "normal, standard deviation " + display_text(error.sigma, unit)});
    for (const ErrorGroup& group : model.groups)
      if (group.errors.size() > 1 && contains(group.errors, static_cast<std::size_t>(&error - model.errors.data())))
        rows.back().back() += ", correlated with others";
  }
  return rows;
}

void write_options(std::ostream& out, const std::vector<OptionSpec>& specs, const Options& options) {
  std::vector<Row> rows;
  for (const auto& spec : specs) {
    const auto value = options.values().find(spec.name);
    if (value == options.values().end()) {
      rows.push_back({"  " + spec.name, "not set", "(default)"});
      continue;
    }
    const std::string unit = spec.kind == OptionKind::number && spec.unit != "1" ? " " + spec.unit : "";
    const bool initial = spec.initial && *spec.initial == value->second;
    rows.push_back({"  " + spec.name, to_text(value->second) + unit, mark(initial)});
  }
  out << aligned(rows);
}

void write_entries(std::ostream& out, const std::string& title, const std::vector<StudyEntry>& entries) {
  out << '\n' << title << (entries.empty() ? ": none" : "") << '\n';
  for (const auto& entry : entries) {
    out << "  " << printable(entry.name) << (entry.name == entry.type ? "" : " (" + entry.type + ")") << ": "
        << entry.role << '\n';
    write_options(out, entry.specs, entry.options);
  }
}

}  // namespace

std::string describe(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  std::ostringstream out;
  Study bare;
  bare.file_name = study.file_name;
  const std::string described = study.description ? "from " + study.description->file_name : "";
  std::vector<Row> head = {{"study", study.name, mark(study.name + ".h5" == bare.output_file())},
                           {"file", study.file_name},
                           {"seed", std::to_string(study.seed), mark(study.seed == bare.seed)},
                           {"output", study.output_file(), mark(study.output_file() == bare.output_file())},
                           {"mechanism", info.name + ": " + info.title, described}};
  if (!study.changes.empty()) head.push_back({"changed", "by " + join(study.changes, " ")});
  out << aligned(head);
  write_parameters(out, study);
  if (const DriveTrains* const trains = parts.mechanism->drive_trains()) {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < trains->size(); ++i) {
      const DriveTrain& train = (*trains)[i];
      const AxisInfo& joint = info.joints[i];
      rows.push_back({joint.name, "transmission ratio " + with_unit(train.ratio, joint.turns() ? "1" : "rad/m"),
                      "reflected inertia " + with_unit(train.reflected(), joint.turns() ? "kg m^2" : "kg"),
                      "efficiency " + shortest(train.efficiency)});
    }
    out << format_titled_table("drive trains", rows);
  }
  out << format_titled_table("workspace", survey_rows(info, parts.plan));
  for (const Region& region : parts.regions)
    out << format_titled_table("region " + region.name, survey_rows(info, region.plan));
  std::vector<Row> motions;
  for (const DesignMotion& named : study.motions)
    motions.push_back(
        {named.name, "takes " + with_unit(named.motion->duration(), "s"),
         contains(study.unfollowed_motions, named.name) ? "may violate limits of a pose (follow = false)" : ""});
  if (!motions.empty()) out << format_titled_table("motions", motions);
  if (const Obstacles& obstacles = parts.plan.limits.obstacles; !obstacles.empty())
    out << format_titled_table("obstacles, from which all moving links keep the clearance", obstacle_rows(obstacles));
  out << format_titled_table("limits of a pose", limit_rows(study));
  if (study.tolerances) out << format_titled_table("tolerances of built machines", tolerance_rows(study));
  write_entries(out, "objectives", study.objectives);
  write_entries(out, "constraints", study.constraints);
  write_entries(out, "outputs", study.outputs);
  out << "\nstages\n";
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const Stage& stage = study.stages[i];
    out << "  " << i + 1 << ". " << stage.entry->name << ": " << stage.entry->meaning << '\n';
    write_options(out, stage.specs, stage.options);
  }
  std::string round = "best design, not rounded";
  if (study.round) round = "best design rounded to " + with_unit(*study.round, study.round_unit) + ", evaluated again";
  std::vector<Row> run = {{"checkpoint",
                           study.checkpoint_every ? "every " + with_unit(*study.checkpoint_every, "s")
                                                  : "adaptive: at most 2 % of the run time",
                           mark(!study.checkpoint_every)},
                          {"final", round, mark(!study.round)}};
  if (parts.plan.voxels() && parts.mechanism->columns())
    run.push_back({"exact",
                   study.exact_seconds > 0
                       ? "exact values of final designs, at most " + with_unit(study.exact_seconds, "s")
                       : "no exact values of final designs",
                   mark(study.exact_seconds == Study().exact_seconds)});
  out << format_titled_table("run", run);
  for (const auto& warning : study.warnings) out << "\nwarning: " << warning << '\n';
  return out.str();
}

}  // namespace pkm
