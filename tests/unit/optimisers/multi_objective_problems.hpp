// Test problems with two and three objectives whose Pareto fronts are known.
//
// ZDT: Zitzler, Deb and Thiele 2000. DTLZ2: Deb, Thiele, Laumanns and Zitzler 2002. BNH (Binh and Korn 1997), SRN
// (Srinivas and Deb 1994), TNK (Tanaka et al. 1995) and OSY (Osyczka and Kundu 1995) in the form of Deb's book (2001).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "tests/unit/optimisers/known_problems.hpp"

namespace pkm::test {

/// A problem whose objectives are all minimised, with its true Pareto front.
struct FrontProblem {
  std::string name;
  FunctionProblem problem;
  std::vector<double> front;  ///< a few hundred points, row by row

  std::size_t objectives() const { return problem.objectives().size(); }
};

/// Minimum and maximum of one objective on the front.
inline std::array<double, 2> extent(const FrontProblem& known, std::size_t objective) {
  std::array<double, 2> result = {known.front[objective], known.front[objective]};
  for (std::size_t at = objective; at < known.front.size(); at += known.objectives()) {
    result[0] = std::fmin(result[0], known.front[at]);
    result[1] = std::fmax(result[1], known.front[at]);
  }
  return result;
}

/// Reference point of hypervolumes: the worst value of each objective on the front plus a tenth of its range.
inline std::vector<double> reference_point(const FrontProblem& known) {
  std::vector<double> reference;
  for (std::size_t k = 0; k < known.objectives(); ++k) {
    const auto [minimum, maximum] = extent(known, k);
    reference.push_back(maximum + 0.1 * (maximum - minimum));
  }
  return reference;
}

using Designs = std::vector<std::vector<double>>;

/// The problem with the front of its candidate designs: those that are feasible up to rounding and not dominated.
inline FrontProblem with_front(const std::string& name, FunctionProblem problem, const Designs& designs) {
  Scratch scratch;
  EvaluationTable table(problem.shape(Detail::complete));
  for (const auto& design : designs) {
    const std::size_t row = table.extend(1);
    problem.evaluate(design, scratch, table.slot(row));
    if (violation(table.margin_row(row)) > 1e-12) table.truncate(row);
  }
  std::vector<double> front;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto mine = table.objective_row(row);
    bool dominated = false;
    for (std::size_t other = 0; other < table.size() && !dominated; ++other) {
      const auto its = table.objective_row(other);
      dominated =
          std::equal(its.begin(), its.end(), mine.begin(), std::less_equal<>()) && !std::ranges::equal(its, mine);
    }
    if (!dominated) front.insert(front.end(), mine.begin(), mine.end());
  }
  return {name, std::move(problem), std::move(front)};
}

/// Appends design(t) at `count` equally spaced values of t from `from` to `to`.
template <class Design>
void sample(Designs& designs, int count, double from, double to, const Design& design) {
  for (int i = 0; i < count; ++i) designs.push_back(design(from + (to - from) * i / (count - 1)));
}

inline const std::vector<Direction> kMinimiseBoth(2, Direction::minimise);

/// A ZDT problem: f0 depends on the first variable, f1 = g h(f0 / g, f0), and g on the others, with its minimum at 0.
/// @param others  bounds of the variables except the first, which is in [0, 1]
/// @param until   the front consists of the designs whose first variable is in [0, until]
template <class First, class Rest, class Shape>
FrontProblem zdt(const std::string& name, std::size_t dimension, std::array<double, 2> others, double until,
                 First first, Rest g, Shape h) {
  std::vector<Variable> variables = box(1, 0, 1);
  for (const Variable& variable : box(dimension - 1, others[0], others[1])) {
    variables.push_back(variable);
    variables.back().name = "x" + std::to_string(variables.size() - 1);
  }
  Designs optimal;
  sample(optimal, 500, 0, until, [&](double t) {
    std::vector<double> design(dimension, 0.0);
    design[0] = t;
    return design;
  });
  return with_front(name,
                    {std::move(variables), kMinimiseBoth, 0,
                     [=](std::span<const double> x, std::span<double> f, std::span<double>) {
                       const double rest = g(x.subspan(1));
                       f[0] = first(x[0]);
                       f[1] = rest * h(f[0] / rest, f[0]);
                     }},
                    optimal);
}

inline double mean(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

inline std::vector<FrontProblem> zdt_problems() {
  const auto identity = [](double x) { return x; };
  const auto uneven = [](double x) {
    const double s = sincos(6 * kPi * x).sin;
    return 1 - exp(-4 * x) * (s * s * s) * (s * s * s);
  };
  const auto linear = [](std::span<const double> x) { return 1 + 9 * mean(x); };
  const auto biased = [](std::span<const double> x) { return 1 + 9 * std::sqrt(std::sqrt(mean(x))); };
  const auto multimodal = [](std::span<const double> x) {
    double g = 1;
    for (const double value : x) g += 10 + value * value - 10 * sincos(4 * kPi * value).cos;
    return g;
  };
  const auto convex = [](double u, double) { return 1 - std::sqrt(u); };
  const auto concave = [](double u, double) { return 1 - u * u; };
  const auto disconnected = [](double u, double f) { return 1 - std::sqrt(u) - u * sincos(10 * kPi * f).sin; };
  return {zdt("ZDT1", 30, {0, 1}, 1, identity, linear, convex), zdt("ZDT2", 30, {0, 1}, 1, identity, linear, concave),
          zdt("ZDT3", 30, {0, 1}, 1, identity, linear, disconnected),
          zdt("ZDT4", 10, {-5, 5}, 1, identity, multimodal, convex),
          zdt("ZDT6", 10, {0, 1}, 1.0 / 12, uneven, biased, concave)};  // f0 decreases from 1 to its minimum
}

/// Three objectives; the front is one octant of the unit sphere.
inline FrontProblem dtlz2() {
  Designs optimal;
  for (int i = 0; i < 25; ++i)
    sample(optimal, 25, 0, 1, [i](double t) {
      std::vector<double> design(12, 0.5);
      design[0] = i / 24.0;
      design[1] = t;
      return design;
    });
  return with_front("DTLZ2",
                    {box(12, 0, 1), std::vector<Direction>(3, Direction::minimise), 0,
                     [](std::span<const double> x, std::span<double> f, std::span<double>) {
                       double radius = 1;
                       for (const double value : x.subspan(2)) radius += (value - 0.5) * (value - 0.5);
                       const auto [s0, c0] = sincos(x[0] * kPi / 2);
                       const auto [s1, c1] = sincos(x[1] * kPi / 2);
                       f[0] = radius * c0 * c1;
                       f[1] = radius * c0 * s1;
                       f[2] = radius * s0;
                     }},
                    optimal);
}

inline FrontProblem bnh() {
  Designs optimal;
  sample(optimal, 300, 0, 3, [](double t) { return std::vector{t, t}; });
  sample(optimal, 200, 3, 5, [](double t) { return std::vector{t, 3.0}; });
  return with_front("BNH",
                    {{{"x0", "1", 0, 5}, {"x1", "1", 0, 3}},
                     kMinimiseBoth,
                     2,
                     [](auto x, auto f, auto g) {
                       f[0] = 4.0 * (x[0] * x[0] + x[1] * x[1]);
                       f[1] = (x[0] - 5.0) * (x[0] - 5.0) + (x[1] - 5.0) * (x[1] - 5.0);
                       g[0] = 25.0 - (x[0] - 5.0) * (x[0] - 5.0) - x[1] * x[1];
                       g[1] = (x[0] - 8.0) * (x[0] - 8.0) + (x[1] + 3.0) * (x[1] + 3.0) - 7.7;
                     }},
                    optimal);
}

/// The front lies on the second constraint, then where the gradients are opposite, then on the first constraint.
inline FrontProblem srn() {
  Designs optimal;
  sample(optimal, 100, 1.1, -2.5, [](double t) { return std::vector{t, (t + 10) / 3}; });
  sample(optimal, 300, 2.5, std::sqrt(225 - 2.5 * 2.5), [](double t) { return std::vector{-2.5, t}; });
  sample(optimal, 100, -2.5, -4.9, [](double t) { return std::vector{t, std::sqrt(225 - t * t)}; });
  return with_front("SRN",
                    {box(2, -20, 20), kMinimiseBoth, 2,
                     [](auto x, auto f, auto g) {
                       f[0] = 2.0 + (x[0] - 2.0) * (x[0] - 2.0) + (x[1] - 1.0) * (x[1] - 1.0);
                       f[1] = 9.0 * x[0] - (x[1] - 1.0) * (x[1] - 1.0);
                       g[0] = 225.0 - x[0] * x[0] - x[1] * x[1];
                       g[1] = 3.0 * x[1] - x[0] - 10.0;
                     }},
                    optimal);
}

/// The objectives are the variables; the front consists of three disconnected parts of the wavy boundary of the first
/// constraint.
inline FrontProblem tnk() {
  Designs optimal;
  sample(optimal, 2000, 0, kPi / 2, [](double angle) {
    const double radius = std::sqrt(1 + 0.1 * sincos(16 * angle).cos);
    const auto [s, c] = sincos(angle);
    return std::vector{radius * s, radius * c};
  });
  return with_front("TNK",
                    {box(2, 0, kPi), kMinimiseBoth, 2,
                     [](auto x, auto f, auto g) {
                       f[0] = x[0];
                       f[1] = x[1];
                       g[0] = x[0] * x[0] + x[1] * x[1] - 1.0 - 0.1 * sincos(16.0 * atan2(x[0], x[1])).cos;
                       g[1] = 0.5 - (x[0] - 0.5) * (x[0] - 0.5) - (x[1] - 0.5) * (x[1] - 0.5);
                     }},
                    optimal);
}

/// Six variables; the front consists of five edges of the feasible set.
inline FrontProblem osy() {
  Designs optimal;
  sample(optimal, 150, 1, 5, [](double t) { return std::vector{5.0, 1.0, t, 0.0, 5.0, 0.0}; });
  sample(optimal, 150, 1, 5, [](double t) { return std::vector{5.0, 1.0, t, 0.0, 1.0, 0.0}; });
  sample(optimal, 100, 4.056, 5, [](double t) { return std::vector{t, (t - 2) / 3, 1.0, 0.0, 1.0, 0.0}; });
  sample(optimal, 100, 1, 3.732, [](double t) { return std::vector{0.0, 2.0, t, 0.0, 1.0, 0.0}; });
  sample(optimal, 100, 0, 1, [](double t) { return std::vector{t, 2 - t, 1.0, 0.0, 1.0, 0.0}; });
  return with_front("OSY",
                    {{{"x0", "1", 0, 10},
                      {"x1", "1", 0, 10},
                      {"x2", "1", 1, 5},
                      {"x3", "1", 0, 6},
                      {"x4", "1", 1, 5},
                      {"x5", "1", 0, 10}},
                     kMinimiseBoth,
                     6,
                     [](std::span<const double> x, std::span<double> f, std::span<double> g) {
                       const auto square = [](double value) { return value * value; };
                       f[0] = -25 * square(x[0] - 2) - square(x[1] - 2) - square(x[2] - 1) - square(x[3] - 4) -
                              square(x[4] - 1);
                       f[1] = 0;
                       for (const double value : x) f[1] += square(value);
                       g[0] = x[0] + x[1] - 2;
                       g[1] = 6 - x[0] - x[1];
                       g[2] = 2 - x[1] + x[0];
                       g[3] = 2 - x[0] + 3 * x[1];
                       g[4] = 4 - square(x[2] - 3) - x[3];
                       g[5] = square(x[4] - 3) + x[5] - 4;
                     }},
                    optimal);
}

inline std::vector<FrontProblem> unconstrained_problems() {
  std::vector<FrontProblem> problems = zdt_problems();
  problems.push_back(dtlz2());
  return problems;
}

inline std::vector<FrontProblem> constrained_problems() { return {bnh(), srn(), tnk(), osy()}; }

}  // namespace pkm::test
