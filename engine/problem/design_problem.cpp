#include "engine/problem/design_problem.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

/// The margin that a named quantity stands for.
template <class S>
S margin_of(const NamedQuantity& named, const S& value) {
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

Status DesignProblem::compute(std::span<const double> parameters, Survey<double>& survey, EvaluationSlot result) const {
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
  if (rejected && result.detail == Detail::enough) return Status::rejected;

  if (result.detail == Detail::derivatives) {
    differentiate(parameters, parts_.varies, result.slopes, survey);
    for (const double slope : result.slopes) usable = usable && std::isfinite(slope);
  } else {
    surveyor_->survey(parameters, survey);
  }
  view.survey = &survey;
  for (const auto& q : parts_.survey_margins)
    holds = put(result.margins[margin++], margin_of(q, q.quantity->value(view))) >= 0 && holds;
  for (std::size_t i = 0; i < parts_.objectives.size(); ++i)
    put(result.objectives[i], parts_.objectives[i].quantity->value(view));
  for (std::size_t i = 0; i < parts_.reports.size(); ++i) result.reports[i] = parts_.reports[i].quantity->value(view);
  if (!usable) return Status::failed;
  return rejected ? Status::rejected : holds ? Status::feasible : Status::infeasible;
}

void DesignProblem::differentiate(std::span<const double> parameters, std::span<const std::size_t> by,
                                  std::span<double> slopes, Survey<double>& survey) const {
  constexpr std::size_t kDirections = 4;
  thread_local std::vector<Dual4> all;
  thread_local Survey<Dual4> dual_survey;
  const std::size_t width = 1 + by.size();
  for (std::size_t first = 0; first < std::max<std::size_t>(by.size(), 1); first += kDirections) {
    const std::size_t count = std::min(kDirections, by.size() - first);
    all.assign(parameters.begin(), parameters.end());
    for (std::size_t k = 0; k < count; ++k) all[by[first + k]].v[static_cast<int>(k)] = 1;
    surveyor_->survey(all, dual_survey);
    if (first == 0) copy_values(dual_survey, survey);
    DesignView<Dual4> view{*parts_.mechanism, all, nullptr};
    std::size_t row = 0;
    const auto put = [&](const Dual4& value) {
      const auto at = slopes.subspan(width * row++, width);
      at[0] = value.a;
      for (std::size_t k = 0; k < count; ++k) at[1 + first + k] = value.v[static_cast<int>(k)];
    };
    const auto put_margins = [&](const std::vector<NamedQuantity>& list) {
      for (const auto& q : list) put(margin_of(q, q.quantity->smooth(view)));
    };
    row = parts_.objectives.size();
    put_margins(parts_.design_margins);
    view.survey = &dual_survey;
    put_margins(parts_.survey_margins);
    row = 0;
    for (const auto& q : parts_.objectives) put(q.quantity->smooth(view));
  }
}

std::vector<double> DesignProblem::slopes(std::span<const double> parameters, std::span<const std::size_t> by) const {
  std::vector<double> slopes((objectives_.size() + margins_.size()) * (1 + by.size()));
  Survey<double> survey;
  differentiate(parameters, by, slopes, survey);
  return slopes;
}

void DesignProblem::evaluate(std::span<const double> design, EvaluationSlot result) const {
  thread_local Survey<double> survey;
  thread_local std::vector<double> all;
  try {
    all.assign(parts_.parameters.begin(), parts_.parameters.end());
    for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
    result.status = compute(all, survey, result);
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
    report.status = compute(parameters, report.survey,
                            {report.objectives, report.margins, report.reports, report.status, Detail::complete});
    if (report.status == Status::failed) report.reason = "an objective or a margin is not a finite number";
  } catch (const std::exception& error) {
    report.status = Status::failed;
    report.reason = error.what();
  }
  return report;
}

}  // namespace pkm
