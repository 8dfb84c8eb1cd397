// Finds the intervals on which a function of one variable is non-negative, given bounds of its derivative (Lipschitz
// constants).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/math/roots.hpp"

namespace pkm {

/// A closed interval of the variable.
struct ClosedInterval {
  double lower = 0, upper = 0;
};

/// Finds the intervals of [lower, upper] on which a function is non-negative.
///
/// The interval is bisected until the values at the endpoints of each subinterval and its Lipschitz constant exclude a
/// sign change in it, or until its width is 1/16 of the interval. Sign changes are then located to 1e-13 of the
/// interval. If the samples have a local minimum of |f| without a sign change, and the Lipschitz constant does not
/// exclude two sign changes, a golden-section search locates the minimum to 1e-6 of the interval, and a point of the
/// opposite sign becomes an additional sample. Therefore a component or a gap can be missed only if it is narrower than
/// 1e-6 of the interval, or if several of them lie in one subinterval.
class NonNegativeIntervals {
 public:
  /// @param f          must have the correct sign everywhere; where it is positive, a lower bound of the actual
  ///                   function is sufficient (for example, a bound that is cheap to compute)
  /// @param lipschitz  lipschitz(p, q): upper bound of |df/dx| of the actual function on [p, q]; may be infinite
  /// @param intervals  receives the intervals in ascending order
  template <class F, class LipschitzBound>
  void find(const F& f, const LipschitzBound& lipschitz, double lower, double upper,
            std::vector<ClosedInterval>& intervals) {
    intervals.clear();
    if (!(lower < upper)) return;
    const double range = upper - lower;
    nodes_.clear();
    nodes_.push_back({lower, f(lower), true});
    sample(f, lipschitz, {upper, f(upper), true}, kMaxWidth * range);
    search_minima(f, lipschitz, kMinimumTolerance * range);
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
      const Node &p = nodes_[i - 1], &q = nodes_[i];
      if (p.positive() == q.positive()) {
        if (p.positive()) add(p.x, q.x, intervals);
        continue;
      }
      const double end = refine_root(f, p.x, p.value, q.x, q.value, kRootTolerance * range);
      if (p.positive())
        add(p.x, end, intervals);
      else
        add(end, q.x, intervals);
    }
  }

 private:
  // All lengths are relative to the whole interval. An undecided subinterval is bisected until its width is at most
  // kMaxWidth. Minima of |f| and roots of f are located to the two tolerances.
  static constexpr double kMaxWidth = 1.0 / 16, kMinimumTolerance = 1e-6, kRootTolerance = 1e-13;

  /// A point x at which the function was evaluated, and its value there.
  struct Node {
    double x, value;
    bool decided;  ///< true: the Lipschitz constant excludes a sign change between the previous node and this one
    bool positive() const { return value >= 0; }
  };

  /// Appends the interval [from, to] to `intervals`, or extends the last one if it ends at `from`.
  static void add(double from, double to, std::vector<ClosedInterval>& intervals) {
    if (!intervals.empty() && intervals.back().upper == from)
      intervals.back().upper = to;
    else if (from < to)
      intervals.push_back({from, to});
  }

  /// Appends samples between the last node and `end`, and `end` itself, by recursive bisection.
  template <class F, class LipschitzBound>
  void sample(const F& f, const LipschitzBound& lipschitz, Node end, double max_width) {
    const Node from = nodes_.back();
    const double width = end.x - from.x;
    const bool same = from.positive() == end.positive();
    end.decided = same && std::fabs(from.value) + std::fabs(end.value) >= lipschitz(from.x, end.x) * width;
    if (end.decided || width <= max_width) {
      nodes_.push_back(end);
      return;
    }
    const double middle = 0.5 * (from.x + end.x);
    sample(f, lipschitz, {middle, f(middle), true}, max_width);
    sample(f, lipschitz, end, max_width);
  }

  /// Minimises |f| near each local minimum among nodes of the same sign. If this finds a point of the opposite sign,
  /// the point becomes a node.
  template <class F, class LipschitzBound>
  void search_minima(const F& f, const LipschitzBound& lipschitz, double tolerance) {
    const std::size_t last = nodes_.size() - 1;
    found_.clear();
    for (std::size_t i = 0; i <= last; ++i) {
      const Node &here = nodes_[i], &before = nodes_[i > 0 ? i - 1 : 0], &after = nodes_[i < last ? i + 1 : last];
      const bool is_minimum = before.positive() == here.positive() && after.positive() == here.positive() &&
                              std::fabs(here.value) <= std::fabs(before.value) &&
                              std::fabs(here.value) <= std::fabs(after.value);
      if (!is_minimum || ((i == 0 || here.decided) && (i == last || after.decided))) continue;
      const double sign = here.positive() ? 1 : -1;
      search_minimum([&](double x) { return sign * f(x); }, lipschitz, before.x, here.x, sign * here.value, after.x,
                     sign, tolerance);
    }
    for (const Node& node : found_)
      nodes_.insert(std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& n) { return n.x > node.x; }), node);
  }

  /// Golden-section search for the minimum of g in [a, b], starting with g(middle) = minimum; stops at a point with
  /// g < 0, which it records.
  template <class F, class LipschitzBound>
  void search_minimum(const F& g, const LipschitzBound& lipschitz, double a, double middle, double minimum, double b,
                      double sign, double tolerance) {
    constexpr double kSection = 0.3819660112501051;  // 2 - golden ratio
    while (b - a > tolerance && minimum < lipschitz(a, b) * (b - a)) {
      const bool right = b - middle > middle - a;
      const double x = right ? middle + kSection * (b - middle) : middle - kSection * (middle - a);
      const double here = g(x);
      if (here < 0 || (sign < 0 && here == 0)) {
        found_.push_back({x, sign * here, false});
        return;
      }
      if (here < minimum) {
        (right ? a : b) = middle;
        middle = x;
        minimum = here;
      } else {
        (right ? b : a) = x;
      }
    }
  }

  std::vector<Node> nodes_, found_;
};

}  // namespace pkm
