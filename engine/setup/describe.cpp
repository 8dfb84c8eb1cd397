// The text of `pkmopt check`.

#include <algorithm>
#include <sstream>

#include "engine/core/catalogue.hpp"
#include "engine/core/text_table.hpp"
#include "engine/core/unit.hpp"
#include "engine/setup/study.hpp"

namespace pkm {
namespace {

using Row = std::vector<std::string>;

std::string range(double lower, double upper, const std::string& unit) {
  return shortest(lower) + " .. " + with_unit(upper, unit);
}

void write_parameters(std::ostream& out, const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const auto& known = parts.mechanism->info().parameters;
  std::vector<Row> varying, fixed;
  for (std::size_t v = 0; v < parts.varies.size(); ++v) {
    const std::size_t i = parts.varies[v];
    const Variable& variable = parts.space[v];
    std::string bounds = range(variable.lower, variable.upper, variable.unit);
    if (variable.step > 0) bounds += " in steps of " + with_unit(variable.step, variable.unit);
    std::string base;
    if (study.baseline) {
      const double value = (*study.baseline)[i];
      base = "baseline " + with_unit(value, variable.unit);
      if (value < variable.lower || value > variable.upper) base += " (outside the bounds)";
    }
    varying.push_back({variable.name, bounds, base, known[i].meaning});
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (std::find(parts.varies.begin(), parts.varies.end(), i) != parts.varies.end()) continue;
    const double value = parts.parameters[i];
    std::string note = value == known[i].nominal ? "(default)" : "";
    if (study.baseline && (*study.baseline)[i] != value)
      note += (note.empty() ? "" : " ") + ("baseline " + with_unit((*study.baseline)[i], known[i].unit));
    fixed.push_back({known[i].name, with_unit(value, known[i].unit), note, known[i].meaning});
  }
  out << "\nvariables" << (varying.empty() ? ": none" : "") << '\n';
  out << aligned(varying);
  out << "\nfixed parameters" << (fixed.empty() ? ": none" : "") << '\n';
  out << aligned(fixed);
}

/// "x = 0 m to 0.4 m, ..."
std::string box_text(const MechanismInfo& info, const SurveyPlan& plan) {
  std::string text;
  const Sweep& sweep = sweep_of(info, plan);
  for (std::size_t k = 0; k < sweep.swept.size(); ++k) {
    const AxisInfo& swept = info.coordinates[static_cast<std::size_t>(sweep.swept[k])];
    const auto& [lower, upper] = (*plan.box())[k];
    text += (k == 0 ? "" : ", ") + swept.name + " = " + range(lower, upper, swept.unit);
  }
  return text;
}

/// How a coordinate is held.
std::string held_text(const HeldCoordinate& held, const std::string& unit) {
  using Kind = HeldCoordinate::Kind;
  if (held.kind == Kind::middle) return "middle of each design";
  if (held.kind == Kind::integrated) return "integrated over its range";
  if (held.kind == Kind::value) return with_unit(held.value, unit);
  std::string values;
  for (const double value : held.values) values += (values.empty() ? "" : ", ") + with_unit(value, unit);
  return values;
}

std::vector<Row> survey_rows(const MechanismInfo& info, const SurveyPlan& plan) {
  const auto coordinate = [&info](int i) { return info.coordinates[static_cast<std::size_t>(i)]; };
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Row> rows;
  if (const VoxelOptions* const voxels = plan.voxels()) {
    std::string cells;
    for (std::size_t k = 0; k < sweep.swept.size(); ++k)
      cells += (k == 0 ? "" : ", ") + coordinate(sweep.swept[k]).name + " = " + std::to_string(voxels->cells[k]);
    for (const HeldCoordinate& held : plan.held)
      if (held.cells > 0) cells += ", " + coordinate(held.coordinate).name + " = " + std::to_string(held.cells);
    rows = {{"method", "voxels"},
            {"cells", cells},
            {"box", voxels->box ? box_text(info, plan) : "derived from each design"}};
  } else {
    const ColumnOptions& columns = *plan.columns();
    rows = {{"method", "columns"}};
    std::string nodes;
    std::size_t k = 0;
    for (const int swept : sweep.swept)
      if (swept != sweep.column)
        nodes += (nodes.empty() ? "" : ", ") + coordinate(swept).name + " = " + std::to_string(columns.nodes[k++]);
    if (columns.box) rows.push_back({"box", box_text(info, plan)});
    if (columns.nodes[0] > 0)
      rows.push_back({"nodes", nodes + " per piece"});
    else
      rows.push_back({"tolerance", shortest(columns.tolerance) + " relative"});
  }
  for (const int held : sweep.held)
    rows.push_back({coordinate(held).name, held_text(how_held(plan, held), coordinate(held).unit)});
  return rows;
}

std::vector<Row> limit_rows(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const auto& known = parts.mechanism->info().limits;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto& limit = known[i];
    std::string value = with_unit(limit.inactive, limit.unit), origin = "(default: cuts nothing)";
    if (const Parameter* own = find_named(parts.mechanism->info().parameters, limit.name)) {
      value = "the parameter";
      origin = "(default: " + own->name + " of the design)";
    }
    if (!study.limit_origins[i].empty()) {
      value = parts.plan.limits.given[i] ? with_unit(*parts.plan.limits.given[i], limit.unit) : limit.derivation;
      origin = "from " + study.limit_origins[i];
    }
    rows.push_back({limit.name, value, origin, limit.meaning});
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
    rows.push_back({"  " + spec.name, to_text(value->second) + unit, initial ? "(default)" : ""});
  }
  out << aligned(rows);
}

void write_entries(std::ostream& out, const std::string& title, const std::vector<StudyEntry>& entries) {
  out << '\n' << title << (entries.empty() ? ": none" : "") << '\n';
  for (const auto& entry : entries) {
    out << "  " << entry.name << (entry.name == entry.type ? "" : " (" + entry.type + ")") << ": " << entry.role
        << '\n';
    write_options(out, entry.specs, entry.options);
  }
}

}  // namespace

std::string describe(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const MechanismInfo& info = parts.mechanism->info();
  std::ostringstream out;
  out << aligned({{"study", study.name},
                  {"file", study.file_name},
                  {"seed", std::to_string(study.seed)},
                  {"output", study.output_file()},
                  {"mechanism", info.name + ": " + info.title}});
  write_parameters(out, study);
  out << "\nworkspace\n";
  out << aligned(survey_rows(info, parts.plan));
  for (const Region& region : parts.regions) {
    out << "\nregion " << region.name << '\n';
    out << aligned(survey_rows(info, region.plan));
  }
  std::vector<Row> motions;
  for (const NamedMotion& named : study.motions)
    motions.push_back({named.name, "takes " + with_unit(named.motion->duration(), "s")});
  if (!motions.empty()) out << "\nmotions\n" << aligned(motions);
  out << "\nlimits of a pose" << (info.limits.empty() ? ": none" : "") << '\n';
  out << aligned(limit_rows(study));
  write_entries(out, "objectives", study.objectives);
  write_entries(out, "constraints", study.constraints);
  write_entries(out, "reports", study.reports);
  out << "\nstages\n";
  for (std::size_t i = 0; i < study.stages.size(); ++i) {
    const Stage& stage = study.stages[i];
    out << "  " << i + 1 << ". " << stage.entry->name << ": " << stage.entry->meaning << '\n';
    write_options(out, stage.specs, stage.options);
  }
  std::string round = "best design as it is";
  if (study.round) round = "best design rounded to " + with_unit(*study.round, study.round_unit) + ", evaluated again";
  out << "\nrun\n";
  out << aligned({{"checkpoint", study.checkpoint_every ? "every " + with_unit(*study.checkpoint_every, "s")
                                                        : "adapts: at most 2 % of the run time"},
                  {"final", round}});
  for (const auto& warning : study.warnings) out << "\nwarning: " << warning << '\n';
  return out.str();
}

}  // namespace pkm
