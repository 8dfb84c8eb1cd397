#include "engine/runner/run_cost.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "engine/core/stop.hpp"
#include "engine/optimisers/sampling.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/runner/certificates.hpp"
#include "engine/runner/exact_values.hpp"
#include "engine/runner/final_record.hpp"

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Designs that are evaluated to measure the time, not evaluated yet: the centre of the design space, the baseline if
/// there is one, and Sobol points, which are evaluated only if the others fail.
struct SampleDesigns {
  EvaluationTable table;
  std::size_t preferred;  ///< number of rows before the Sobol points

  SampleDesigns(const Study& study, Detail detail)
      : table(study.problem->shape(detail)), preferred(study.baseline ? 2 : 1) {
    constexpr std::size_t kSobolPoints = 8;
    const DesignSpace& space = study.problem->space();
    const std::size_t dimension = space.dimension();
    table.extend(preferred + (dimension > 0 ? kSobolPoints : 0));
    const std::vector<double> points = unit_cube_samples(Start::sobol, kSobolPoints, dimension, study.seed);
    for (std::size_t i = 0; i < dimension; ++i) {
      table.design(0)[i] = space.from_unit(i, 0.5);
      if (study.baseline) table.design(1)[i] = (*study.baseline)[study.problem->parts().varies[i]];
      for (std::size_t row = preferred; row < table.size(); ++row)
        table.design(row)[i] = space.from_unit(i, points[(row - preferred) * dimension + i]);
    }
  }
};

/// A design within the bounds that hardly differs from `design`, and is a different one for each index, so that no
/// results are taken from caches.
std::vector<double> neighbour(const DesignSpace& space, std::span<const double> design, int index) {
  constexpr double kChange = 1e-9;  // relative to the range of each variable
  std::vector<double> changed(design.begin(), design.end());
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const double inward = changed[i] > (space[i].lower + space[i].upper) / 2 ? -1 : 1;
    if (space[i].step == 0) changed[i] += inward * index * kChange * (space[i].upper - space[i].lower);
  }
  return changed;
}

struct EvaluationCost {
  double seconds = 0;                              ///< longest time of an evaluation
  std::optional<std::vector<double>> design = {};  ///< a design whose evaluation does not fail, feasible if possible
};

/// Time of one evaluation, as the maximum over the sample designs: the evaluation of a design that fails takes almost
/// no time.
EvaluationCost evaluation_cost(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  SampleDesigns designs(study, detail);
  EvaluationTable& table = designs.table;
  Scratch scratch;
  EvaluationCost cost;
  Status best = Status::failed;
  const StopScope limit(RunCost::kTimeLimit);
  try {
    for (std::size_t row = 0; row < table.size() && (row < designs.preferred || !cost.design); ++row) {
      double seconds = 1e30;
      // The minimum of at most three measured times of the evaluation is used; the first evaluation also warms up.
      for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {
        const int index = 3 * static_cast<int>(detail) + i;
        const std::vector<double> design = neighbour(problem.space(), table.design(row), index);
        const auto begin = Clock::now();
        evaluate_design(problem, design, scratch, table.slot(row));
        seconds = std::min(seconds, since(begin));
      }
      cost.seconds = std::max(cost.seconds, seconds);
      if (const Status status = table.status[row]; status < best) {
        best = status;
        cost.design = problem.parameters(table.design(row));
      }
    }
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    cost.seconds = RunCost::kTimeLimit;
  }
  return cost;
}

/// Time to compute the exact values of all final designs [s]; std::nullopt if it is too long to be measured.
/// @param parameters  of a design that can be evaluated
std::optional<double> exact_seconds(const Study& study, const std::vector<double>& parameters) {
  constexpr double kMaxSeconds = 0.3;  // time limit of each measurement [s]
  const double designs = study.baseline ? 2 : 1;
  const auto begin = Clock::now();
  const StopScope limit(kMaxSeconds);
  try {
    const ExactValues exact(study.problem->parts());
    std::vector<std::string> notes;
    const double setup = since(begin);
    exact.evaluate("", parameters, notes);
    return std::min(study.exact_seconds, setup + designs * (since(begin) - setup));
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return {};
  }
}

/// Time of the sensitivities with respect to all parameters, which follow a stage with derivatives, relative to an
/// evaluation with derivatives with respect to the variables.
double relative_sensitivity_cost(const DesignProblem& problem) {
  const auto passes = [](std::size_t parameters) {
    return std::max(1.0, std::ceil(static_cast<double>(parameters) / Dual4::kDerivatives));
  };
  return passes(problem.parts().parameters.size()) / passes(problem.space().dimension());
}

}  // namespace

double RunCost::all_final_steps() const {
  double sum = final_steps;
  for (const LongStep& step : long_steps) sum += step.seconds;
  return sum;
}

RunCost measure_run_cost(const Study& study) {
  const auto stages_with = [&](Detail detail) {
    return std::ranges::count_if(study.stages, [&](const Stage& s) { return s.optimiser->detail() == detail; });
  };
  const DesignProblem& problem = *study.problem;
  RunCost cost;
  if (const auto stages = stages_with(Detail::derivatives); stages > 0) {
    cost.with_derivatives = evaluation_cost(study, Detail::derivatives).seconds;
    if (problem.objectives().size() == 1)
      cost.final_steps += static_cast<double>(stages) * relative_sensitivity_cost(problem) * cost.with_derivatives;
  }
  const EvaluationCost complete = evaluation_cost(study, Detail::complete);
  if (stages_with(Detail::enough) + stages_with(Detail::complete) > 0 || cost.with_derivatives == 0)
    cost.plain = complete.seconds;
  const double designs = 1.0 + (study.baseline ? 1 : 0) + (study.round ? 1 : 0);
  cost.final_steps += (designs + 1) * complete.seconds;  // the voxel map costs about as much as one evaluation
  if (!complete.design) return cost;
  const std::vector<double>& parameters = *complete.design;
  constexpr double kShort = 1;  // time [s] up to which certificates are not listed
  const CertificateCost one = certificate_cost(problem.of(parameters).parts(), parameters);
  const double certificates = designs * (one.volume + one.motions) + one.solids;
  if (certificates > kShort)
    cost.long_steps.push_back({"certificates of the final designs", certificates});
  else
    cost.final_steps += certificates;
  if (has_exact_step(study)) {
    if (const std::optional<double> exact = exact_seconds(study, parameters))
      cost.final_steps += *exact;
    else
      cost.long_steps.push_back({"exact values of the final designs", study.exact_seconds});
  }
  return cost;
}

}  // namespace pkm
