#include "engine/optimisers/trials.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pkm {

Trials::Trials(const StageInput& input, EvaluationTable& table, const TrialLimits& limits,
               std::span<const double> start, std::int64_t& generation, Ranked& best,
               const std::vector<StartOutcome>& finished)
    : input_(input),
      table_(table),
      limits_(limits),
      first_row_(table.size()),
      generation_(generation),
      stage_best_(best),
      finished_(finished),
      start_design_(start.begin(), start.end()) {
  const DesignSpace& space = input.problem.space();
  for (std::size_t i = 0; i < space.dimension(); ++i) start_unit_.push_back(space.to_unit(i, start[i]));
  point_.margins.resize(margins());
  if (table.shape().detail == Detail::derivatives) {
    point_.gradient.resize(dimension());
    point_.margin_gradient.resize(margins() * dimension());
  }
  evaluate(start_unit_);
}

const Trials::Point* Trials::at(const double* u) noexcept {
  try {
    std::vector<double> inside(u, u + dimension());
    for (double& x : inside) {
      if (!std::isfinite(x) && stop_ == Stop::none) stop_ = Stop::not_a_point;
      x = std::clamp(x, 0.0, 1.0);
    }
    if (inside != unit_) {
      if (stop_ != Stop::none) return nullptr;
      evaluate(inside);
    }
    return stop_ == Stop::exception ? nullptr : &point_;
  } catch (...) {
    exception_ = std::current_exception();
    stop_ = Stop::exception;
    return nullptr;
  }
}

std::vector<double> Trials::recall(std::size_t row) {
  const DesignSpace& space = input_.problem.space();
  const auto design = std::as_const(table_).design(row);
  for (std::size_t i = 0; i < design.size(); ++i)
    unit_[i] = row == first_row_ ? start_unit_[i] : space.to_unit(i, design[i]);
  read(row);
  return unit_;
}

void Trials::evaluate(std::span<const double> u) {
  const DesignSpace& space = input_.problem.space();
  const std::size_t row = table_.extend(1);
  const auto design = table_.design(row);
  for (std::size_t i = 0; i < design.size(); ++i)  // the start keeps its own bits
    design[i] = u[i] == start_unit_[i] ? start_design_[i] : space.from_unit(i, u[i]);
  input_.evaluator.evaluate(input_.problem, table_, row);
  unit_.assign(u.begin(), u.end());
  read(row);

  const Ranked candidate = ranked(input_.problem, table_, row);
  if (best_.row < 0 || candidate < best_) best_ = candidate;
  if (stage_best_.row < 0 || candidate < stage_best_) stage_best_ = candidate;
  population_ = {best_.row};
  const bool goes_on =
      input_.monitor.generation({generation_++, row, &table_, &population_, stage_best_.row, &finished_});
  const auto made = static_cast<std::int64_t>(table_.size() - first_row_);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (made >= limits_.evaluations)
    stop_ = Stop::evaluations;
  else if (limits_.seconds && seconds >= *limits_.seconds)
    stop_ = Stop::time;
  if (!goes_on) stop_ = Stop::interrupted;
}

void Trials::read(std::size_t row) {
  const bool slopes = table_.shape().detail == Detail::derivatives;
  const Problem& problem = input_.problem;
  const std::size_t n = dimension(), width = 1 + n;
  const auto slope = table_.slope_row(row);
  const double sign = problem.objectives()[0].direction == Direction::maximise ? -1 : 1;
  const double value = slopes ? slope[0] : table_.objective_row(row)[0];
  point_.usable = table_.status[row] != Status::failed && std::isfinite(value);
  if (row == first_row_) {
    scale_ = sign / (point_.usable && value != 0 ? std::fabs(value) : 1.0);
    worst_ = point_.usable ? value * scale_ : 0;
  }
  if (!point_.usable) {  // far worse than anything seen, and flat
    point_.objective = worst_ + 10 * (1 + std::fabs(worst_));
    std::fill(point_.gradient.begin(), point_.gradient.end(), 0.0);
    std::fill(point_.margin_gradient.begin(), point_.margin_gradient.end(), 0.0);
    for (double& margin : point_.margins) margin = -1;
    return;
  }
  point_.objective = value * scale_;
  worst_ = std::max(worst_, point_.objective);
  const auto range = [&](std::size_t i) { return problem.space()[i].upper - problem.space()[i].lower; };
  for (std::size_t i = 0; slopes && i < n; ++i) point_.gradient[i] = slope[1 + i] * range(i) * scale_;
  for (std::size_t m = 0; m < margins(); ++m) {
    point_.margins[m] = slopes ? slope[(1 + m) * width] : table_.margin_row(row)[m];
    for (std::size_t i = 0; slopes && i < n; ++i)
      point_.margin_gradient[m * n + i] = slope[(1 + m) * width + 1 + i] * range(i);
  }
}

}  // namespace pkm
