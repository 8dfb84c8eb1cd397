#include "engine/expression/newton.hpp"

#include <limits>

namespace pkm::expression {

bool ImplicitSystem::Newton::solve(Vector& u) {
  constexpr int kMaxSteps = 30;
  // Step length (of unknowns above 1, relative to them) below which the quadratic convergence makes one further step
  // exact to rounding.
  constexpr double kLastStep = 1e-8;
  Vector f = evaluate(u);
  if (!factor()) return false;
  const bool branch = factors.is_negative;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vector change = factors.solve(f);
    const double length = norm(change, u);
    if (!(length <= std::numeric_limits<double>::max())) return false;
    if (length <= kLastStep) {
      u = moved(u, change, 1);
      f = evaluate(u);
      if (!factor()) return false;
      const Vector last = factors.solve(f);
      u = moved(u, last, 1);
      return norm(last, u) <= kLastStep && factors.is_negative == branch;
    }
    double damping = 1;
    Vector next = moved(u, change, damping);
    f = evaluate(next);
    // natural monotonicity test: the simplified correction at the next point has to be shorter than the step
    while (!(norm(factors.solve(f), u) < length) && damping > kMinDamping) {
      damping /= 2;
      next = moved(u, change, damping);
      f = evaluate(next);
    }
    u = next;
    if (!factor()) return false;
  }
  return false;
}

}  // namespace pkm::expression
