// Krawczyk's test: enclosures of the solutions of a system of equations (implicit_system.hpp) for intervals.

#include <algorithm>
#include <cmath>

#include "engine/expression/newton.hpp"

namespace pkm::expression {

/// Krawczyk's test for intervals of the coefficients around an approximate solution u. With Y = J(u)^-1 and C = I - Y
/// J, where J encloses the Jacobian over a box u + [-w, w], the box contains exactly one solution for all coefficients
/// if the operator -Y f(u) + C [-w, w] maps [-w, w] into its interior; the image then contains it.
class ImplicitSystem::Krawczyk {
 public:
  using Box = std::array<Interval, kMaxUnknowns>;

  Krawczyk(const ImplicitSystem& system, std::span<const Interval> operands)
      : system_(system), n_(system.unknowns()), operands_(operands), scratch_(system.scratch_size()), inputs_(n_) {
    for (const Interval& operand : operands) middle_.push_back(operand.middle());
    inputs_.insert(inputs_.end(), operands.begin(),
                   operands.begin() + static_cast<std::ptrdiff_t>(system.coefficients_));
  }

  /// True if it is certain that the system has no solution for any coefficients: an equation does not vanish for any
  /// values of the unknowns. (Sines and cosines of unbounded angles are bounded.)
  bool excludes_solutions() {
    Box all;
    all.fill(Interval::everything(Decoration::continuous));
    const std::vector<Interval>& f = run(system_.residuals_, all);
    return std::ranges::any_of(system_.residuals_.outputs(),
                               [&](std::uint32_t output) { return f[output].lower > 0 || f[output].upper < 0; });
  }
  /// @param results  receives enclosures of the unknowns. @return false if the test proves nothing
  bool enclose(std::span<Interval> results) {
    std::vector<double> solution(1 + n_);
    system_.solve(middle_, solution, scratch_);
    if (solution[0] < 0) return false;
    Vector u{};
    std::copy_n(solution.begin() + 1, n_, u.begin());
    Box deviation;
    if (!linearise(u) || !verify(deviation)) return false;
    for (std::size_t i = 0; i < n_; ++i) results[i] = Interval(u[i]) + deviation[i];
    Box start;
    std::copy_n(operands_.begin() + static_cast<std::ptrdiff_t>(system_.coefficients_), n_, start.begin());
    return is_reached_from(start, results);
  }

 private:
  /// A point u, Y = J(u)^-1 for the midpoints of the coefficients, and C = I - Y J over a box around u.
  struct Linearisation {
    Vector u{};
    std::array<Vector, kMaxUnknowns> Y{};
    std::array<Box, kMaxUnknowns> C;
  };

  static double magnitude(const Interval& x) { return std::max(std::fabs(x.lower), std::fabs(x.upper)); }
  static double mignitude(const Interval& x) {
    return x.holds(0) ? 0 : std::min(std::fabs(x.lower), std::fabs(x.upper));
  }
  static Interval ball(double radius) { return {-radius, radius}; }

  bool linearise(const Vector& u) {
    Newton newton(system_, std::span(middle_).first(system_.coefficients_), scratch_);
    newton.evaluate(u);
    if (!newton.factor()) return false;
    at_.u = u;
    for (std::size_t j = 0; j < n_; ++j) {
      Vector unit{};
      unit[j] = 1;
      const Vector column = newton.factors.solve(unit);
      for (std::size_t i = 0; i < n_; ++i) at_.Y[i][j] = column[i];
    }
    return true;
  }
  /// Evaluates a program over a box of the unknowns.
  const std::vector<Interval>& run(const Program& program, const Box& box) {
    std::copy_n(box.begin(), n_, inputs_.begin());
    program.run_all<Interval>(inputs_, registers_);
    return registers_;
  }
  Box around(const Vector& w) const {
    Box box;
    for (std::size_t i = 0; i < n_; ++i) box[i] = Interval(at_.u[i]) + ball(w[i]);
    return box;
  }
  /// Encloses Y f(u). @return false if it is not known to be continuous and finite
  bool step(Box& Yf) {
    const std::vector<Interval>& f = run(system_.residuals_, around({}));
    for (std::size_t i = 0; i < n_; ++i) {
      Yf[i] = Interval(0.0);
      for (std::size_t k = 0; k < n_; ++k) Yf[i] = Yf[i] + Interval(at_.Y[i][k]) * f[system_.residuals_.outputs()[k]];
      if (!Yf[i].is_continuous() || !std::isfinite(magnitude(Yf[i]))) return false;
    }
    return true;
  }
  /// Computes C = I - Y J over a box.
  /// @return false if the equations are not known to be continuous there, or their derivatives are unknown
  bool contract(const Box& box) {
    const std::vector<Interval>& found = run(system_.linearisation_, box);
    const std::vector<std::uint32_t>& outputs = system_.linearisation_.outputs();
    for (std::size_t i = 0; i < n_; ++i)
      if (!found[outputs[i]].is_continuous() || found[outputs[i]].is_empty()) return false;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) {
        Interval sum(i == j ? 1 : 0);
        for (std::size_t k = 0; k < n_; ++k) {
          const Interval& element = found[outputs[n_ + k * n_ + j]];
          if (!element.is_defined() || element.is_empty()) return false;
          sum = sum - Interval(at_.Y[i][k]) * element;
        }
        if (!std::isfinite(magnitude(sum))) return false;
        at_.C[i][j] = sum;
      }
    return true;
  }
  /// Component i of C [-w, w], where C = I - Y J over the box of the last contract().
  Interval contracted(std::size_t i, const Vector& w) const {
    Interval sum(0.0);
    for (std::size_t j = 0; j < n_; ++j) sum = sum + at_.C[i][j] * ball(w[j]);
    return sum;
  }
  /// Bounds the components of (I - C)^-1 x for |x| <= b, by a d with b + |C| d < d. @return false if none is found
  bool bound_inverse(const Vector& b, Vector& d) const {
    d = b;
    for (int trial = 0; trial < 20; ++trial) {
      Vector image{};
      bool is_bound = true;
      for (std::size_t i = 0; i < n_; ++i) {
        image[i] = b[i] + magnitude(contracted(i, d)) + 1e-300;
        is_bound = is_bound && image[i] * (1 + 1e-12) < d[i];
      }
      if (is_bound) return true;
      for (std::size_t i = 0; i < n_; ++i) d[i] = std::max(d[i], 1.1 * image[i]);
    }
    return false;
  }

  /// Krawczyk's test at the approximate solution. @param image  receives an enclosure of the solution minus u
  bool verify(Box& image) {
    constexpr int kMaxTrials = 6, kRefinements = 2;
    Box Yf;
    if (!step(Yf)) return false;
    for (std::size_t i = 0; i < n_; ++i) image[i] = -Yf[i];
    int refinements = 0;
    for (int trial = 0; trial < kMaxTrials && refinements <= kRefinements; ++trial) {
      // Half widths of the box around u: inflated until the test succeeds, afterwards those of the box that is known to
      // contain the solution.
      Vector w{};
      for (std::size_t i = 0; i < n_; ++i)
        w[i] = refinements > 0 ? magnitude(image[i]) : 1.2 * magnitude(image[i]) + 1e-15 * (1 + std::fabs(at_.u[i]));
      if (!contract(around(w))) return refinements > 0;
      bool is_inside = true;
      Box next;
      for (std::size_t i = 0; i < n_; ++i) {
        next[i] = contracted(i, w) - Yf[i];
        is_inside = is_inside && -w[i] < next[i].lower && next[i].upper < w[i];
        if (refinements > 0)
          next[i] = {std::max(next[i].lower, image[i].lower), std::min(next[i].upper, image[i].upper)};
      }
      image = next;
      if (is_inside || refinements > 0) ++refinements;
    }
    return refinements > 0;
  }

  /// True if Newton's method is certain to converge to the enclosed solution from every point of a box: if, after some
  /// steps, all points are in a ball around the solution in which it converges.
  bool is_reached_from(Box box, std::span<const Interval> solution) {
    constexpr int kMaxSteps = 8;
    const Linearisation at_solution = at_;
    for (int step = 0; step <= kMaxSteps; ++step) {
      at_ = at_solution;
      if (converges_from(box, solution)) return true;
      if (!move(box)) return false;
    }
    return false;
  }
  /// A sufficient test of convergence. With C = I - Y J over a ball of the weighted maximum norm |x| = max |x_i| / w_i
  /// around the solution that contains the box, and |C| w <= rho w, the distance of the iterates from the solution
  /// shrinks by a factor of at most 2 rho / (1 - rho), which is less than 1 for rho < 1/3. As no Jacobian in the ball
  /// is singular, their determinants have the same sign.
  bool converges_from(const Box& box, std::span<const Interval> solution) {
    constexpr double kRho = 0.3;
    Vector distance{};
    for (std::size_t i = 0; i < n_; ++i) distance[i] = magnitude(box[i] - solution[i]);
    Vector w = distance;
    for (int trial = 0; trial < 3; ++trial) {
      Box region;
      for (std::size_t i = 0; i < n_; ++i) region[i] = solution[i] + ball(w[i]);
      if (!contract(region)) return false;
      bool is_inside = true;
      for (std::size_t i = 0; i < n_; ++i) {
        const double image = magnitude(contracted(i, w));
        is_inside = is_inside && image <= kRho * w[i];
        w[i] = std::max(w[i], 1.05 * image / kRho);
      }
      if (is_inside) return true;
    }
    return false;
  }
  /// Lower and upper bound of Newton::norm() for all changes in the box `change` and all unknowns in the box `box`.
  std::array<double, 2> norm(const Box& change, const Box& box) const {
    std::array<double, 2> bounds{};
    for (std::size_t i = 0; i < n_; ++i)
      bounds = {std::max(bounds[0], mignitude(change[i]) / std::max(1.0, magnitude(box[i])) * (1 - 1e-15)),
                std::max(bounds[1], magnitude(change[i]) / std::max(1.0, mignitude(box[i])) * (1 + 1e-15))};
    return bounds;
  }
  /// Encloses (I - C)^-1 x. @return false if it is not bounded
  bool apply_inverse(Box& x) const {
    Vector b{}, d{};
    for (std::size_t i = 0; i < n_; ++i) b[i] = magnitude(x[i]);
    if (!bound_inverse(b, d)) return false;
    for (std::size_t i = 0; i < n_; ++i) x[i] = x[i] + ball(magnitude(contracted(i, d)));
    return true;
  }
  /// Replaces a box by an enclosure of the next iterates of Newton's method from all of its points.
  /// @return false if there is none, or if it is uncertain how the step is damped
  bool move(Box& box) {
    Vector centre{}, r{};
    for (std::size_t i = 0; i < n_; ++i) {
      centre[i] = box[i].middle();
      r[i] = magnitude(box[i] - Interval(centre[i]));
    }
    Box change;
    if (!linearise(centre) || !step(change) || !contract(box)) return false;
    // For a point v of the box, Y f(v) = Y f(u) + (I - C) (v - u), and the step is (I - C)^-1 Y f(v).
    for (std::size_t i = 0; i < n_; ++i) change[i] = change[i] + ball(r[i]) + contracted(i, r);
    if (!apply_inverse(change)) return false;
    const auto length = norm(change, box);
    for (double damping = 1;; damping /= 2) {
      Box next, correction;
      for (std::size_t i = 0; i < n_; ++i) next[i] = box[i] - Interval(damping) * change[i];
      const std::vector<Interval>& f = run(system_.residuals_, next);
      for (std::size_t i = 0; i < n_; ++i) {
        correction[i] = Interval(0.0);
        for (std::size_t k = 0; k < n_; ++k)
          correction[i] = correction[i] + Interval(at_.Y[i][k]) * f[system_.residuals_.outputs()[k]];
        if (!correction[i].is_defined() || !std::isfinite(magnitude(correction[i]))) return false;
      }
      if (!apply_inverse(correction)) return false;
      const auto next_length = norm(correction, box);
      if (next_length[1] < length[0] || damping <= Newton::kMinDamping) {
        box = next;
        return true;
      }
      if (next_length[0] < length[1]) return false;
    }
  }

  const ImplicitSystem& system_;
  const std::size_t n_;
  std::span<const Interval> operands_;
  std::vector<double> middle_;   ///< midpoints of the operands
  std::vector<double> scratch_;  ///< of Newton's method
  std::vector<Interval> inputs_, registers_;
  Linearisation at_;
};

void ImplicitSystem::solve(std::span<const Interval> operands, std::span<Interval> results) const {
  Decoration decoration = Decoration::continuous;
  const bool is_undefined = std::ranges::any_of(operands, &Interval::is_empty);
  for (const Interval& operand : operands) decoration = weaker(decoration, operand.decoration);
  Krawczyk test(*this, operands);
  if (!is_undefined && decoration == Decoration::continuous && test.enclose(results.subspan(1))) {
    results[0] = Interval(1.0);
  } else if (is_undefined || test.excludes_solutions()) {
    std::ranges::fill(results, Interval::empty());
    results[0] = Interval(-1.0);
  } else {
    std::ranges::fill(results, Interval::everything(Decoration::partial));
    results[0] = {-1, 1, Decoration::defined};
  }
}

}  // namespace pkm::expression
