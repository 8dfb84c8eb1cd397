#include "engine/problem/design_problem.hpp"

#include <cmath>

namespace pkm {
namespace {

/// The margin that a named quantity stands for.
double margin_of(const NamedQuantity& named, double value) {
  if (named.least) return value - *named.least;
  if (named.greatest) return *named.greatest - value;
  return value;
}

}  // namespace

DesignProblem::DesignProblem(ProblemParts parts)
    : parts_(std::move(parts)), surveyor_(parts_.mechanism->prepare(parts_.plan, parts_.demand)) {
  for (const auto& q : parts_.objectives) objectives_.push_back({q.name, q.unit, q.meaning, q.direction});
  for (const auto* list : {&parts_.design_margins, &parts_.survey_margins})
    for (const auto& q : *list) margins_.push_back({q.name, q.unit, q.meaning});
  for (const auto& q : parts_.reports) reports_.push_back({q.name, q.unit, q.meaning});
}

std::vector<double> DesignProblem::parameters(std::span<const double> design) const {
  std::vector<double> all = parts_.parameters;
  for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
  return all;
}

Status DesignProblem::compute(std::span<const double> parameters, Survey<double>& survey, bool always_survey,
                              EvaluationSlot result) const {
  DesignView<double> view{*parts_.mechanism, parameters, nullptr};
  bool holds = true, usable = true;
  const auto put = [&](double& place, double value) {
    place = value;
    usable = usable && std::isfinite(value);
    return value;
  };
  std::size_t margin = 0;
  for (const auto& q : parts_.design_margins)
    holds = put(result.margins[margin++], margin_of(q, q.quantity->value(view))) >= 0 && holds;
  if (!usable) return Status::failed;
  const bool rejected = !holds;
  if (rejected && !always_survey) return Status::rejected;

  surveyor_->survey(parameters, survey);
  view.survey = &survey;
  for (const auto& q : parts_.survey_margins)
    holds = put(result.margins[margin++], margin_of(q, q.quantity->value(view))) >= 0 && holds;
  for (std::size_t i = 0; i < parts_.objectives.size(); ++i)
    put(result.objectives[i], parts_.objectives[i].quantity->value(view));
  for (std::size_t i = 0; i < parts_.reports.size(); ++i) result.reports[i] = parts_.reports[i].quantity->value(view);
  if (!usable) return Status::failed;
  return rejected ? Status::rejected : holds ? Status::feasible : Status::infeasible;
}

void DesignProblem::evaluate(std::span<const double> design, EvaluationSlot result) const {
  thread_local Survey<double> survey;
  thread_local std::vector<double> all;
  try {
    all.assign(parts_.parameters.begin(), parts_.parameters.end());
    for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
    result.status = compute(all, survey, false, result);
  } catch (const std::exception&) {
    result.status = Status::failed;
  }
}

DesignReport DesignProblem::report(std::span<const double> parameters) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  DesignReport report;
  report.parameters.assign(parameters.begin(), parameters.end());
  report.objectives.assign(objectives_.size(), nan);
  report.margins.assign(margins_.size(), nan);
  report.reports.assign(reports_.size(), nan);
  try {
    report.status =
        compute(parameters, report.survey, true, {report.objectives, report.margins, report.reports, report.status});
    if (report.status == Status::failed) report.reason = "an objective or a margin is not a finite number";
  } catch (const std::exception& error) {
    report.status = Status::failed;
    report.reason = error.what();
  }
  return report;
}

}  // namespace pkm
