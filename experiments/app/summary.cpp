#include "experiments/app/summary.hpp"

#include <cmath>
#include <sstream>

#include "engine/core/catalogue.hpp"
#include "engine/core/printable.hpp"
#include "engine/report/json_text.hpp"
#include "engine/results/comparison.hpp"
#include "engine/results/design_table.hpp"
#include "engine/runner/progress.hpp"
#include "experiments/app/stage_summary.hpp"

namespace pkm {
namespace {

constexpr std::string_view kExactSuffix = ", exact";  // end of the name of a table line with exact values

/// Returns true if the row of exact values prints no more than the row of the values by voxels before it.
bool repeats(const Row& exact, const Row& voxels) {
  for (std::size_t i = 1; i < exact.size(); ++i)
    if (!exact[i].empty() && exact[i] != voxels[i]) return false;
  return true;
}

/// A row for each variable, objective and constraint; columns: best, rounded, baseline, gain ("+1.52 %"), references.
std::vector<Row> table(const StudyContents& contents, const Study& study) {
  const DesignTable designs = design_table(contents, study.references);
  const ProblemRecord& problem = contents.problem;
  /// Adds values, all in the same unit, to a row.
  const auto append = [&](Row& row, const DesignTable::Line& line, const std::vector<std::optional<double>>& values,
                          const DisplayUnit& unit) {
    for (const auto& value : values) {
      if (value && line.kind == "certified") {  // bounds are rounded outwards
        const int direction = line.name.ends_with("at least") ? -1 : line.name.ends_with("at most") ? 1 : 0;
        const int count = std::max(7, significant_digits());
        const double shown = *value / unit.size;
        row.push_back(direction == 0 ? digits(shown, count) : directed_digits(shown, count, direction));
        continue;
      }
      const Variable* const variable = line.kind == "variable" ? find_named(problem.variables, line.name) : nullptr;
      const auto index = [&] { return static_cast<std::size_t>(variable - problem.variables.data()); };
      row.push_back(!value     ? ""
                    : variable ? variable_text(problem, index(), *value, unit)
                               : digits(*value / unit.size));
    }
  };
  std::vector<Row> rows = {{"", ""}};
  for (const auto& column : designs.columns) rows[0].push_back(column.name);
  if (designs.has_baseline()) rows[0].push_back("gain");
  for (const auto& r : study.references) rows[0].push_back(r.name);
  for (const DesignTable::Line& line : designs.lines) {
    double greatest = 0;
    for (const auto* const values : {&line.values, &line.published})
      for (const auto& value : *values)
        if (value) greatest = std::fmax(greatest, std::fabs(*value));
    const DisplayUnit unit =
        line.kind == "variable" ? display_unit(line.unit, greatest) : result_unit(line.unit, greatest);
    Row row = {line.name + (line.kind == "constraint" ? " margin" : ""), unit.name};
    append(row, line, line.values, unit);
    if (designs.has_baseline())
      row.push_back(line.gain ? formatted("%+.2f %%", line.gain->percent) + (line.gain->worse ? ", worse" : "") : "");
    append(row, line, line.published, unit);
    if (line.name.ends_with(kExactSuffix) && repeats(row, rows.back())) continue;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// A sentence on an active bound or constraint for the terminal; the sentence in the study file states bounds in SI
/// units.
std::string active_text(const ProblemRecord& problem, const std::string& sentence) {
  for (const Variable& v : problem.variables)
    for (const auto& [which, bound] : {std::pair(" at its lower bound ", v.lower), {" at its upper bound ", v.upper}})
      if (sentence.starts_with(v.name + which)) return v.name + which + display_text(bound, v.unit);
  return sentence;
}

/// Text that states the most violated constraint of a design and its margin; "" if all are satisfied.
std::string violation(const StudyContents& contents, const DesignRecord& best) {
  const auto worst = most_violated(best.margins);
  if (!worst) return "";
  return contents.problem.margins[*worst].name + " is violated, margin " +
         result_text(best.margins[*worst], contents.problem.margins[*worst].unit);
}

/// The reason why the rounded design should not be used, as the end of a sentence; "" if it can be used.
std::string rounded_remarks(const StudyContents& contents, const DesignRecord& rounded) {
  std::vector<std::string> remarks;
  for (const std::string& remark : {rounded.reason, violation(contents, rounded)})
    if (!remark.empty()) remarks.push_back(remark);
  if (remarks.empty()) return "";
  return (rounded.status == Status::feasible ? ", but " : ": ") + join(remarks, "; ");
}

Json certified_json(const VolumeBounds& bounds) {
  return {{"lower", bounds.lower}, {"upper", bounds.upper}, {"gap", bounds.gap()}};
}

Json design_json(const ProblemRecord& problem, const DesignRecord& record) {
  Json design = Json::object();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i)
    if (const ParameterRecord& p = problem.parameters[i]; p.variable >= 0)
      design[p.name] = variable_json(problem, static_cast<std::size_t>(p.variable), record.parameters[i]);
  Json object = {{"design", design},
                 {"objectives", values_by_name(problem.objectives, record.objectives)},
                 {"constraints", values_by_name(problem.margins, record.margins)},
                 {"outputs", values_by_name(problem.reports, record.reports)},
                 {"status", words(record.status)},
                 {"volume", record.volume}};
  if (record.certified) object["certified"] = certified_json(*record.certified);
  if (!record.reason.empty()) object["reason"] = record.reason;
  return object;
}

Json failures_json(const Failures& failures) {
  Json reasons = Json::array();
  for (const FailureReason& reason : failures.reasons)
    reasons.push_back({{"count", reason.count}, {"example", reason.example}});
  return {{"failed", failures.failed}, {"examined", failures.examined}, {"reasons", reasons}};
}

}  // namespace

std::string reasons_text(const std::vector<Reason>& reasons) {
  std::string text;
  for (const Reason& reason : reasons) text += "  " + printable(reason.sentence) + '\n';
  return text;
}

std::string summary_text(const StudyContents& contents, const Study& study, const std::optional<Diagnosis>& diagnosis) {
  std::ostringstream out;
  out << printable(contents.name) << ": " << words(contents.state) << ", " << contents.evaluations()
      << " evaluations in " << duration_text(contents.seconds) << ", seed " << contents.seed << '\n';
  if (!study.changes.empty()) out << "changed by " << printable(join(study.changes, " ")) << '\n';
  for (std::size_t i = 0; i < contents.stages.size(); ++i) {
    const StageRecord& stage = contents.stages[i];
    out << "stage " << i + 1 << ": " << stage.optimiser << ", ";
    const bool has_starts =  // true even if the stage was interrupted before its first start ended
        !stage.starts.empty() ||
        (i < study.stages.size() && study.stages[i].entry->capabilities(study.stages[i].options).starts);
    if (!has_starts)
      out << stage.generations.size() << " generations, ";
    else
      out << stage.starts.size() << (stage.starts.size() == 1 ? " start, " : " starts, ");
    out << stage.table.size() << " evaluations" << (stage.stop.empty() ? "" : ", ended: " + stage.stop) << '\n'
        << starts_text(contents.problem, stage) << front_text(contents.problem, stage);
  }
  if (const std::string text = failures_text(collect_failures(contents, study.problem.get())); !text.empty())
    out << printable(text) << '\n';
  for (const std::string& note : contents.notes) out << "note: " << printable(note) << '\n';
  if (!contents.reproducible())
    out << "note: a time limit stopped a start, so another run with the same seed may give a different result\n";
  if (!contents.final) {
    if (contents.best.row >= 0 && !contents.problem.objectives.empty()) {
      const StageRecord& stage = contents.best_stage();
      const auto row = static_cast<std::size_t>(contents.best.row);
      const Status status = stage.table.status[row];
      out << (status == Status::feasible ? "best so far:" : "best so far, which is " + words(status) + ":");
      for (std::size_t i = 0; i < contents.problem.variables.size(); ++i)
        out << ' ' << printable(contents.problem.variables[i].name) << " = "
            << printable(variable_text(contents.problem, i, stage.table.design(row)[i]));
      for (std::size_t i = 0; i < contents.problem.objectives.size(); ++i)
        out << ", " << printable(contents.problem.objectives[i].name) << " = "
            << result_text(stage.table.objective_row(row)[i], contents.problem.objectives[i].unit);
      out << '\n';
    }
    return out.str();
  }
  const FinalRecord& final = *contents.final;
  if (!final.best) {
    out << "no best design: the study has no objective\n";
    return out.str();
  }
  const std::vector<std::string> errors = contradicted(contents);
  for (const std::string& sentence : errors) out << sentence << '\n';
  if (final.best->status == Status::failed && final.best->certified)
    out << "do not use the values of the best design\n";
  else if (final.best->status == Status::failed)
    out << "no design could be evaluated: " << final.best->reason << '\n';
  else if (final.best->status != Status::feasible)
    out << "nothing feasible was found; this is the least infeasible design: " << violation(contents, *final.best)
        << '\n';
  out << '\n' << aligned(table(contents, study)) << '\n';
  if (final.rounded && (final.rounded->status != Status::feasible || !final.rounded->reason.empty()))
    out << "the rounded design is " << words(final.rounded->status) << rounded_remarks(contents, *final.rounded)
        << '\n';
  const StageRecord& of_best = contents.best_stage();
  out << optimality_text(contents.problem, of_best.optimality ? of_best : contents.stages.back());
  std::vector<std::string> active;
  for (const std::string& sentence : final.active) active.push_back(active_text(contents.problem, sentence));
  if (!active.empty()) out << "active: " << join(active, "; ") << '\n';
  if (final.best->touches_box)
    out << "warning: feasible cells of the best design touch the box; a larger box may contain more workspace\n";
  for (const auto& r : study.references)
    if (r.seconds)
      out << "published computing time of " << printable(r.name) << ": " << duration_text(*r.seconds) << '\n';
  if (diagnosis)
    out << "diagnosis: " << diagnosis->finding << ": " << diagnosis->sentence << '\n'
        << reasons_text(diagnosis->reasons);
  return out.str();
}

Json summary_json(const StudyContents& contents, const std::optional<Diagnosis>& diagnosis, const Failures& failures) {
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
  object["diagnosis"] = diagnosis_json(diagnosis);
  object["failures"] = failures_json(failures);
  object["best"] = nullptr;
  if (contents.best.row >= 0) {
    const StageRecord& stage = contents.best_stage();
    const auto row = static_cast<std::size_t>(contents.best.row);
    object["best"] = row_json(contents.problem, stage.table, row);
    object["best"].update({{"status", words(stage.table.status[row])},
                           {"stage", contents.best.stage + 1},
                           {"generation", stage.generations.generation_of_rows(stage.table.size())[row]}});
    if (contents.final && contents.final->best && contents.final->best->certified) {
      const DesignRecord& best = *contents.final->best;
      object["best"].update({{"volume", best.volume}, {"certified", certified_json(*best.certified)}});
      if (best.status == Status::failed)
        object["best"].update({{"status", words(best.status)}, {"reason", best.reason}});
    }
  }
  if (contents.final) {
    const FinalRecord& final = *contents.final;
    for (const auto& [key, record] : {std::pair("baseline", &final.baseline),
                                      {"rounded", &final.rounded},
                                      {"best_exact", &final.best_exact},
                                      {"baseline_exact", &final.baseline_exact}})
      if (*record) object[key] = design_json(contents.problem, **record);
    object["active"] = final.active;
  }
  return object;
}

}  // namespace pkm
