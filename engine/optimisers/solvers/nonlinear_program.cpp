#include "engine/optimisers/solvers/nonlinear_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/optimisers/solvers/optimality.hpp"

namespace pkm {

NonlinearProgram::NonlinearProgram(const StartContext& context, const StartLimits& limits,
                                   std::span<const double> start)
    : context_(context), table_(context.table), limits_(limits), start_design_(start.begin(), start.end()) {
  const DesignSpace& space = context_.problem.space();
  for (std::size_t i = 0; i < space.dimension(); ++i) start_unit_.push_back(space.to_unit(i, start[i]));
  evaluate_new_row(start_unit_);
  if (scalarised_->has_epigraph()) start_unit_.push_back(current_unit_.back());
  if (point_.usable) start_scale_ = std::fabs(point_.objective);
}

const NonlinearProgram::Point* NonlinearProgram::evaluate(const double* u) noexcept {
  try {
    std::vector<double> clamped(u, u + dimension());
    for (double& x : clamped) {
      if (!std::isfinite(x) && stop_ == Stop::none) stop_ = Stop::not_finite;
      x = std::clamp(x, 0.0, 1.0);
    }
    const std::size_t variables = context_.problem.space().dimension();
    if (!std::equal(current_unit_.begin(), current_unit_.begin() + static_cast<std::ptrdiff_t>(variables),
                    clamped.begin())) {
      if (stop_ != Stop::none) return nullptr;
      evaluate_new_row({clamped.data(), variables});
    }
    if (stop_ == Stop::not_finite) return nullptr;
    // If the point still differs from the current one, only its epigraph variable t does, so that no evaluation is
    // needed.
    if (clamped != current_unit_) {
      current_unit_ = clamped;
      update_point(row_, current_unit_.back());
    }
    return stop_ == Stop::exception ? nullptr : &point_;
  } catch (...) {
    exception_ = std::current_exception();
    stop_ = Stop::exception;
    return nullptr;
  }
}

std::vector<double> NonlinearProgram::recall(std::size_t row) {
  const DesignSpace& space = context_.problem.space();
  const auto design = std::as_const(table_).design(row);
  for (std::size_t i = 0; i < design.size(); ++i)
    current_unit_[i] = row == 0 ? start_unit_[i] : space.to_unit(i, design[i]);
  select_row(row);
  return current_unit_;
}

void NonlinearProgram::evaluate_new_row(std::span<const double> u) {
  const DesignSpace& space = context_.problem.space();
  const std::size_t row = table_.extend(1);
  const auto design = table_.design(row);
  // Use the coordinates of the start design exactly, without the rounding errors of a conversion to unit coordinates
  // and back.
  for (std::size_t i = 0; i < design.size(); ++i)
    design[i] = u[i] == start_unit_[i] ? start_design_[i] : space.from_unit(i, u[i]);
  context_.evaluator.evaluate(context_.problem, table_, row);
  if (!scalarised_) scalarised_.emplace(context_.scalarisation, context_.problem, table_, row);
  current_unit_.assign(u.begin(), u.end());
  if (scalarised_->has_epigraph()) current_unit_.push_back(0);
  select_row(row);

  if (const RankKey candidate = scalarised_->rank(row); best_.row < 0 || candidate < best_) best_ = candidate;
  const bool continues = context_.evaluated();
  const auto count = static_cast<std::int64_t>(table_.size());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time_).count();
  if (count >= limits_.evaluations)
    stop_ = Stop::evaluations;
  else if (limits_.seconds && seconds >= *limits_.seconds)
    stop_ = Stop::time;
  if (!continues) stop_ = Stop::interrupted;
}

void NonlinearProgram::select_row(std::size_t row) {
  row_ = row;
  const double epigraph = scalarised_->epigraph(row);
  if (scalarised_->has_epigraph()) current_unit_.back() = epigraph;
  update_point(row, epigraph);
}

void NonlinearProgram::update_point(std::size_t row, double epigraph) {
  scalarised_->read(row, epigraph, point_);
  const double max_objective = max_objective_.value_or(0);
  if (point_.usable)
    max_objective_ = max_objective_ ? std::max(max_objective, point_.objective) : point_.objective;
  else  // penalty value of a failed evaluation: far worse than all objectives so far
    point_.objective = max_objective + 10 * (1 + std::fabs(max_objective));
}

double NonlinearProgram::optimality(std::size_t row) const {
  Point point;
  scalarised_->read(row, scalarised_->epigraph(row), point);
  if (point.gradient.empty() || !point.usable) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> u;
  const DesignSpace& space = context_.problem.space();
  const auto design = std::as_const(table_).design(row);
  for (std::size_t i = 0; i < design.size(); ++i) u.push_back(space.to_unit(i, design[i]));
  if (scalarised_->has_epigraph()) u.push_back(scalarised_->epigraph(row));
  const double residual = evaluate_kkt(u, point.gradient, point.margins, point.margin_jacobian).optimality;
  const double scale = scalarised_->has_epigraph() ? 1 : std::max(std::fabs(point.objective), start_scale_);
  return scale > 0 ? residual / scale : residual;
}

}  // namespace pkm
