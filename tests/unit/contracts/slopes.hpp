// Slopes of a problem's quantities compared with differences of the same rule.
//
// The rule that excludes kinks: the central difference D(h) = (f(h) - f(-h)) / 2h, extrapolated as (4 D(h/2) - D(h)) /
// 3, errs by h^4 where f is smooth and by the rounding of f over h. From h = 1e-3 on, steps shrink by tens until two of
// them agree; f is then smooth as far as either of them sees. Where no two agree, a kink lies within the least steps
// (sampled conditioning has one wherever two singular values of a sample change places), or an adaptive rule changes
// its number of nodes there. Such cases are counted and must be few.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/problem/design_problem.hpp"

namespace pkm::test {

/// Derivatives at 0 of functions of one variable; none where no two steps agree.
/// @param f      t -> values of all functions
/// @param scale  of each function's derivative: steps agree within 2e-8 of it
template <class F>
std::vector<std::optional<double>> differences(const F& f, const std::vector<double>& scale) {
  constexpr double kAgree = 2e-8;
  std::vector<std::optional<double>> found(scale.size());
  std::vector<double> before;
  std::size_t missing = scale.size();
  for (const double h : {1e-3, 1e-4, 1e-5, 1e-6}) {
    const std::vector<double> low = f(-h), high = f(h), near_low = f(-h / 2), near_high = f(h / 2);
    std::vector<double> now(scale.size());
    for (std::size_t i = 0; i < scale.size(); ++i) {
      const double wide = (high[i] - low[i]) / (2 * h), narrow = (near_high[i] - near_low[i]) / h;
      now[i] = (4 * narrow - wide) / 3;
      if (before.empty() || found[i] || !(std::fabs(now[i] - before[i]) <= kAgree * scale[i])) continue;
      found[i] = now[i];
      --missing;
    }
    if (missing == 0) break;
    before = now;
  }
  return found;
}

/// Compares designs one after the other and keeps count.
class SlopeComparison {
 public:
  /// @param exact  error allowed, relative to the largest term of the sum over the parameters
  explicit SlopeComparison(double exact = 1e-7) : exact_(exact) {}

  /// All quantities of a problem at one design, by all parameters, along one direction of relative changes: a wrong
  /// slope by any parameter shows in the sum.
  void compare(const DesignProblem& problem, const std::vector<double>& design, const std::vector<double>& direction) {
    const std::size_t n = design.size(), width = 1 + n;
    const std::vector<double> slopes = problem.slopes(design, problem.parts().varies);
    const std::size_t quantities = slopes.size() / width;
    std::vector<double> exact(quantities, 0.0), scale(quantities, 0.0);
    for (std::size_t q = 0; q < quantities; ++q)
      for (std::size_t i = 0; i < n; ++i) {
        const double term = slopes[q * width + 1 + i] * design[i] * direction[i];
        exact[q] += term;
        scale[q] = std::fmax(scale[q], std::fabs(term));
      }
    constexpr double kNothing = 1e-9;  // the deviation of a constant is rounding
    constexpr double kNoSlope = 1e-3;  // of the value: where a quantity does not move, its differences are rounding
    for (std::size_t q = 0; q < quantities; ++q)
      scale[q] = std::max({scale[q], kNoSlope * std::fabs(slopes[q * width]), kNothing});
    const auto values = [&](double t) {
      std::vector<double> moved = design;
      for (std::size_t i = 0; i < n; ++i) moved[i] += t * design[i] * direction[i];
      return problem.slopes(moved, {});
    };
    const auto found = differences(values, scale);
    for (std::size_t q = 0; q < quantities; ++q) {
      Count& count = counts_[name(problem, q)];
      ++count.compared;
      if (!found[q])
        ++count.excluded;
      else
        EXPECT_NEAR(exact[q], *found[q], exact_ * scale[q]) << name(problem, q);
    }
  }

  /// At least so many designs were compared, and of those at most this share, rounded up, was excluded.
  void expect(int compared, double excluded) const {
    for (const auto& [name, count] : counts_) {
      EXPECT_GE(count.compared, compared) << name;
      EXPECT_LE(count.excluded, std::ceil(excluded * count.compared)) << name;
    }
    EXPECT_FALSE(counts_.empty());
  }

 private:
  struct Count {
    int compared = 0, excluded = 0;
  };
  static std::string name(const DesignProblem& problem, std::size_t q) {
    const std::size_t objectives = problem.objectives().size();
    return q < objectives ? problem.objectives()[q].name : problem.margins()[q - objectives].name;
  }

  double exact_;
  std::map<std::string, Count> counts_;
};

}  // namespace pkm::test
