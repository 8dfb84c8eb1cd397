#include "engine/optimisers/solvers/trials.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {

Trials::Trials(const TrialRoom& room, const TrialLimits& limits, std::span<const double> start)
    : room_(room), table_(room.table), limits_(limits), start_design_(start.begin(), start.end()) {
  const DesignSpace& space = room_.problem.space();
  for (std::size_t i = 0; i < space.dimension(); ++i) start_unit_.push_back(space.to_unit(i, start[i]));
  evaluate(start_unit_);
  if (goal_->has_slack()) start_unit_.push_back(unit_.back());
  if (point_.usable) start_size_ = std::fabs(point_.objective);
}

const Trials::Point* Trials::at(const double* u) noexcept {
  try {
    std::vector<double> inside(u, u + dimension());
    for (double& x : inside) {
      if (!std::isfinite(x) && stop_ == Stop::none) stop_ = Stop::not_a_point;
      x = std::clamp(x, 0.0, 1.0);
    }
    const std::size_t variables = room_.problem.space().dimension();
    if (!std::equal(unit_.begin(), unit_.begin() + static_cast<std::ptrdiff_t>(variables), inside.begin())) {
      if (stop_ != Stop::none) return nullptr;
      evaluate({inside.data(), variables});
    }
    if (stop_ == Stop::not_a_point) return nullptr;
    if (inside != unit_) {  // only the slack differs
      unit_ = inside;
      read(row_, unit_.back());
    }
    return stop_ == Stop::exception ? nullptr : &point_;
  } catch (...) {
    exception_ = std::current_exception();
    stop_ = Stop::exception;
    return nullptr;
  }
}

std::vector<double> Trials::recall(std::size_t row) {
  const DesignSpace& space = room_.problem.space();
  const auto design = std::as_const(table_).design(row);
  for (std::size_t i = 0; i < design.size(); ++i) unit_[i] = row == 0 ? start_unit_[i] : space.to_unit(i, design[i]);
  set(row);
  return unit_;
}

void Trials::evaluate(std::span<const double> u) {
  const DesignSpace& space = room_.problem.space();
  const std::size_t row = table_.extend(1);
  const auto design = table_.design(row);
  for (std::size_t i = 0; i < design.size(); ++i)  // the start keeps its own bits
    design[i] = u[i] == start_unit_[i] ? start_design_[i] : space.from_unit(i, u[i]);
  room_.evaluator.evaluate(room_.problem, table_, row);
  if (!goal_) goal_.emplace(room_.how, room_.problem, table_, row);
  unit_.assign(u.begin(), u.end());
  if (goal_->has_slack()) unit_.push_back(0);
  set(row);

  if (const Ranked candidate = goal_->rank(row); best_.row < 0 || candidate < best_) best_ = candidate;
  const bool goes_on = room_.evaluated();
  const auto made = static_cast<std::int64_t>(table_.size());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  if (made >= limits_.evaluations)
    stop_ = Stop::evaluations;
  else if (limits_.seconds && seconds >= *limits_.seconds)
    stop_ = Stop::time;
  if (!goes_on) stop_ = Stop::interrupted;
}

void Trials::set(std::size_t row) {
  row_ = row;
  const double slack = goal_->slack(row);
  if (goal_->has_slack()) unit_.back() = slack;
  read(row, slack);
}

void Trials::read(std::size_t row, double slack) {
  goal_->read(row, slack, point_);
  const double worst = worst_.value_or(0);
  if (point_.usable)
    worst_ = worst_ ? std::max(worst, point_.objective) : point_.objective;
  else  // far worse than anything seen, and flat
    point_.objective = worst + 10 * (1 + std::fabs(worst));
}

double Trials::optimality(std::size_t row) const {
  Point here;
  goal_->read(row, goal_->slack(row), here);
  if (here.gradient.empty() || !here.usable) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> u;
  const DesignSpace& space = room_.problem.space();
  const auto design = std::as_const(table_).design(row);
  for (std::size_t i = 0; i < design.size(); ++i) u.push_back(space.to_unit(i, design[i]));
  if (goal_->has_slack()) u.push_back(goal_->slack(row));
  const double left = first_order(u, here.gradient, here.margins, here.margin_gradient).optimality;
  const double size = goal_->has_slack() ? 1 : std::max(std::fabs(here.objective), start_size_);
  return size > 0 ? left / size : left;
}

}  // namespace pkm
