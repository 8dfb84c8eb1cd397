// Comparison of the derivatives of a problem's quantities with finite differences of the same quadrature rule.
//
// Central differences D(h) = (f(h) - f(-h)) / 2h with Richardson extrapolation, (4 D(h/2) - D(h)) / 3: the error is
// O(h^4) for smooth f, plus the rounding error of f divided by h. Starting from h = 1e-3, the step is divided by ten
// until two consecutive results agree. If no two agree, f has a kink within the smallest steps (the sampled
// conditioning has one where two singular values of a sample coincide), or the adaptive rule changes its number of
// nodes there. Such cases are excluded; they are counted and must be rare.
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

/// Derivatives at 0 of several functions of one variable; nullopt if no two steps agree.
/// @param f      t -> values of all functions
/// @param scale  magnitude of each derivative; results agree if they differ by at most 2e-8 times it
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

/// Compares designs one by one and counts the comparisons and exclusions of each quantity.
class DerivativeComparison {
 public:
  /// @param tolerance  accepted error, relative to the largest term of the sum over the parameters
  explicit DerivativeComparison(double tolerance = 1e-7) : tolerance_(tolerance) {}

  /// Compares the directional derivatives of all quantities of a problem at one design. The direction changes all
  /// parameters, so that an error in any partial derivative shows in the sum.
  /// @param direction  relative change of each parameter
  void compare(const DesignProblem& problem, const std::vector<double>& design, const std::vector<double>& direction) {
    const std::size_t n = design.size(), width = 1 + n;
    const std::vector<double> derivatives = problem.derivatives(design, problem.parts().varies);
    const std::size_t quantities = derivatives.size() / width;
    std::vector<double> exact(quantities, 0.0), scale(quantities, 0.0);
    for (std::size_t q = 0; q < quantities; ++q)
      for (std::size_t i = 0; i < n; ++i) {
        const double term = derivatives[q * width + 1 + i] * design[i] * direction[i];
        exact[q] += term;
        scale[q] = std::fmax(scale[q], std::fabs(term));
      }
    // Minimum scale, absolute and relative to the value: differences of a constant quantity are rounding errors.
    constexpr double kMinScale = 1e-9, kMinRelativeScale = 1e-3;
    for (std::size_t q = 0; q < quantities; ++q)
      scale[q] = std::max({scale[q], kMinRelativeScale * std::fabs(derivatives[q * width]), kMinScale});
    const auto values = [&](double t) {
      std::vector<double> moved = design;
      for (std::size_t i = 0; i < n; ++i) moved[i] += t * design[i] * direction[i];
      return problem.derivatives(moved, {});
    };
    const auto found = differences(values, scale);
    for (std::size_t q = 0; q < quantities; ++q) {
      Count& count = counts_[name(problem, q)];
      ++count.compared;
      if (!found[q])
        ++count.excluded;
      else
        EXPECT_NEAR(exact[q], *found[q], tolerance_ * scale[q]) << name(problem, q);
    }
  }

  /// Expects for each quantity at least `compared` comparisons, of which at most the share `excluded` (rounded up) was
  /// excluded.
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

  double tolerance_;
  std::map<std::string, Count> counts_;
};

}  // namespace pkm::test
