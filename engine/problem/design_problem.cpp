#include "engine/problem/design_problem.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/workspace/survey_set.hpp"

namespace pkm {
namespace {

/// The margin of a constraint, from the value of its quantity and its bounds.
template <class S>
S margin_of(const NamedQuantity& named, const S& value) {
  if (named.least) return value - *named.least;
  if (named.greatest) return *named.greatest - value;
  return value;
}

/// For each workspace analysis, whether a quantity uses it: the workspace's first, then those of the regions.
std::vector<bool> used_surveys(const ProblemParts& parts) {
  std::vector<bool> used(1 + parts.regions.size());
  for (const auto* list : {&parts.objectives, &parts.workspace_margins, &parts.reports})
    for (const auto& q : *list)
      if (q.uses_workspace) used[q.survey] = true;
  return used;
}

}  // namespace

struct DesignProblem::Buffers {
  std::vector<double> parameters;
  std::vector<Dual4> duals;  ///< the parameters with derivatives
  Surveys<double> surveys;
  Surveys<Dual4> dual_surveys;
};

DesignProblem::DesignProblem(ProblemParts parts) : parts_(std::move(parts)), used_(used_surveys(parts_)) {
  surveyors_.push_back(prepare_workspace(*parts_.mechanism, parts_.plan, parts_.demand));
  if (const ColumnOptions* const columns = parts_.plan.columns(); columns && columns->certain)
    parts_.mechanism->bounds()->refuse_bounds(parts_.plan);
  for (const Region& region : parts_.regions)
    surveyors_.push_back(prepare_workspace(*parts_.mechanism, region.plan, region.demand));
  for (const auto& q : parts_.objectives) objectives_.push_back({q.name, q.unit, q.meaning, q.direction});
  for (const auto* list : {&parts_.design_margins, &parts_.workspace_margins})
    for (const auto& q : *list) margins_.push_back({q.name, q.unit, q.meaning});
  for (const auto& q : parts_.reports) reports_.push_back({q.name, q.unit, q.meaning});
}

Unsupported DesignProblem::no_derivatives() const {
  for (std::size_t k = 0; k < used_.size(); ++k) {
    if (!used_[k]) continue;
    if (!surveyors_[k]->slopes()) return surveyors_[k]->why_no_gradients();
  }
  for (const auto* list : {&parts_.objectives, &parts_.design_margins, &parts_.workspace_margins})
    for (const auto& q : *list)
      if (const Unsupported reason = q.quantity->no_derivatives()) return reason;
  return {};
}

std::vector<double> DesignProblem::parameters(std::span<const double> design) const {
  std::vector<double> all = parts_.parameters;
  for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
  return all;
}

Survey<double> DesignProblem::workspace(std::span<const double> parameters, std::size_t k) const {
  Survey<double> survey;
  evaluate_once(*surveyors_[k], parameters, survey);
  return survey;
}

template <class S>
void DesignProblem::survey(std::span<const S> parameters, bool all, Scratch& scratch, Surveys<S>& surveys) const {
  surveys.resize(surveyors_.size());
  for (std::size_t k = 0; k < surveyors_.size(); ++k)
    if (used_[k] || (all && k == 0))
      evaluate_workspace(*surveyors_[k], parameters, scratch, surveys[k]);
    else
      surveys[k].clear();
}

Status DesignProblem::compute(std::span<const double> parameters, Scratch& scratch, EvaluationSlot result) const {
  Surveys<double>& surveys = scratch.get<Buffers>().surveys;
  DesignView<double> view{*parts_.mechanism, parameters, nullptr, scratch};
  bool satisfied = true, usable = true, violated = false;
  const auto put = [&](double& target, double value) {
    target = value;
    usable = usable && std::isfinite(value);
    return value;
  };
  std::size_t margin = 0;
  for (const auto& q : parts_.design_margins) {
    const double value = put(result.margins[margin++], margin_of(q, q.quantity->value(view)));
    satisfied = value >= 0 && satisfied;
    violated = violated || (std::isfinite(value) && value < 0);
  }
  // A violated constraint rejects the design even if another margin is undefined, e.g. that of an unreachable motion.
  if (violated && result.detail == Detail::enough) return Status::rejected;
  if (!usable && !(violated && result.detail == Detail::complete)) return Status::failed;
  const bool rejected = !satisfied;

  if (result.detail == Detail::derivatives) {
    differentiate(parameters, parts_.varies, result.slopes, scratch);
    for (const double derivative : result.slopes) usable = usable && std::isfinite(derivative);
  } else {
    survey(parameters, result.detail == Detail::complete, scratch, surveys);
  }
  const auto value = [&](const NamedQuantity& q) {
    view.survey = &surveys[q.survey];
    return q.quantity->value(view);
  };
  for (const auto& q : parts_.workspace_margins)
    satisfied = put(result.margins[margin++], margin_of(q, value(q))) >= 0 && satisfied;
  for (std::size_t i = 0; i < parts_.objectives.size(); ++i) put(result.objectives[i], value(parts_.objectives[i]));
  for (std::size_t i = 0; i < parts_.reports.size(); ++i) result.reports[i] = value(parts_.reports[i]);
  if (!usable) return Status::failed;
  return rejected ? Status::rejected : satisfied ? Status::feasible : Status::infeasible;
}

void DesignProblem::differentiate(std::span<const double> parameters, std::span<const std::size_t> by,
                                  std::span<double> derivatives, Scratch& scratch) const {
  constexpr std::size_t kDirections = 4;  // of Dual4
  Buffers& buffers = scratch.get<Buffers>();
  std::vector<Dual4>& all = buffers.duals;
  Surveys<double>& surveys = buffers.surveys;
  Surveys<Dual4>& dual_surveys = buffers.dual_surveys;
  const std::size_t width = 1 + by.size();
  for (std::size_t first = 0; first < std::max<std::size_t>(by.size(), 1); first += kDirections) {
    const std::size_t count = std::min(kDirections, by.size() - first);
    all.assign(parameters.begin(), parameters.end());
    for (std::size_t k = 0; k < count; ++k) all[by[first + k]].v[static_cast<int>(k)] = 1;
    survey(std::span<const Dual4>(all), false, scratch, dual_surveys);
    surveys.resize(dual_surveys.size());
    for (std::size_t k = 0; first == 0 && k < surveys.size(); ++k) copy_values(dual_surveys[k], surveys[k]);
    DesignView<Dual4> view{*parts_.mechanism, all, nullptr, scratch};
    std::size_t row = 0;
    const auto put = [&](const Dual4& value) {
      const auto target = derivatives.subspan(width * row++, width);
      target[0] = value.a;
      for (std::size_t k = 0; k < count; ++k) target[1 + first + k] = value.v[static_cast<int>(k)];
    };
    const auto smooth = [&](const NamedQuantity& q) {
      view.survey = &dual_surveys[q.survey];
      return q.quantity->smooth(view);
    };
    const auto put_margins = [&](const std::vector<NamedQuantity>& list) {
      for (const auto& q : list) put(margin_of(q, smooth(q)));
    };
    row = parts_.objectives.size();
    put_margins(parts_.design_margins);
    put_margins(parts_.workspace_margins);
    row = 0;
    for (const auto& q : parts_.objectives) put(smooth(q));
  }
}

std::vector<double> DesignProblem::slopes(std::span<const double> parameters, std::span<const std::size_t> by) const {
  std::vector<double> derivatives((objectives_.size() + margins_.size()) * (1 + by.size()));
  Scratch scratch;
  differentiate(parameters, by, derivatives, scratch);
  return derivatives;
}

void DesignProblem::evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const {
  std::vector<double>& all = scratch.get<Buffers>().parameters;
  try {
    all.assign(parts_.parameters.begin(), parts_.parameters.end());
    for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
    result.status = compute(all, scratch, result);
  } catch (const DesignError&) {
    result.status = Status::failed;
  }
}

/// The reason given by the first quantity without a finite value that gives one, in the order of evaluation: margins,
/// then objectives.
std::string DesignProblem::failure_reason(const DesignReport& report) const {
  Scratch scratch;
  const DesignView<double> view{*parts_.mechanism, report.parameters, &report.survey, scratch};
  std::vector<double> computed = report.margins;
  computed.insert(computed.end(), report.objectives.begin(), report.objectives.end());
  auto value = computed.begin();
  for (const auto* list : {&parts_.design_margins, &parts_.workspace_margins, &parts_.objectives})
    for (const auto& q : *list) {
      if (std::isfinite(*value++)) continue;
      if (const std::string reason = q.quantity->why_undefined(view); !reason.empty()) return q.name + ": " + reason;
    }
  return "an objective or a margin is not a finite number";
}

DesignReport DesignProblem::empty_report(std::span<const double> parameters) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  DesignReport report;
  report.parameters.assign(parameters.begin(), parameters.end());
  report.objectives.assign(objectives_.size(), nan);
  report.margins.assign(margins_.size(), nan);
  report.reports.assign(reports_.size(), nan);
  return report;
}

std::string DesignProblem::failure_reason(std::span<const double> design, Detail detail) const {
  DesignReport report = empty_report(parameters(design));
  std::vector<double> derivatives(shape(detail).slopes());
  try {
    Scratch scratch;
    const Status status =
        compute(report.parameters, scratch,
                {report.objectives, report.margins, report.reports, report.status, detail, derivatives});
    if (status != Status::failed) return "the failure cannot be reproduced by this program";
    if (auto& surveys = scratch.get<Buffers>().surveys; !surveys.empty()) report.survey = surveys.front();
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (std::ranges::all_of(report.margins, is_finite) && std::ranges::all_of(report.objectives, is_finite))
      return "a derivative is not a finite number";
    return failure_reason(report);
  } catch (const DesignError& error) {
    return message_of(error);
  }
}

DesignReport DesignProblem::report(std::span<const double> parameters) const {
  DesignReport report = empty_report(parameters);
  try {
    Scratch scratch;
    report.status = compute(parameters, scratch,
                            {report.objectives, report.margins, report.reports, report.status, Detail::complete});
    if (auto& surveys = scratch.get<Buffers>().surveys; !surveys.empty()) report.survey = std::move(surveys.front());
    if (report.status == Status::failed) {
      report.reason = failure_reason(report);
      const auto design_margins = std::span(report.margins).first(parts_.design_margins.size());
      if (std::ranges::any_of(design_margins, [](double margin) { return std::isfinite(margin) && margin < 0; }))
        report.status = Status::rejected;
    }
  } catch (const DesignError& error) {
    report.status = Status::failed;
    report.reason = message_of(error);
  }
  return report;
}

}  // namespace pkm
