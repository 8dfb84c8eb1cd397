#include "engine/results/comparison.hpp"

#include <cmath>

namespace pkm {

std::optional<Gain> gain_over(double baseline, double value, Direction direction) {
  if (!(std::fabs(baseline) > 0) || std::isnan(value)) return {};
  const double percent = 100 * (value - baseline) / std::fabs(baseline);
  return Gain{percent, percent != 0 && (direction == Direction::maximise) != (percent > 0)};
}

std::optional<DesignRecord> best_so_far(const StudyContents& contents) {
  if (contents.best.row < 0) return {};
  const EvaluationTable& table = contents.best_stage().table;
  const auto row = static_cast<std::size_t>(contents.best.row);
  const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
  DesignRecord record;
  for (const ParameterRecord& p : contents.problem.parameters)
    record.parameters.push_back(p.variable < 0 ? p.value : table.design(row)[static_cast<std::size_t>(p.variable)]);
  record.objectives = copy(table.objective_row(row));
  record.margins = copy(table.margin_row(row));
  record.reports = copy(table.output_row(row));
  record.status = table.status[row];
  return record;
}

namespace {

std::vector<const EvaluationTable*> tables_of(const StudyContents& contents) {
  std::vector<const EvaluationTable*> tables;
  for (const StageRecord& stage : contents.stages) tables.push_back(&stage.table);
  return tables;
}

}  // namespace

std::optional<Diagnosis> diagnose(const StudyContents& contents, const DesignProblem* problem) {
  if (contents.state != StudyState::finished) return {};
  return diagnose(tables_of(contents), contents.problem.objectives, contents.problem.margins, problem);
}

Failures collect_failures(const StudyContents& contents, const DesignProblem* problem) {
  return collect_failures(tables_of(contents), problem);
}

std::string best_design_label(const StudyContents& contents) {
  if (diagnose(contents, nullptr)) {
    const Status status = contents.best_stage().table.status[static_cast<std::size_t>(contents.best.row)];
    if (status != Status::feasible) return "least infeasible";
    const bool has_workspace = contents.final && contents.final->best && contents.final->best->volume > 0;
    if (!has_workspace) return "empty workspace";
  }
  if (contents.problem.objectives.size() > 1) return "compromise";
  return contents.final ? "best" : "best so far";
}

std::vector<std::string> contradicted(const StudyContents& contents) {
  std::vector<std::string> sentences;
  if (!contents.final) return sentences;
  const auto add = [&sentences](const std::string& name, const std::optional<DesignRecord>& design) {
    if (design && design->certified && design->status == Status::failed)
      sentences.push_back("the " + name + " fails: " + design->reason);
  };
  add("best design", contents.final->best);
  add("rounded design", contents.final->rounded);
  add("baseline", contents.final->baseline);
  return sentences;
}

std::optional<std::size_t> most_violated(std::span<const double> margins) {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < margins.size(); ++i)
    if (margins[i] < 0 && (!worst || margins[i] < margins[*worst])) worst = i;
  return worst;
}

}  // namespace pkm
