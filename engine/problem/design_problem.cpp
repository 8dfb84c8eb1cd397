// Evaluation of a design: workspace analyses, quantities, derivatives.
#include "engine/problem/design_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <sstream>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/problem/design_problem_buffers.hpp"
#include "engine/problem/tied_parameters.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

/// For each workspace analysis, whether a quantity uses it: first the analysis of the workspace, then those of the
/// regions.
std::vector<bool> used_analyses(const ProblemParts& parts) {
  std::vector<bool> used(1 + parts.regions.size());
  for (const auto* list : {&parts.objectives, &parts.workspace_margins, &parts.reports})
    for (const auto& q : *list)
      if (q.uses_analysis_of_design()) used[q.analysis] = true;
  return used;
}

/// Throws DesignError if not even the order of magnitude of a volume is known: a search must not choose such a design.
void refuse_unknown(double volume, double relative_error) {
  if (!(volume > 0) || relative_error < 1) return;
  std::ostringstream text;
  text << "the volume of the workspace is unknown: " << volume << " with an estimated relative error of "
       << relative_error << "; use voxels, or see 'pkmopt certify' for bounds";
  throw DesignError(text.str());
}

}  // namespace

struct DesignProblem::OtherRows {
  std::mutex mutex;
  std::map<std::vector<std::size_t>, std::shared_ptr<const DesignProblem>> problems;
};

/// Scratch memory for each problem that differs from this one only in the rows chosen from the catalogues.
struct ScratchOfRows {
  std::map<const DesignProblem*, Scratch> of;
};

DesignProblem::DesignProblem(ProblemParts parts)
    : parts_(std::move(parts)), used_(used_analyses(parts_)), others_(std::make_shared<OtherRows>()) {
  workspace_evaluators_.push_back(prepare_workspace(*parts_.mechanism, parts_.plan, parts_.request));
  if (const ColumnOptions* const columns = parts_.plan.columns(); columns && columns->certified)
    parts_.mechanism->bounds()->require_bounds(parts_.plan);
  for (const Region& region : parts_.regions)
    workspace_evaluators_.push_back(prepare_workspace(*parts_.mechanism, region.plan, region.request));
  for (const auto& q : parts_.objectives) objectives_.push_back({q.name, q.unit, q.meaning, q.direction});
  for (const auto* list : {&parts_.design_margins, &parts_.workspace_margins})
    for (const auto& q : *list) margins_.push_back({q.name, q.unit, q.meaning});
  for (const auto& q : parts_.reports) reports_.push_back({q.name, q.unit, q.meaning});
  for (const auto* list : {&parts_.objectives, &parts_.workspace_margins, &parts_.reports})
    for (const auto& q : *list)
      if (const std::string* const call = q.quantity->external_call(); call && !contains(calls_, *call))
        calls_.push_back(*call);
}

const DesignProblem& DesignProblem::of(std::span<const double> parameters) const {
  if (!parts_.with_rows) return *this;
  std::vector<std::size_t> rows;
  for (const Choice& choice : parts_.choices) rows.push_back(choice.row(parameters[choice.parameter]));
  if (rows == parts_.rows) return *this;
  const std::lock_guard lock(others_->mutex);
  std::shared_ptr<const DesignProblem>& found = others_->problems[rows];
  try {
    if (!found) found = parts_.with_rows(rows);
  } catch (const ConfigError& error) {
    throw DesignError(error.what());
  }
  return *found;
}

Unsupported DesignProblem::why_no_derivatives() const {
  if (!parts_.choices.empty())
    return "the variable " + parts_.choices[0].variable + " is a choice from a catalogue, without derivatives";
  for (std::size_t k = 0; k < used_.size(); ++k) {
    if (!used_[k]) continue;
    if (!workspace_evaluators_[k]->gradients()) return workspace_evaluators_[k]->why_no_derivatives();
  }
  bool is_robust = false;
  for (const auto* list : {&parts_.objectives, &parts_.design_margins, &parts_.workspace_margins})
    for (const auto& q : *list) {
      if (const Unsupported reason = q.quantity->why_no_derivatives()) return reason;
      is_robust = is_robust || q.sampled;
    }
  if (is_robust) return parts_.built->problem->why_no_derivatives();
  return {};
}

std::vector<double> DesignProblem::parameters(std::span<const double> design) const {
  std::vector<double> all = parts_.parameters;
  for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
  apply_ties(parts_, all);
  if (const DesignProblem& other = of(all); &other != this) return other.parameters(design);
  return all;
}

WorkspaceResult<double> DesignProblem::workspace(std::span<const double> parameters, std::size_t k) const {
  if (const DesignProblem& other = of(parameters); &other != this) return other.workspace(parameters, k);
  WorkspaceResult<double> result;
  evaluate_once(*workspace_evaluators_[k], parameters, result);
  return result;
}

template <class S>
void DesignProblem::analyse(std::span<const S> parameters, bool all, Scratch& scratch,
                            WorkspaceResults<S>& results) const {
  results.resize(workspace_evaluators_.size());
  for (std::size_t k = 0; k < workspace_evaluators_.size(); ++k)
    if (used_[k] || (all && k == 0)) {
      evaluate_workspace(*workspace_evaluators_[k], parameters, scratch, results[k]);
      refuse_unknown(value_of(results[k].volume), results[k].error);
    } else {
      results[k].clear();
    }
}

Status DesignProblem::compute(std::span<const double> parameters, Scratch& scratch, EvaluationSlot result,
                              bool is_report) const {
  WorkspaceResults<double>& workspaces = scratch.get<Buffers>().workspaces;
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
  // A violated constraint rejects the design even if another margin is undefined, for example because
  // a motion cannot be reached.
  if (violated && result.detail == Detail::enough) return Status::rejected;
  if (!usable && !(violated && result.detail == Detail::complete)) return Status::failed;
  const bool rejected = !satisfied;

  if (result.detail == Detail::derivatives) {
    differentiate(parameters, parts_.varies, result.derivatives, scratch);
    for (const double derivative : result.derivatives) usable = usable && std::isfinite(derivative);
  } else {
    analyse(parameters, is_report, scratch, workspaces);
    if (parts_.built) evaluate_machines(parameters, {}, scratch);
  }
  const auto value = [&](const NamedQuantity& q) {
    if (q.quantity->external_call()) return 0.0;  // placeholder until complete() computes the value
    if (q.sampled) return statistic(*q.sampled, scratch);
    view.workspace = &workspaces[q.analysis];
    return q.quantity->value(view);
  };
  for (const auto& q : parts_.workspace_margins) {
    const double computed = q.quantity->external_call() ? 0 : margin_of(q, value(q));
    satisfied = put(result.margins[margin++], computed) >= 0 && satisfied;
  }
  for (std::size_t i = 0; i < parts_.objectives.size(); ++i) put(result.objectives[i], value(parts_.objectives[i]));
  for (std::size_t i = 0; i < parts_.reports.size(); ++i) result.reports[i] = value(parts_.reports[i]);
  if (!usable) return Status::failed;
  return rejected ? Status::rejected : satisfied ? Status::feasible : Status::infeasible;
}

void DesignProblem::differentiate(std::span<const double> parameters, std::span<const std::size_t> by,
                                  std::span<double> derivatives, Scratch& scratch) const {
  constexpr std::size_t kBlock = Dual4::kDerivatives;
  Buffers& buffers = scratch.get<Buffers>();
  std::vector<Dual4>& all = buffers.duals;
  WorkspaceResults<double>& workspaces = buffers.workspaces;
  WorkspaceResults<Dual4>& dual_workspaces = buffers.dual_workspaces;
  const std::size_t width = 1 + by.size();
  if (parts_.built && !parts_.built->problem->objectives().empty())
    evaluate_machines(parameters, by, scratch);
  else if (parts_.built)
    evaluate_machines(parameters, {}, scratch);
  for (std::size_t first = 0; first < std::max<std::size_t>(by.size(), 1); first += kBlock) {
    const std::size_t count = std::min(kBlock, by.size() - first);
    all.assign(parameters.begin(), parameters.end());
    for (std::size_t k = 0; k < count; ++k) {
      all[by[first + k]].v[static_cast<int>(k)] = 1;
      for (const auto& [own, common] : parts_.copies)
        if (common == by[first + k]) all[own].v[static_cast<int>(k)] = 1;
    }
    analyse(std::span<const Dual4>(all), false, scratch, dual_workspaces);
    workspaces.resize(dual_workspaces.size());
    for (std::size_t k = 0; first == 0 && k < workspaces.size(); ++k) copy_values(dual_workspaces[k], workspaces[k]);
    DesignView<Dual4> view{*parts_.mechanism, all, nullptr, scratch};
    std::size_t row = 0;
    const auto put = [&](const Dual4& value) {
      const auto target = derivatives.subspan(width * row++, width);
      target[0] = value.a;
      for (std::size_t k = 0; k < count; ++k) target[1 + first + k] = value.v[static_cast<int>(k)];
    };
    const auto smooth = [&](const NamedQuantity& q) {
      if (q.sampled) return smooth_statistic(*q.sampled, first, count, by.size(), scratch);
      view.workspace = &dual_workspaces[q.analysis];
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

std::vector<double> DesignProblem::derivatives(std::span<const double> parameters,
                                               std::span<const std::size_t> by) const {
  std::vector<double> values((objectives_.size() + margins_.size()) * (1 + by.size()));
  Scratch scratch;
  differentiate(parameters, by, values, scratch);
  return values;
}

void DesignProblem::evaluate(std::span<const double> design, Scratch& scratch, EvaluationSlot result) const {
  std::vector<double>& all = scratch.get<Buffers>().parameters;
  try {
    all.assign(parts_.parameters.begin(), parts_.parameters.end());
    for (std::size_t i = 0; i < design.size(); ++i) all[parts_.varies[i]] = design[i];
    apply_ties(parts_, all);
    if (const DesignProblem& other = of(all); &other != this)
      return other.evaluate(design, scratch.get<ScratchOfRows>().of[&other], result);
    result.status = compute(all, scratch, result);
  } catch (const DesignError&) {
    result.status = Status::failed;
  }
}

/// Returns the reason stated by the first quantity whose value is not finite and that states a reason. The order is
/// that of evaluation: margins, then objectives.
std::string DesignProblem::failure_reason(const DesignReport& report) const {
  Scratch scratch;
  const DesignView<double> view{*parts_.mechanism, report.parameters, &report.workspace, scratch};
  std::vector<double> computed = report.margins;
  computed.insert(computed.end(), report.objectives.begin(), report.objectives.end());
  auto value = computed.begin();
  std::string first_undefined;
  for (const auto* list : {&parts_.design_margins, &parts_.workspace_margins, &parts_.objectives})
    for (const auto& q : *list) {
      if (std::isfinite(*value++)) continue;
      if (q.sampled)
        if (const std::string reason = why_machine_fails(report.parameters); !reason.empty())
          return q.name + ": " + reason;
      if (const std::string reason = q.quantity->why_undefined(view); !reason.empty()) return q.name + ": " + reason;
      if (first_undefined.empty()) first_undefined = q.name;
    }
  return first_undefined + " is not a finite number";
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
  const std::vector<double> all = parameters(design);
  if (const DesignProblem& other = of(all); &other != this) return other.failure_reason(design, detail);
  DesignReport report = empty_report(all);
  std::vector<double> derivatives(shape(detail).derivatives());
  try {
    Scratch scratch;
    const EvaluationSlot slot{report.objectives, report.margins, report.reports, report.status, detail, derivatives};
    const Status status = compute(report.parameters, scratch, slot);
    if (status != Status::failed) {
      report.status = status;
      const std::string failure = complete(report.parameters, slot);
      return failure.empty() ? "the failure cannot be reproduced by this program" : failure;
    }
    if (auto& workspaces = scratch.get<Buffers>().workspaces; !workspaces.empty())
      report.workspace = workspaces.front();
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (std::ranges::all_of(report.margins, is_finite) && std::ranges::all_of(report.objectives, is_finite))
      return "a derivative is not a finite number";
    return failure_reason(report);
  } catch (const DesignError& error) {
    return message_of(error);
  }
}

DesignReport DesignProblem::report(std::span<const double> parameters) const {
  if (const DesignProblem& other = of(parameters); &other != this) return other.report(parameters);
  DesignReport report = empty_report(parameters);
  try {
    Scratch scratch;
    const EvaluationSlot slot{report.objectives, report.margins, report.reports, report.status, Detail::complete};
    report.status = compute(parameters, scratch, slot, true);
    if (const Buffers& buffers = scratch.get<Buffers>(); !buffers.machines.margins.empty())
      report.yield = buffers.yield;
    if (auto& workspaces = scratch.get<Buffers>().workspaces; !workspaces.empty())
      report.workspace = std::move(workspaces.front());
    report.reason = complete(parameters, slot);
    if (report.status == Status::failed) {
      if (report.reason.empty()) report.reason = failure_reason(report);
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
