// Root finding in one variable: Chandrupatla's method, bisection, and Newton's method with and without a bracket.
//
// The methods with a bracket never leave it, and converge to a sign change of a discontinuous function, too.
//
// References: T. R. Chandrupatla, "A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear
// function without using derivatives", Advances in Engineering Software 28 (1997) 145-149; W. H. Press et al.,
// "Numerical Recipes", 3rd ed., 2007, section 9.4 (Newton's method safeguarded by bisection).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/math/satisfied.hpp"

namespace pkm {

/// Refines the root of f between a and b by Chandrupatla's method: inverse quadratic interpolation if its criterion
/// predicts that three points are interpolated well, otherwise bisection; the first step is a secant step.
///
/// Simple roots of smooth functions are located to rounding accuracy with about 6 evaluations if the bracket is narrow,
/// and 10 if it is wide; multiple roots, kinks and discontinuities with up to twice as many as by bisection.
/// @param f_a, f_b  f(a) and f(b), which must have different signs: 0 counts as positive, NaN as negative
/// @param width     absolute width of the final bracket; 0: adjacent doubles. |b - a| must be finite
/// @return the midpoint of the final bracket
template <class F>
double refine_root(const F& f, double a, double f_a, double b, double f_b, double width) {
  constexpr double kRounding = 2.3e-16;  // slightly more than the relative distance between adjacent doubles
  constexpr int kMaxSteps = 5000;  // more than twice the bisections needed from the largest to the smallest double
  double t = f_a / (f_a - f_b);    // position of the next point between a and b
  for (int step = 0; step < kMaxSteps && std::fabs(b - a) > width; ++step) {
    // A point too close to an end of the bracket is moved away from it, so that both ends of the bracket move.
    const double tolerance = std::fmax(0.5 * width, kRounding * std::fmax(std::fabs(a), std::fabs(b)));
    const double inset = std::fmin(0.5, tolerance / std::fabs(b - a));
    t = t >= 0 && t <= 1 ? std::fmin(std::fmax(t, inset), 1 - inset) : 0.5;
    double x = a + t * (b - a);
    if (x == a || x == b) x = a + 0.5 * (b - a);
    if (x == a || x == b) break;  // adjacent doubles
    // x replaces a; (c, f_c) is the replaced point
    const double f_x = f(x);
    const bool replaces_a = (f_x >= 0) == (f_a >= 0);
    const double c = replaces_a ? a : b, f_c = replaces_a ? f_a : f_b;
    if (!replaces_a) {
      b = a;
      f_b = f_a;
    }
    a = x;
    f_a = f_x;
    const double xi = (a - b) / (c - b), phi = (f_a - f_b) / (f_c - f_b);
    const bool interpolates = phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi;
    t = interpolates
            ? f_a / (f_b - f_a) * (f_c / (f_b - f_c)) + (c - a) / (b - a) * (f_a / (f_c - f_a)) * (f_b / (f_c - f_b))
            : 0.5;
  }
  return a + 0.5 * (b - a);
}

/// Value and derivative of a function at one point.
struct ValueAndDerivative {
  double value, derivative;
};

/// Refines the root of f between low and high by Newton's method. A step is replaced by bisection if it leaves the
/// bracket, or if it is larger than half the step before the last one.
/// @param f                f(x): an object with the members `value` and `derivative`
/// @param positive_at_low  is_satisfied(f(low).value), which must differ from is_satisfied(f(high).value)
/// @param x                first point; replaced by the midpoint if it is not inside the bracket
/// @param converged        converged(f(x), x, next): whether `next`, the result of Newton's step from x, is accurate
///                         enough
/// @return the root; iteration stops at once at a point where f is exactly 0
template <class F, class Converged>
double refine_root_newton(const F& f, double low, double high, bool positive_at_low, double x,
                          const Converged& converged) {
  constexpr int kMaxSteps = 5000;  // see refine_root()
  if (!(x > low && x < high)) x = 0.5 * (low + high);
  double last = high - low, before_last = last;                 // sizes of the previous steps
  for (int n = 0; n < kMaxSteps && x > low && x < high; ++n) {  // otherwise low and high are adjacent doubles
    const auto here = f(x);
    if (here.value == 0) return x;
    (is_satisfied(here.value) == positive_at_low ? low : high) = x;
    const double step = -here.value / here.derivative;
    double next = x + step;
    // If the derivative is infinite, the step is short although the root may be far away.
    if (converged(here, x, next) && std::isfinite(here.derivative)) return std::fmin(std::fmax(next, low), high);
    if (!(next > low && next < high) || 2 * std::fabs(step) > before_last) next = 0.5 * (low + high);
    before_last = last;
    last = std::fabs(next - x);
    x = next;
  }
  return x;
}

/// Result of iterate_newton().
struct NewtonResult {
  double x;
  bool has_converged;
};

/// Newton's method from a point near the root, without a bracket. It ends without convergence if it leaves the open
/// interval (low, high), or after `max_steps` steps.
/// @param step       step(x): Newton's step from x; NaN if it is undefined. For a system of equations, x is the first
///                   unknown, and the callable itself updates the others
/// @param converged  converged(x, step): whether x, the point after this step, is accurate enough
template <class Step, class Converged>
NewtonResult iterate_newton(const Step& step, double x, double low, double high, int max_steps,
                            const Converged& converged) {
  for (int n = 0; n < max_steps; ++n) {
    const double change = step(x);
    x += change;
    if (!(x > low && x < high)) break;
    if (converged(x, change)) return {x, true};
  }
  return {x, false};
}

/// A bracket whose endpoints differ in a property.
struct Bracket {
  double with, without;  ///< the endpoint that has the property, and the one that does not
  double middle() const { return with + 0.5 * (without - with); }
};

/// Bisection: narrows a bracket.
/// @param has    has(x): whether x has the property; an empty std::optional ends the bisection
/// @param width  absolute width of the final bracket; 0: adjacent doubles
template <class Property>
Bracket bisect(const Property& has, Bracket bracket, double width) {
  while (std::fabs(bracket.without - bracket.with) > width) {
    const double middle = bracket.middle();
    if (middle == bracket.with || middle == bracket.without) break;  // adjacent doubles
    const std::optional<bool> here = has(middle);
    if (!here) break;
    (*here ? bracket.with : bracket.without) = middle;
  }
  return bracket;
}

}  // namespace pkm
