#include "engine/runner/remaining_time.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "engine/core/stop.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/runner/exact_values.hpp"
#include "engine/runner/final_record.hpp"

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// An evaluation table of sample designs that are not yet evaluated: the centre of the design space and, if there is
/// one, the baseline.
EvaluationTable sample_designs(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape(detail));
  table.extend(study.baseline ? 2 : 1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) {
    table.design(0)[i] = problem.space().from_unit(i, 0.5);
    if (study.baseline) table.design(1)[i] = (*study.baseline)[problem.parts().varies[i]];
  }
  return table;
}

/// Time of one evaluation [s], as the maximum over the sample designs: the evaluation of a design that fails takes
/// almost no time.
double evaluation_seconds(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table = sample_designs(study, detail);
  Scratch scratch;
  double longest = 0;
  const StopScope limit(RunCost::kTimeLimit);
  try {
    for (std::size_t row = 0; row < table.size(); ++row) {
      double seconds = 1e30;
      // The minimum of at most three measured times of the evaluation is used; the first evaluation also warms up.
      for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {
        const auto begin = Clock::now();
        evaluate_design(problem, table.design(row), scratch, table.slot(row));
        seconds = std::min(seconds, since(begin));
      }
      longest = std::max(longest, seconds);
    }
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return RunCost::kTimeLimit;
  }
  return longest;
}

/// Time to compute the exact values of all final designs [s]; std::nullopt if it is too long to be measured.
std::optional<double> exact_seconds(const Study& study) {
  constexpr double kMaxSeconds = 0.3;  // time limit of each measurement [s]
  const double designs = study.baseline ? 2 : 1;
  const EvaluationTable table = sample_designs(study, Detail::complete);
  const auto begin = Clock::now();
  const StopScope limit(kMaxSeconds);
  try {
    const ExactValues exact(study.problem->parts());
    std::vector<std::string> notes;
    const double setup = since(begin);
    exact.evaluate("", study.problem->parameters(table.design(table.size() - 1)), notes);
    return std::min(study.exact_seconds, setup + designs * (since(begin) - setup));
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    return {};
  }
}

}  // namespace

RunCost measure_run_cost(const Study& study) {
  const auto has = [&](Detail detail) {
    return std::ranges::any_of(study.stages, [&](const Stage& s) { return s.optimiser->detail() == detail; });
  };
  RunCost cost;
  if (has(Detail::derivatives)) cost.with_derivatives = evaluation_seconds(study, Detail::derivatives);
  const double complete = evaluation_seconds(study, Detail::complete);
  if (has(Detail::enough) || has(Detail::complete) || cost.with_derivatives == 0) cost.plain = complete;
  const double designs = 1.0 + (study.baseline ? 1 : 0) + (study.round ? 1 : 0);
  cost.final_steps = (designs + 1) * complete;  // the voxel map costs about as much as one evaluation
  if (has_exact_step(study)) {
    if (const std::optional<double> exact = exact_seconds(study))
      cost.final_steps += *exact;
    else
      cost.exact_limit = study.exact_seconds;
  }
  return cost;
}

namespace {

/// Maximum time of a stage [s], computed from its evaluation limit.
double stage_seconds(const Stage& stage, const Study& study, const RunCost& cost, int threads) {
  const double each = stage.optimiser->detail() == Detail::derivatives ? cost.with_derivatives : cost.plain;
  const auto at_once = std::min<std::int64_t>(threads, stage.optimiser->at_once());
  return each * static_cast<double>(stage.optimiser->evaluation_limit(*study.problem)) / static_cast<double>(at_once);
}

}  // namespace

double max_stage_seconds(const Study& study, const RunCost& cost, int threads) {
  return std::accumulate(study.stages.begin(), study.stages.end(), 0.0, [&](double sum, const Stage& stage) {
    return sum + stage_seconds(stage, study, cost, threads);
  });
}

RemainingTime::RemainingTime(const Study& study, const RunCost& cost, int threads)
    : final_steps_(cost.final_steps + cost.exact_limit) {
  for (const Stage& stage : study.stages) {
    stages_.push_back(stage_seconds(stage, study, cost, threads));
    is_solver_.push_back(stage.entry->capabilities(stage.options).starts);
  }
}

std::optional<double> RemainingTime::update(std::size_t stage, std::int64_t left, std::int64_t made, double seconds) {
  constexpr double kStartUp = 1;  // time [s] before which the rate of evaluations is not representative
  // Minimum time [s] over which the rate is averaged: only recent evaluations count, because their cost changes.
  constexpr double kMinWindow = 2;
  // Factor from the estimated time of a solver stage to its upper bound: evaluations may become slower.
  constexpr double kSafetyFactor = 1.5;
  if (stage != stage_) {
    stage_ = stage;
    begin_ = last_;
    samples_.clear();
    bound_.reset();
  }
  // While recorded evaluations are replayed, no evaluation is made: postpone the beginning of the measurement.
  if (made == last_.made) begin_.seconds = made == begin_.made ? seconds : begin_.seconds;
  last_ = {seconds, made};
  const double window = std::max(kMinWindow, (seconds - begin_.seconds) / 3);
  if (samples_.empty() || seconds - samples_.back().seconds >= 0.01 * window) samples_.push_back(last_);
  while (samples_.size() > 2 && seconds - samples_[1].seconds >= window) samples_.pop_front();
  const Sample from = seconds - begin_.seconds <= window ? begin_ : samples_.front();
  if (seconds < kStartUp || made == from.made || !(seconds > from.seconds)) return {};
  const double each = (seconds - from.seconds) / static_cast<double>(made - from.made);
  double later = final_steps_;
  for (std::size_t i = stage + 1; i < stages_.size(); ++i) later += stages_[i];
  const double now = each * static_cast<double>(left);
  if (!is_solver_[stage]) return now + later;
  bound_ = std::min(bound_.value_or(std::numeric_limits<double>::infinity()), kSafetyFactor * now + later);
  return bound_;
}

}  // namespace pkm
