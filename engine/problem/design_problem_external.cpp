// External functions of a design problem: their calls, and what their values change in an evaluation.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/stop.hpp"
#include "engine/problem/design_problem_buffers.hpp"

namespace pkm {
namespace {

/// Placeholder for the value of an external function that is not called.
const ExternalValue kNotCalled{.failure = "the function is not called here", .is_computed = true};

}  // namespace

std::string DesignProblem::store(std::span<const ExternalValue> values, const EvaluationSlot& result) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const bool has_failed_before = result.status == Status::failed;
  std::string failure;
  const auto value_of_call = [&](const std::string& call) {
    const ExternalValue& found = values[static_cast<std::size_t>(std::ranges::find(calls_, call) - calls_.begin())];
    if (found.failure.empty() && std::isfinite(found.value)) return found.value;
    const std::string reason = found.failure.empty() ? "the value is not a finite number" : found.failure;
    if (!has_failed_before) parts_.functions->note_failure(call, reason);
    if (failure.empty()) failure = call + ": " + reason;
    return nan;
  };
  bool satisfied = true;
  std::size_t margin = parts_.design_margins.size();
  for (const auto& q : parts_.workspace_margins) {
    if (const std::string* const call = q.quantity->external_call()) {
      result.margins[margin] = margin_of(q, value_of_call(*call));
      satisfied = satisfied && result.margins[margin] >= 0;
    }
    ++margin;
  }
  for (std::size_t i = 0; i < parts_.objectives.size(); ++i)
    if (const std::string* const call = parts_.objectives[i].quantity->external_call())
      result.objectives[i] = value_of_call(*call);
  if (!failure.empty())
    result.status = Status::failed;
  else if (!satisfied && result.status == Status::feasible)
    result.status = Status::infeasible;
  // Outputs are set last: a failed call of an output does not change the status of the design.
  for (std::size_t i = 0; i < parts_.reports.size(); ++i)
    if (const std::string* const call = parts_.reports[i].quantity->external_call())
      result.reports[i] = value_of_call(*call);
  return result.status == Status::failed ? failure : "";
}

void DesignProblem::complete(std::span<EvaluatedDesign> rows) const {
  // The external functions of a rejected design are called only if all values are requested; those of a failed design
  // are never called.
  const auto is_wanted = [](const EvaluatedDesign& row) {
    return row.slot.status == Status::feasible || row.slot.status == Status::infeasible ||
           (row.slot.status == Status::rejected && row.slot.detail != Detail::enough);
  };
  std::vector<std::size_t> wanted;
  std::vector<double> parameters;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!is_wanted(rows[k])) {
      if (rows[k].slot.status == Status::failed) store(std::vector(calls_.size(), kNotCalled), rows[k].slot);
      rows[k].is_complete = true;
      continue;
    }
    wanted.push_back(k);
    const std::vector<double> all = this->parameters(rows[k].design);
    parameters.insert(parameters.end(), all.begin(), all.end());
  }
  const std::size_t count = wanted.size();
  std::vector<std::vector<ExternalValue>> values(calls_.size(), std::vector<ExternalValue>(count));
  const auto store_computed = [&] {
    std::vector<ExternalValue> of_design(calls_.size());
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t c = 0; c < calls_.size(); ++c) of_design[c] = values[c][k];
      EvaluatedDesign& row = rows[wanted[k]];
      row.is_complete = std::ranges::all_of(of_design, &ExternalValue::is_computed);
      for (const ExternalValue& each : of_design) row.seconds += each.seconds;
      if (row.is_complete) store(of_design, row.slot);
    }
  };
  try {
    for (std::size_t c = 0; count > 0 && c < calls_.size(); ++c) evaluate_external(calls_[c], parameters, values[c]);
  } catch (const Stopped&) {
    store_computed();
    throw;
  }
  store_computed();
}

std::string DesignProblem::complete(std::span<const double> parameters, const EvaluationSlot& result) const {
  if (calls_.empty()) return {};
  std::vector<ExternalValue> values(calls_.size(), kNotCalled);
  const bool is_wanted = result.status != Status::failed;
  for (std::size_t c = 0; is_wanted && c < calls_.size(); ++c)
    evaluate_external(calls_[c], parameters, {&values[c], 1});
  const std::string failure = store(values, result);
  return is_wanted ? failure : "";
}

void DesignProblem::evaluate_external(const std::string& call, std::span<const double> parameters,
                                      std::span<ExternalValue> values) const {
  if (FunctionCaller* const caller = parts_.functions->caller.get()) return caller->evaluate(call, parameters, values);
  std::ranges::fill(values, kNotCalled);
}

}  // namespace pkm
