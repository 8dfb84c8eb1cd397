#include "engine/expression/implicit_system.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/expression/reverse_mode.hpp"

namespace pkm::expression {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr Groups kCoefficients = 1, kUnknowns = 2;

using Vector = std::array<double, ImplicitSystem::kMaxUnknowns>;

}  // namespace

/// LU factors of a Jacobian, with partial pivoting.
struct ImplicitSystem::Factors {
  std::size_t n;
  std::array<Vector, kMaxUnknowns> a;
  std::array<std::size_t, kMaxUnknowns> row;
  bool is_negative;  ///< true if the determinant of the Jacobian is negative

  /// Factors the Jacobian of a linearisation. @return false if it is singular or not finite
  template <class Element>
  bool factor(const Element& element) {
    is_negative = false;
    for (std::size_t i = 0; i < n; ++i) {
      row[i] = i;
      for (std::size_t j = 0; j < n; ++j) a[i][j] = element(i, j);
    }
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < n; ++i)
        if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
      if (pivot != k) {
        std::swap(a[pivot], a[k]);
        std::swap(row[pivot], row[k]);
        is_negative = !is_negative;
      }
      if (!(std::fabs(a[k][k]) > 0 && std::isfinite(a[k][k]))) return false;
      if (a[k][k] < 0) is_negative = !is_negative;
      for (std::size_t i = k + 1; i < n; ++i) {
        const double factor = a[i][k] /= a[k][k];
        for (std::size_t j = k + 1; j < n; ++j) a[i][j] -= factor * a[k][j];
      }
    }
    return true;
  }
  /// Returns J^-1 b, where J is the Jacobian that was factored last.
  Vector solve(const Vector& b) const {
    Vector x{};
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = b[row[i]];
      for (std::size_t j = 0; j < i; ++j) x[i] -= a[i][j] * x[j];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t j = i + 1; j < n; ++j) x[i] -= a[i][j] * x[j];
      x[i] /= a[i][i];
    }
    return x;
  }
  /// Returns J^-T b, where J is the Jacobian that was factored last.
  Vector solve_transposed(Vector b) const {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) b[i] -= a[j][i] * b[j];
      b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;)
      for (std::size_t j = i + 1; j < n; ++j) b[i] -= a[j][i] * b[j];
    Vector x{};
    for (std::size_t i = 0; i < n; ++i) x[row[i]] = b[i];
    return x;
  }
};

/// The linearised equations at a point, and Newton's method.
class ImplicitSystem::Newton {
 public:
  static constexpr double kMinDamping = 1.0 / 64;  ///< minimum damping factor; a step with it is always carried out

  Newton(const ImplicitSystem& system, std::span<const double> operands) : system_(system) {
    factors.n = system.unknowns();
    registers_.resize(system.linearisation_.registers());
    inputs_.assign(system.unknowns(), 0);
    inputs_.insert(inputs_.end(), operands.begin(), operands.end());
    system.linearisation_.start<double>(registers_);
    system.linearisation_.run<double>(0, inputs_, registers_);
  }

  Factors factors;  ///< LU factors of the Jacobian at the point of the last successful call of factor()
  std::span<const double> registers() const { return registers_; }

  /// Evaluates the equations and their Jacobian at a point. @return the values of the equations
  Vector evaluate(const Vector& u) {
    std::copy_n(u.begin(), factors.n, inputs_.begin());
    system_.linearisation_.run<double>(1, inputs_, registers_);
    Vector f{};
    for (std::size_t i = 0; i < factors.n; ++i) f[i] = registers_[system_.linearisation_.outputs()[i]];
    return f;
  }
  /// Factors the Jacobian at the point of the last call of evaluate().
  bool factor() {
    const std::size_t n = factors.n;
    return factors.factor(
        [&](std::size_t i, std::size_t j) { return registers_[system_.linearisation_.outputs()[n + i * n + j]]; });
  }
  /// Newton's method from the start u, which is replaced by the solution. @return false if it does not converge, or
  /// converges to another branch
  bool solve(Vector& u) {
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

 private:
  Vector moved(Vector u, const Vector& change, double damping) const {
    for (std::size_t i = 0; i < factors.n; ++i) u[i] -= damping * change[i];
    return u;
  }
  /// Maximum norm of a change of the unknowns u, in which component i is divided by |u_i| if |u_i| > 1 [m, rad]; NaN if
  /// a component is NaN.
  double norm(const Vector& change, const Vector& u) const {
    double largest = 0;
    for (std::size_t i = 0; i < factors.n; ++i) {
      const double size = std::fabs(change[i]) / std::max(1.0, std::fabs(u[i]));
      if (!(size <= largest)) largest = size;
      if (size != size) break;
    }
    return largest;
  }

  const ImplicitSystem& system_;
  // Scratch memory, reused by later calls of this thread, because solving is in the innermost loops of workspace
  // analyses.
  static thread_local std::vector<double> registers_, inputs_;
};

thread_local std::vector<double> ImplicitSystem::Newton::registers_, ImplicitSystem::Newton::inputs_;

ImplicitSystem::ImplicitSystem(Graph graph, std::vector<Node> equations, std::size_t coefficients)
    : graph_(std::move(graph)), equations_(std::move(equations)), coefficients_(coefficients) {
  PKM_EXPECTS(!equations_.empty() && equations_.size() <= kMaxUnknowns);
  for (const Node equation : equations_)
    for (std::size_t j = 0; j < unknowns(); ++j)
      jacobian_.push_back(derivative(graph_, equation, graph_.input(j, kUnknowns)));
  constexpr std::array kStages{kCoefficients, kUnknowns};
  std::vector<Node> all = equations_;
  residuals_ = Program(graph_, all, kStages);
  all.insert(all.end(), jacobian_.begin(), jacobian_.end());
  linearisation_ = Program(graph_, all, kStages);
}

void ImplicitSystem::solve(std::span<const double> operands, std::span<double> results) const {
  Vector u{};
  std::copy_n(operands.begin() + static_cast<std::ptrdiff_t>(coefficients_), unknowns(), u.begin());
  const bool solved = Newton(*this, operands.first(coefficients_)).solve(u);
  results[0] = solved ? 1 : -1;
  for (std::size_t i = 0; i < unknowns(); ++i) results[i + 1] = solved ? u[i] : kUndefined;
}

namespace {

// parts_of(): number of derivatives that a scalar carries; the functions after it read and change them by index.
// kOrders: number of chord steps after which these derivatives are exact, one per order of differentiation.
constexpr int parts_of(const Dual4&) { return 4; }
constexpr int parts_of(const Taylor&) { return 2; }
double derivative_part(const Dual4& x, int i) { return x.v[i]; }
double derivative_part(const Taylor& x, int i) { return i == 0 ? x.d : x.dd; }
void add_to_part(Dual4& x, int i, double change) { x.v[i] += change; }
void add_to_part(Taylor& x, int i, double change) { (i == 0 ? x.d : x.dd) += change; }
template <class S>
constexpr int kOrders = std::is_same_v<S, Taylor> ? 2 : 1;

}  // namespace

/// Chord steps u - J^-1 f in the arithmetic of S, from the solution in double precision. They leave the value as it is.
template <class S>
void ImplicitSystem::differentiate(std::span<const S> operands, std::span<S> results) const {
  std::vector<double> values, solution(1 + unknowns());
  for (const S& operand : operands) values.push_back(value_of(operand));
  solve(values, std::span<double>(solution));
  std::ranges::copy(solution, results.begin());
  if (solution[0] < 0) return;
  Newton newton(*this, std::span(values).first(coefficients_));
  Vector u{};
  std::copy_n(solution.begin() + 1, unknowns(), u.begin());
  newton.evaluate(u);
  if (!newton.factor()) {
    for (S& result : results.subspan(1)) result = S(kUndefined);
    return;
  }
  std::vector<S> inputs(results.begin() + 1, results.end()), registers;
  inputs.insert(inputs.end(), operands.begin(), operands.end());
  for (int order = 0; order < kOrders<S>; ++order) {
    std::copy(results.begin() + 1, results.end(), inputs.begin());
    residuals_.run_all<S>(inputs, registers);
    for (int k = 0; k < parts_of(S()); ++k) {
      Vector f{};
      for (std::size_t i = 0; i < unknowns(); ++i) f[i] = derivative_part(registers[residuals_.outputs()[i]], k);
      const Vector change = newton.factors.solve(f);
      for (std::size_t i = 0; i < unknowns(); ++i) add_to_part(results[i + 1], k, -change[i]);
    }
  }
}

void ImplicitSystem::solve(std::span<const Dual4> operands, std::span<Dual4> results) const {
  differentiate(operands, results);
}
void ImplicitSystem::solve(std::span<const Taylor> operands, std::span<Taylor> results) const {
  differentiate(operands, results);
}

std::vector<double> ImplicitSystem::adjoints(std::span<const double> operands, std::span<const double> unknowns,
                                             std::span<const double> of_unknowns) const {
  Newton newton(*this, operands.first(coefficients_));
  Vector u{}, weights{};
  std::ranges::copy(unknowns, u.begin());
  std::ranges::copy(of_unknowns, weights.begin());
  std::vector<double> found(operands.size());
  newton.evaluate(u);
  if (!newton.factor()) return std::vector<double>(operands.size(), kUndefined);
  const Vector of_equations = newton.factors.solve_transposed(weights);
  std::vector<double> by(linearisation_.registers());
  for (std::size_t i = 0; i < equations_.size(); ++i) by[linearisation_.outputs()[i]] -= of_equations[i];
  for (const std::size_t stage : {1, 0}) backward_sweep(linearisation_, stage, newton.registers(), by);
  for (const Program::Input& input : linearisation_.stages()[0].inputs)
    found[input.position - equations_.size()] = by[input.to];
  return found;
}

ImplicitSystem::Nodes ImplicitSystem::nodes(Graph& to, std::span<const Node> unknowns,
                                            std::span<const Node> operands) const {
  std::vector<Node> roots = equations_, copies(graph_.size()), arguments;
  roots.insert(roots.end(), jacobian_.begin(), jacobian_.end());
  for (const Node node : graph_.reachable(roots)) {
    const Entry& entry = graph_[node];
    const auto input = static_cast<std::size_t>(entry.input);
    arguments.clear();
    for (const Node operand : entry.operands()) arguments.push_back(copies[static_cast<std::size_t>(operand)]);
    copies[static_cast<std::size_t>(node)] = entry.operation           ? to.apply_like(entry, arguments)
                                             : entry.is_number()       ? to.number(entry.number)
                                             : input < unknowns.size() ? unknowns[input]
                                                                       : operands[input - unknowns.size()];
  }
  const auto copied = [&](const std::vector<Node>& nodes) {
    std::vector<Node> made;
    for (const Node node : nodes) made.push_back(copies[static_cast<std::size_t>(node)]);
    return made;
  };
  return {copied(equations_), copied(jacobian_)};
}

/// Krawczyk's test for intervals of the coefficients around an approximate solution u. With Y = J(u)^-1 and C = I - Y
/// J, where J encloses the Jacobian over a box u + [-w, w], the box contains exactly one solution for all coefficients
/// if the operator -Y f(u) + C [-w, w] maps [-w, w] into its interior; the image then contains it.
class ImplicitSystem::Krawczyk {
 public:
  using Box = std::array<Interval, kMaxUnknowns>;

  Krawczyk(const ImplicitSystem& system, std::span<const Interval> operands)
      : system_(system), n_(system.unknowns()), operands_(operands), inputs_(n_) {
    for (const Interval& operand : operands) middle_.push_back(operand.middle());
    inputs_.insert(inputs_.end(), operands.begin(),
                   operands.begin() + static_cast<std::ptrdiff_t>(system.coefficients_));
  }

  /// True if it is certain that the system has no solution for any coefficients: one of the equations is violated for
  /// all values of the unknowns. (Sines and cosines of unbounded angles are bounded.)
  bool excludes_solutions() {
    Box all;
    all.fill(Interval::everything(Decoration::continuous));
    const std::vector<Interval>& f = run(system_.residuals_, all);
    return std::ranges::any_of(system_.residuals_.outputs(),
                               [&](std::uint32_t output) { return f[output].lower > 0 || f[output].upper < 0; });
  }
  /// Finds enclosures of the unknowns by Krawczyk's test.
  /// @param results  receives the enclosures
  /// @return false if the test proves nothing
  bool enclose(std::span<Interval> results) {
    std::vector<double> solution(1 + n_);
    system_.solve(middle_, std::span<double>(solution));
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
    Newton newton(system_, std::span(middle_).first(system_.coefficients_));
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
  /// Encloses Y f(u), where Y is the inverse of the Jacobian at the approximate solution u. @return false if it is not
  /// known to be continuous and finite
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
  /// Bounds the components of (I - C)^-1 x for |x| <= b, where C = I - Y J, by a d with b + |C| d < d. @return false if
  /// none is found
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
  /// Replaces x by an enclosure of (I - C)^-1 x, where C = I - Y J. @return false if it is not bounded
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
  std::vector<double> middle_;  ///< midpoints of the intervals of the operands
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
