#include "engine/study/time_left.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "engine/core/stop.hpp"
#include "engine/study/exact_values.hpp"
#include "engine/study/final_record.hpp"

namespace pkm {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// The middle of the design space, and the baseline.
EvaluationTable samples_of(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table(problem.shape(detail));
  table.extend(study.baseline ? 2 : 1);
  for (std::size_t i = 0; i < problem.space().dimension(); ++i) {
    table.design(0)[i] = problem.space().from_unit(i, 0.5);
    if (study.baseline) table.design(1)[i] = (*study.baseline)[problem.parts().varies[i]];
  }
  return table;
}

/// What an evaluation takes [s]: the longest of the samples, for a design that cannot be evaluated takes no time.
double seconds_of_one(const Study& study, Detail detail) {
  const DesignProblem& problem = *study.problem;
  EvaluationTable table = samples_of(study, detail);
  Scratch scratch;
  double longest = 0;
  const StopScope limit(RunCost::kLongest);
  try {
    for (std::size_t row = 0; row < table.size(); ++row) {
      double seconds = 1e30;
      for (int i = 0; i < 3 && (i == 0 || seconds < 1); ++i) {  // the first one also warms up
        const auto begin = Clock::now();
        problem.evaluate(table.design(row), scratch, table.slot(row));
        seconds = std::min(seconds, since(begin));
      }
      longest = std::max(longest, seconds);
    }
  } catch (const Stopped&) {
    if (limit.is_requested_outside()) throw;
    return RunCost::kLongest;
  }
  return longest;
}

/// Exact values of the final designs [s]; none where they take long.
std::optional<double> seconds_of_exact(const Study& study) {
  constexpr double kTried = 0.3;  // s
  const double designs = study.baseline ? 2 : 1;
  const EvaluationTable table = samples_of(study, Detail::complete);
  const auto begin = Clock::now();
  const StopScope limit(kTried);
  try {
    const ExactValues exact(study.problem->parts());
    std::vector<std::string> notes;
    const double prepared = since(begin);
    exact.of("", study.problem->parameters(table.design(table.size() - 1)), notes);
    return std::min(study.exact_seconds, prepared + designs * (since(begin) - prepared));
  } catch (const Stopped&) {
    if (limit.is_requested_outside()) throw;
    return {};
  }
}

}  // namespace

RunCost cost_of_run(const Study& study) {
  const auto has = [&](Detail detail) {
    return std::ranges::any_of(study.stages, [&](const Stage& s) { return s.optimiser->detail() == detail; });
  };
  RunCost cost;
  if (has(Detail::derivatives)) cost.with_derivatives = seconds_of_one(study, Detail::derivatives);
  const double complete = seconds_of_one(study, Detail::complete);
  if (has(Detail::enough) || has(Detail::complete) || cost.with_derivatives == 0) cost.plain = complete;
  const double designs = 1.0 + (study.baseline ? 1 : 0) + (study.round ? 1 : 0);
  cost.final_steps = (designs + 1) * complete;  // the map is about another one
  if (has_exact_step(study)) {
    if (const std::optional<double> exact = seconds_of_exact(study))
      cost.final_steps += *exact;
    else
      cost.exact_limit = study.exact_seconds;
  }
  return cost;
}

namespace {

double seconds_of_stage(const Stage& stage, const Study& study, const RunCost& cost, int threads) {
  const double each = stage.optimiser->detail() == Detail::derivatives ? cost.with_derivatives : cost.plain;
  const auto at_once = std::min<std::int64_t>(threads, stage.optimiser->at_once());
  return each * static_cast<double>(stage.optimiser->evaluation_limit(*study.problem)) / static_cast<double>(at_once);
}

}  // namespace

double seconds_of_stages(const Study& study, const RunCost& cost, int threads) {
  return std::accumulate(study.stages.begin(), study.stages.end(), 0.0, [&](double sum, const Stage& stage) {
    return sum + seconds_of_stage(stage, study, cost, threads);
  });
}

TimeLeft::TimeLeft(const Study& study, const RunCost& cost, int threads)
    : final_steps_(cost.final_steps + cost.exact_limit) {
  for (const Stage& stage : study.stages) {
    stages_.push_back(seconds_of_stage(stage, study, cost, threads));
    is_bound_.push_back(stage.entry->capabilities(stage.options).starts);
  }
}

std::optional<double> TimeLeft::after(std::size_t stage, std::int64_t left, std::int64_t made, double seconds) {
  constexpr double kSettled = 1;   // s: the rate of the first moments is that of starting up
  constexpr double kWindow = 2;    // s, at least: designs cost more or less as the search moves on
  constexpr double kMargin = 1.5;  // of bounds: evaluations of a solver may get slower
  if (stage != stage_) {
    stage_ = stage;
    begin_ = last_;
    samples_.clear();
    bound_.reset();
  }
  if (made == last_.made) begin_.seconds = made == begin_.made ? seconds : begin_.seconds;  // replayed
  last_ = {seconds, made};
  const double window = std::max(kWindow, (seconds - begin_.seconds) / 3);
  if (samples_.empty() || seconds - samples_.back().seconds >= 0.01 * window) samples_.push_back(last_);
  while (samples_.size() > 2 && seconds - samples_[1].seconds >= window) samples_.pop_front();
  const Sample from = seconds - begin_.seconds <= window ? begin_ : samples_.front();
  if (seconds < kSettled || made == from.made || !(seconds > from.seconds)) return {};
  const double each = (seconds - from.seconds) / static_cast<double>(made - from.made);
  double later = final_steps_;
  for (std::size_t i = stage + 1; i < stages_.size(); ++i) later += stages_[i];
  const double now = each * static_cast<double>(left);
  if (!is_bound_[stage]) return now + later;
  bound_ = std::min(bound_.value_or(std::numeric_limits<double>::infinity()), kMargin * now + later);
  return bound_;
}

}  // namespace pkm
