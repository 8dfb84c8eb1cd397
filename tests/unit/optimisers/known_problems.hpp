// Small problems with known optima, for tests of optimisers and evaluators.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/math/dual.hpp"
#include "engine/problem/problem.hpp"

namespace pkm::test {

/// A problem defined by one generic function, which sets objectives and constraint values, or sets the constraint
/// values and returns the only objective. It has derivatives if the function accepts Dual4 and there are at most four
/// variables.
class FunctionProblem final : public Problem {
 public:
  template <class S>
  using Function = std::function<void(std::span<const S> design, std::span<S> objectives, std::span<S> margins)>;

  template <class F>
  FunctionProblem(std::vector<Variable> variables, const std::vector<Direction>& directions, std::size_t margins,
                  F function)
      : space_(std::move(variables)), function_(function) {
    if constexpr (std::is_invocable_v<F, std::span<const Dual4>, std::span<Dual4>, std::span<Dual4>>)
      if (space_.dimension() <= 4) derivatives_ = function;
    for (std::size_t i = 0; i < directions.size(); ++i)
      objectives_.push_back({"f" + std::to_string(i), "1", "", directions[i]});
    for (std::size_t i = 0; i < margins; ++i) margins_.push_back({"g" + std::to_string(i), "1", ""});
  }
  template <class F>
  FunctionProblem(std::vector<Variable> variables, std::size_t margins, F function,
                  Direction direction = Direction::minimise)
      : FunctionProblem(
            std::move(variables), {direction}, margins,
            [function](auto x, auto f, auto g) -> std::void_t<decltype(function(x, g))> { f[0] = function(x, g); }) {}

  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<OutputInfo>& reports() const override { return reports_; }

  void evaluate(std::span<const double> design, Scratch&, EvaluationSlot result) const override {
    function_(design, result.objectives, result.margins);
    result.status = Status::feasible;
    for (const double margin : result.margins)
      if (margin < 0) result.status = Status::infeasible;
    if (result.detail != Detail::derivatives) return;
    std::vector<Dual4> x, values(objectives_.size() + margins_.size());
    for (std::size_t i = 0; i < design.size(); ++i) x.push_back(Dual4::variable(design[i], static_cast<int>(i)));
    const std::span<Dual4> all(values);
    derivatives_(x, all.first(objectives_.size()), all.subspan(objectives_.size()));
    std::size_t at = 0;
    for (const Dual4& value : values) {
      result.derivatives[at++] = value.a;
      for (std::size_t i = 0; i < design.size(); ++i) result.derivatives[at++] = value.v[static_cast<int>(i)];
    }
  }
  Unsupported why_no_derivatives() const override { return derivatives_ ? Unsupported() : "the function has none"; }

  /// The same problem with its only objective duplicated, without derivatives: the Pareto front is the optimum.
  FunctionProblem with_duplicate_objective() const {
    FunctionProblem problem = *this;
    problem.objectives_.push_back(objectives_[0]);
    problem.objectives_.back().name = "again";
    problem.derivatives_ = nullptr;
    problem.function_ = [once = function_](std::span<const double> x, std::span<double> f, std::span<double> g) {
      once(x, f.first(1), g);
      f[1] = f[0];
    };
    return problem;
  }

 private:
  DesignSpace space_;
  Function<double> function_;
  Function<Dual4> derivatives_;
  std::vector<ObjectiveInfo> objectives_;
  std::vector<MarginInfo> margins_;
  std::vector<OutputInfo> reports_;
};

inline std::vector<Variable> box(std::size_t dimension, double lower, double upper, double step = 0) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < dimension; ++i) variables.push_back({"x" + std::to_string(i), "1", lower, upper, step});
  return variables;
}

/// Minimum 0 at x_i = 0.3.
inline FunctionProblem sphere(std::size_t dimension, double step = 0) {
  return {box(dimension, -5, 7, step), 0, [](auto x, auto) {
            auto sum = x[0] * 0.0;
            for (const auto& v : x) sum += (v - 0.3) * (v - 0.3);
            return sum;
          }};
}

/// Maximum 1 at the corner (0, 1, 1, 1): non-linear with products, like a design problem whose optimum is at the
/// bounds.
inline FunctionProblem corner_optimum() {
  return {box(4, 0, 1), 0,
          [](auto x, auto) {
            return (1.0 - 0.8 * x[0]) * (0.4 + 0.6 * x[1]) * (0.5 + 0.7 * x[2] - 0.2 * x[2] * x[2]) *
                   (0.6 + 0.4 * sqrt(x[3]));
          },
          Direction::maximise};
}

/// Welded beam (Deb 2000): four variables, optimum 1.724852 with four active constraints.
inline FunctionProblem welded_beam() {
  return {{{"h", "1", 0.1, 2, 0}, {"l", "1", 0.1, 10, 0}, {"t", "1", 0.1, 10, 0}, {"b", "1", 0.1, 2, 0}},
          5,
          [](auto x, auto g) {
            const double load = 6000, arm = 14, young = 30e6, shear = 12e6;
            const auto h = x[0], l = x[1], t = x[2], b = x[3];
            const auto moment = load * (arm + l / 2.0), r2 = l * l / 4.0 + (h + t) * (h + t) / 4.0, r = sqrt(r2);
            const auto polar = 2 * std::sqrt(2.0) * h * l * (l * l / 12.0 + (h + t) * (h + t) / 4.0);
            const auto t1 = load / (std::sqrt(2.0) * h * l), t2 = moment * r / polar;
            const auto tau = sqrt(t1 * t1 + t1 * t2 * l / r + t2 * t2);
            const auto buckling = 4.013 * young * t * b * b * b / 6.0 / (arm * arm) *
                                  (1.0 - t / (2 * arm) * std::sqrt(young / (4 * shear)));
            g[0] = 1.0 - tau / 13600.0;
            g[1] = 1.0 - 6 * load * arm / (b * t * t) / 30000.0;
            g[2] = b - h;
            g[3] = 0.25 - 4 * load * arm * arm * arm / (young * t * t * t * b);
            g[4] = buckling / load - 1.0;
            return 1.10471 * h * h * l + 0.04811 * t * b * (14.0 + l);
          }};
}

/// No design is feasible; the minimum violation is 0.5 at x = (1, 1).
inline FunctionProblem infeasible_everywhere() {
  return {box(2, 0, 4), 1, [](auto x, auto g) {
            g[0] = -0.5 - (x[0] - 1.0) * (x[0] - 1.0) - (x[1] - 1.0) * (x[1] - 1.0);
            return x[0];
          }};
}

/// NaN on one half of the box, towards which the objective decreases; minimum 1 at (0, 0.5) on the other half.
inline FunctionProblem partly_undefined() {
  return {box(2, -1, 1), 0, [](auto x, auto) {
            const auto hole = value_of(x[0]) < 0 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
            return 1.0 + x[0] + (x[1] - 0.5) * (x[1] - 0.5) + hole;
          }};
}

}  // namespace pkm::test
