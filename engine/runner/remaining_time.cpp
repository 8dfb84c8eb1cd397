#include "engine/runner/remaining_time.hpp"

#include <algorithm>
#include <numeric>

namespace pkm {
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
    : final_steps_(cost.all_final_steps()) {
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
