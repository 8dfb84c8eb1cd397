// Evaluation of the machines that are built to a design, and statistics over them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/team.hpp"
#include "engine/problem/design_problem_buffers.hpp"

namespace pkm {

void DesignProblem::evaluate_machine(std::span<const double> parameters, std::optional<std::span<const std::size_t>> by,
                                     Scratch& scratch, std::span<double> objectives, std::span<double> margins,
                                     std::span<double> derivatives) const {
  if (parts_.mechanism->refuse(parameters)) return;
  WorkspaceResults<double>& workspaces = scratch.get<Buffers>().workspaces;
  DesignView<double> view{*parts_.mechanism, parameters, nullptr, scratch};
  bool violated = false;
  std::size_t margin = 0;
  for (const auto& q : parts_.design_margins) {
    margins[margin] = margin_of(q, q.quantity->value(view));
    violated = violated || !(margins[margin++] >= 0);
  }
  if (violated && parts_.objectives.empty()) return;
  if (by)
    differentiate(parameters, *by, derivatives, scratch);
  else
    analyse(parameters, false, scratch, workspaces);
  const auto value = [&](const NamedQuantity& q) {
    view.workspace = &workspaces[q.analysis];
    return q.quantity->value(view);
  };
  for (std::size_t i = 0; i < objectives.size(); ++i) objectives[i] = value(parts_.objectives[i]);
  for (const auto& q : parts_.workspace_margins) {
    // The quantity of a robust constraint is, in a study with a yield, also an objective of BuiltMachines::problem. Its
    // value has then been computed above.
    const auto same = std::ranges::find(parts_.objectives, q.quantity, &NamedQuantity::quantity);
    const bool is_known = same != parts_.objectives.end();
    margins[margin++] =
        margin_of(q, is_known ? objectives[static_cast<std::size_t>(same - parts_.objectives.begin())] : value(q));
  }
}

void DesignProblem::evaluate_machines(std::span<const double> parameters,
                                      std::optional<std::span<const std::size_t>> by, Scratch& scratch) const {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  // Number of machines evaluated between two checks for a stop request, if a machine takes microseconds; the evaluation
  // of a machine that takes longer checks itself.
  constexpr std::size_t kMachinesPerCheck = 64;
  const ToleranceModel& tolerances = parts_.built->tolerances;
  const std::shared_ptr<const DesignProblem>& problem = parts_.built->problem;
  Buffers& buffers = scratch.get<Buffers>();
  MachineValues& values = buffers.machines;
  values.machines = tolerances.samples;
  const EvaluationShape shape{by ? by->size() : 0, problem->objectives().size(), problem->margins().size(), 0,
                              by ? Detail::derivatives : Detail::enough};
  values.objectives.assign(values.machines * shape.objectives, nan);
  values.margins.assign(values.machines * shape.margins, nan);
  values.derivatives.assign(values.machines * shape.derivatives(), nan);
  if (buffers.workers.size() < workers()) buffers.workers.resize(workers());
  parallel_for(values.machines, [&](std::size_t begin, std::size_t end, std::size_t worker) {
    Scratch& own = buffers.workers[worker];
    for (std::size_t k = begin; k < end; ++k) {
      if (k % kMachinesPerCheck == 0) check_stop();
      const auto part = [k](std::vector<double>& all, std::size_t width) {
        return std::span(all).subspan(k * width, width);
      };
      std::vector<double>& machine = own.get<Buffers>().machine;
      tolerances.sample(k, parameters, machine);
      try {
        problem->evaluate_machine(machine, by, own, part(values.objectives, shape.objectives),
                                  part(values.margins, shape.margins), part(values.derivatives, shape.derivatives()));
      } catch (const DesignError&) {  // the values of this machine remain NaN
      }
    }
  });
  if (!values.margins.empty()) buffers.yield = yield_of(values);
}

double DesignProblem::statistic(const SampledValue& sampled, Scratch& scratch) const {
  if (sampled.is_yield()) return yield_statistic(sampled, scratch.get<Buffers>().yield);
  const MachineValues& values = scratch.get<Buffers>().machines;
  const std::size_t width = values.objectives.size() / values.machines;
  std::vector<double> each(values.machines);
  for (std::size_t k = 0; k < each.size(); ++k) each[k] = values.objectives[k * width + sampled.row];
  double sum = 0;
  for (const auto& [machine, weight] : sample_weights(sampled, each)) sum += weight * each[machine];
  return sum;
}

Dual4 DesignProblem::smooth_statistic(const SampledValue& sampled, std::size_t first, std::size_t count,
                                      std::size_t directions, Scratch& scratch) const {
  const MachineValues& values = scratch.get<Buffers>().machines;
  const std::size_t width = values.derivatives.size() / values.machines;
  const auto row = [&](std::size_t machine) {
    return &values.derivatives[machine * width + sampled.row * (1 + directions)];
  };
  std::vector<double> each(values.machines);
  for (std::size_t k = 0; k < each.size(); ++k) each[k] = *row(k);
  Dual4 sum(0.0);
  for (const auto& [machine, weight] : sample_weights(sampled, each)) {
    const double* const own = row(machine);
    sum.a += weight * own[0];
    for (std::size_t k = 0; k < count; ++k) sum.v[static_cast<int>(k)] += weight * own[1 + first + k];
  }
  return sum;
}

std::string DesignProblem::why_machine_fails(std::span<const double> parameters) const {
  const auto& [tolerances, problem] = *parts_.built;
  std::vector<double> machine;
  for (std::size_t k = 0; k < tolerances.samples; ++k) {
    tolerances.sample(k, parameters, machine);
    Unsupported reason = problem->parts().mechanism->refuse(machine);
    if (!reason)
      if (const std::string failure = problem->report(machine).reason; !failure.empty()) reason = failure;
    if (reason)
      return "built machine " + std::to_string(k + 1) + " of " + std::to_string(tolerances.samples) + ": " + *reason;
  }
  return {};
}

}  // namespace pkm
