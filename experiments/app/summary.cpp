#include "experiments/app/summary.hpp"

#include <cmath>
#include <sstream>

#include "engine/core/text_table.hpp"
#include "engine/report/standing.hpp"
#include "engine/study/progress.hpp"
#include "experiments/app/front_summary.hpp"
#include "experiments/app/solver_summary.hpp"

namespace pkm {
namespace {

/// "+1.52 %": how much better than the baseline, in the objective's direction.
std::string gain(double best, double baseline, Direction direction) {
  const std::optional<Gain> found = gain_over(baseline, best, direction);
  if (!found) return "";
  char text[48];
  std::snprintf(text, sizeof text, "%+.2f %%%s", found->percent, found->worse ? ", worse" : "");
  return text;
}

/// The table's columns beside the names: best, baseline, gain, rounded, references.
struct Columns {
  const StudyContents& contents;
  const Study& study;
  const FinalRecord& final;

  std::vector<std::string> header() const {
    std::vector<std::string> row = {"", "", contents.problem.objectives.size() > 1 ? "compromise" : "best"};
    if (final.rounded) row.push_back("rounded");
    if (final.baseline) row.insert(row.end(), {"baseline", "gain"});
    for (const auto& r : study.references) row.push_back(r.name);
    return row;
  }

  std::vector<std::string> parameter(std::size_t variable, std::size_t index) const {
    const auto& p = contents.problem.parameters[index];
    std::vector<std::string> row = {p.name, p.unit, digits(final.best->parameters[index])};
    if (final.rounded) row.push_back(digits(final.rounded->parameters[index]));
    if (final.baseline) row.insert(row.end(), {digits(final.baseline->parameters[index]), ""});
    for (const auto& r : study.references)
      row.push_back(!r.design.empty() && r.design[variable] ? digits(*r.design[variable]) : "");
    return row;
  }

  /// An objective or report: `of` takes the value from a record.
  template <class Of>
  std::vector<std::string> value(const std::string& name, const std::string& unit, std::optional<Direction> direction,
                                 const std::optional<DesignRecord>& best, const std::optional<DesignRecord>& baseline,
                                 bool exact, const Of& of) const {
    std::vector<std::string> row = {exact ? name + ", exact" : name, unit, best ? digits(of(*best)) : "-"};
    if (final.rounded) row.push_back(exact ? "" : digits(of(*final.rounded)));
    if (final.baseline) {
      row.push_back(baseline ? digits(of(*baseline)) : "-");
      row.push_back(best && baseline && direction ? gain(of(*best), of(*baseline), *direction) : "");
    }
    for (const auto& r : study.references) {
      std::string text;
      for (const auto& [key, v] : r.values)
        if (key == name && !exact) text = digits(v);
      row.push_back(text);
    }
    return row;
  }
};

std::vector<std::vector<std::string>> table(const StudyContents& contents, const Study& study) {
  const Columns columns{contents, study, *contents.final};
  const FinalRecord& final = *contents.final;
  std::vector<std::vector<std::string>> rows = {columns.header()};
  for (std::size_t i = 0; i < contents.problem.parameters.size(); ++i)
    if (const auto v = contents.problem.parameters[i].variable; v >= 0)
      rows.push_back(columns.parameter(static_cast<std::size_t>(v), i));
  const auto& problem = contents.problem;
  const auto add = [&](const std::string& name, const std::string& unit, std::optional<Direction> direction,
                       const auto& of) {
    rows.push_back(columns.value(name, unit, direction, final.best, final.baseline, false, of));
    if (final.best_exact)
      rows.push_back(columns.value(name, unit, direction, final.best_exact, final.baseline_exact, true, of));
  };
  for (std::size_t i = 0; i < problem.objectives.size(); ++i)
    add(problem.objectives[i].name, problem.objectives[i].unit, problem.objectives[i].direction,
        [i](const DesignRecord& r) { return r.objectives[i]; });
  for (std::size_t i = 0; i < problem.reports.size(); ++i)
    add(problem.reports[i].name, problem.reports[i].unit, std::optional<Direction>(),
        [i](const DesignRecord& r) { return r.reports[i]; });
  for (std::size_t i = 0; i < problem.margins.size(); ++i)
    rows.push_back(columns.value(problem.margins[i].name + " margin", problem.margins[i].unit, {}, final.best,
                                 final.baseline, false, [i](const DesignRecord& r) { return r.margins[i]; }));
  return rows;
}

/// Which constraint keeps a design from being feasible.
std::string blocking(const StudyContents& contents, const DesignRecord& best) {
  const auto worst = most_broken(best.margins);
  if (!worst) return "";
  return contents.problem.margins[*worst].name + " blocks, margin " + digits(best.margins[*worst]) + " " +
         contents.problem.margins[*worst].unit;
}

/// What is wrong with the rounded design, as far as it is known.
std::string rounded_remarks(const StudyContents& contents, const DesignRecord& rounded) {
  std::vector<std::string> remarks;
  for (const std::string& remark : {rounded.reason, blocking(contents, rounded)})
    if (!remark.empty()) remarks.push_back(remark);
  if (remarks.empty()) return "";
  return (rounded.status == Status::feasible ? ", but " : ": ") + join(remarks, "; ");
}

std::int64_t generation_of(const StageRecord& stage, std::int64_t row) {
  std::int64_t generation = 0;
  for (std::size_t g = 0; g < stage.generations.size(); ++g)
    if (stage.generations.first_row[g] <= row) generation = static_cast<std::int64_t>(g);
  return generation;
}

Json design_json(const ProblemRecord& problem, const DesignRecord& record) {
  Json design = Json::object();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i)
    if (problem.parameters[i].variable >= 0) design[problem.parameters[i].name] = record.parameters[i];
  Json object = {{"design", design},
                 {"objectives", values_by_name(problem.objectives, record.objectives)},
                 {"constraints", values_by_name(problem.margins, record.margins)},
                 {"reports", values_by_name(problem.reports, record.reports)},
                 {"status", words(record.status)},
                 {"volume", record.volume}};
  if (!record.reason.empty()) object["reason"] = record.reason;
  return object;
}

}  // namespace

std::string summary_text(const StudyContents& contents, const Study& study) {
  std::ostringstream out;
  out << contents.name << ": " << words(contents.state) << ", " << contents.evaluations() << " evaluations in "
      << duration_text(contents.seconds) << ", seed " << contents.seed << '\n';
  for (std::size_t i = 0; i < contents.stages.size(); ++i) {
    const StageRecord& stage = contents.stages[i];
    out << "stage " << i + 1 << ": " << stage.optimiser << ", ";
    if (stage.starts.empty())
      out << stage.generations.size() << " generations, ";
    else
      out << stage.starts.size() << (stage.starts.size() == 1 ? " start, " : " starts, ");
    out << stage.table.size() << " evaluations" << (stage.stop.empty() ? "" : ", ended: " + stage.stop) << '\n'
        << starts_text(contents.problem, stage) << front_text(contents.problem, stage);
  }
  for (const std::string& note : contents.notes) out << "note: " << note << '\n';
  if (!contents.reproducible())
    out << "note: the clock ended a start, so another run with this seed may end elsewhere\n";
  if (!contents.final) {
    if (contents.best.row >= 0 && !contents.problem.objectives.empty()) {
      const StageRecord& stage = contents.stages[static_cast<std::size_t>(contents.best.stage)];
      const auto row = static_cast<std::size_t>(contents.best.row);
      const Status status = stage.table.status[row];
      out << (status == Status::feasible ? "best so far:" : "best so far, which is " + words(status) + ":");
      for (std::size_t i = 0; i < contents.problem.variables.size(); ++i)
        out << ' ' << contents.problem.variables[i].name << " = " << digits(stage.table.design(row)[i]);
      for (std::size_t i = 0; i < contents.problem.objectives.size(); ++i)
        out << ", " << contents.problem.objectives[i].name << " = " << digits(stage.table.objective_row(row)[i]);
      out << '\n';
    }
    return out.str();
  }
  const FinalRecord& final = *contents.final;
  if (!final.best) {
    out << "no best design: the study has no objective\n";
    return out.str();
  }
  if (final.best->status == Status::failed)
    out << "no design could be evaluated: " << final.best->reason << '\n';
  else if (final.best->status != Status::feasible)
    out << "nothing feasible was found; this is the least infeasible design: " << blocking(contents, *final.best)
        << '\n';
  out << '\n' << aligned(table(contents, study)) << '\n';
  if (final.rounded && (final.rounded->status != Status::feasible || !final.rounded->reason.empty()))
    out << "the rounded design is " << words(final.rounded->status) << rounded_remarks(contents, *final.rounded)
        << '\n';
  const StageRecord& of_best = contents.stages[static_cast<std::size_t>(contents.best.stage)];
  const StageRecord& last = contents.stages.back();
  out << optimality_text(contents.problem, of_best.optimality ? of_best : last);
  if (!final.active.empty()) out << "active: " << join(final.active, "; ") << '\n';
  if (final.best->touches_box)
    out << "warning: feasible cells of the best design touch the box; a larger box may hold more workspace\n";
  for (const auto& r : study.references)
    if (r.seconds && contents.seconds > 0)
      out << r.name << " took " << duration_text(*r.seconds) << ": this study is "
          << digits(std::round(*r.seconds / contents.seconds)) << " times as fast\n";
  return out.str();
}

Json summary_json(const StudyContents& contents) {
  Json object = {{"name", contents.name},
                 {"mechanism", contents.problem.mechanism},
                 {"state", words(contents.state)},
                 {"seed", contents.seed},
                 {"evaluations", contents.evaluations()},
                 {"seconds", contents.seconds},
                 {"program", contents.program_version + " (" + contents.program_revision + ")"}};
  Json stages = Json::array();
  for (const StageRecord& stage : contents.stages) {
    stages.push_back({{"optimiser", stage.optimiser},
                      {"generations", stage.generations.size()},
                      {"evaluations", stage.table.size()},
                      {"finished", stage.finished},
                      {"stop", stage.stop}});
    if (!stage.starts.empty()) stages.back()["starts"] = starts_json(contents.problem, stage);
    if (stage.optimality) stages.back()["optimality"] = optimality_json(*stage.optimality);
    if (stage.front) stages.back()["front"] = front_json(contents.problem, stage);
  }
  object["stages"] = stages;
  object["reproducible"] = contents.reproducible();
  object["notes"] = contents.notes;
  object["stop"] = contents.stages.empty() ? "" : contents.stages.back().stop;
  object["best"] = nullptr;
  if (contents.best.row >= 0) {
    const StageRecord& stage = contents.stages[static_cast<std::size_t>(contents.best.stage)];
    const auto row = static_cast<std::size_t>(contents.best.row);
    object["best"] = {{"design", values_by_name(contents.problem.variables, stage.table.design(row))},
                      {"objectives", values_by_name(contents.problem.objectives, stage.table.objective_row(row))},
                      {"constraints", values_by_name(contents.problem.margins, stage.table.margin_row(row))},
                      {"reports", values_by_name(contents.problem.reports, stage.table.report_row(row))},
                      {"status", words(stage.table.status[row])},
                      {"stage", contents.best.stage + 1},
                      {"generation", generation_of(stage, contents.best.row)}};
  }
  if (contents.final) {
    const FinalRecord& final = *contents.final;
    const auto add = [&](const char* key, const std::optional<DesignRecord>& record) {
      if (record) object[key] = design_json(contents.problem, *record);
    };
    add("baseline", final.baseline);
    add("rounded", final.rounded);
    add("best_exact", final.best_exact);
    add("baseline_exact", final.baseline_exact);
    object["active"] = final.active;
  }
  return object;
}

}  // namespace pkm
