// The parts of an interval on which a function of known steepness is not negative.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pkm {

struct Part {
  double lower = 0, upper = 0;
};

/// A sign change between a and b, narrowed by false position, Illinois variant. Uses nothing of a function but the
/// signs and sizes of its values inside the bracket, so jumps do no harm.
struct Bracket {
  double a, at_a, b, at_b;
  int side = 0;  ///< -1, 1: a, b was the last to move

  double width() const { return std::fabs(b - a); }
  double middle() const { return 0.5 * (a + b); }
  double guess() const {
    const double at = b - at_b * (b - a) / (at_b - at_a);
    return (at > a && at < b) || (at > b && at < a) ? at : middle();
  }
  void take(double at, double value) {
    if ((value >= 0) == (at_a >= 0)) {
      a = at;
      at_a = value;
      if (side == -1) at_b *= 0.5;
      side = -1;
    } else {
      b = at;
      at_b = value;
      if (side == 1) at_a *= 0.5;
      side = 1;
    }
  }
};

/// Where f changes its sign between a (f(a) = at_a) and b, to `width`; with a bisection whenever three steps have not
/// halved the bracket.
template <class F>
double bracketed_root(const F& f, double a, double at_a, double b, double at_b, double width) {
  Bracket bracket{.a = a, .at_a = at_a, .b = b, .at_b = at_b};
  double before = bracket.width();
  for (int step = 1; step < 400 && bracket.width() > width; ++step) {
    bool bisect = false;
    if (step % 3 == 0) {
      bisect = bracket.width() > 0.5 * before;
      before = bracket.width();
    }
    const double at = bisect ? bracket.middle() : bracket.guess();
    if (at == bracket.a || at == bracket.b) break;  // neighbouring numbers
    bracket.take(at, f(at));
  }
  return bracket.middle();
}

/// Finds the parts of an interval on which a function is not negative.
///
/// The interval is halved until the values at the ends and the steepness decide each piece, or the piece is 1/16 of the
/// interval. A sign change is found to 1e-13 of the interval. Where the values come near 0 without a sign change and
/// the steepness does not rule one out, the nearest approach to 0 is searched for by golden sections, to 1e-6 of the
/// interval, and taken in if it has the other sign. So a part or a gap can be overlooked only if it is narrower than
/// that, or if several fall into one such piece.
class NonNegativeParts {
 public:
  /// @param f      its sign has to be right everywhere; where positive it may be less than the function meant, so that
  ///               a cheap lower bound will do
  /// @param steep  steep(p, q): a bound of |df/dx| on [p, q], for the function meant; may be infinite
  /// @param parts  overwritten, in order
  template <class F, class Steepness>
  void find(const F& f, const Steepness& steep, double lower, double upper, std::vector<Part>& parts) {
    parts.clear();
    if (!(lower < upper)) return;
    const double range = upper - lower;
    nodes_.clear();
    nodes_.push_back({lower, f(lower), true});
    sample(f, steep, {upper, f(upper), true}, kCoarsest * range);
    approach_zero(f, steep, kNearest * range);
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
      const Node &p = nodes_[i - 1], &q = nodes_[i];
      if (p.positive() == q.positive()) {
        if (p.positive()) add(p.x, q.x, parts);
        continue;
      }
      const double end = bracketed_root(f, p.x, p.value, q.x, q.value, kRoot * range);
      if (p.positive())
        add(p.x, end, parts);
      else
        add(end, q.x, parts);
    }
  }

 private:
  static constexpr double kCoarsest = 1.0 / 16, kNearest = 1e-6, kRoot = 1e-13;

  struct Node {
    double x, value;
    bool decided;  ///< the steepness rules out a sign change between the node before and this one
    bool positive() const { return value >= 0; }
  };

  static void add(double from, double to, std::vector<Part>& parts) {
    if (!parts.empty() && parts.back().upper == from)
      parts.back().upper = to;
    else if (from < to)
      parts.push_back({from, to});
  }

  /// Appends the nodes from the last one to `end`.
  template <class F, class Steepness>
  void sample(const F& f, const Steepness& steep, Node end, double coarsest) {
    const Node from = nodes_.back();
    const double width = end.x - from.x;
    const bool same = from.positive() == end.positive();
    end.decided = same && std::fabs(from.value) + std::fabs(end.value) >= steep(from.x, end.x) * width;
    if (end.decided || width <= coarsest) {
      nodes_.push_back(end);
      return;
    }
    const double middle = 0.5 * (from.x + end.x);
    sample(f, steep, {middle, f(middle), true}, coarsest);
    sample(f, steep, end, coarsest);
  }

  /// Adds a node of the other sign wherever the function passes 0 twice between nodes of one sign.
  template <class F, class Steepness>
  void approach_zero(const F& f, const Steepness& steep, double nearest) {
    const std::size_t last = nodes_.size() - 1;
    found_.clear();
    for (std::size_t i = 0; i <= last; ++i) {
      const Node &here = nodes_[i], &before = nodes_[i > 0 ? i - 1 : 0], &after = nodes_[i < last ? i + 1 : last];
      const bool turns = before.positive() == here.positive() && after.positive() == here.positive() &&
                         std::fabs(here.value) <= std::fabs(before.value) &&
                         std::fabs(here.value) <= std::fabs(after.value);
      if (!turns || ((i == 0 || here.decided) && (i == last || after.decided))) continue;
      const double sign = here.positive() ? 1 : -1;
      search([&](double x) { return sign * f(x); }, steep, before.x, here.x, sign * here.value, after.x, sign, nearest);
    }
    for (const Node& node : found_)
      nodes_.insert(std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& n) { return n.x > node.x; }), node);
  }

  /// Golden sections towards the least value of g in [a, b], from a point between them, until it is < 0.
  template <class F, class Steepness>
  void search(const F& g, const Steepness& steep, double a, double middle, double least, double b, double sign,
              double nearest) {
    constexpr double kSection = 0.3819660112501051;  // 2 - golden ratio
    while (b - a > nearest && least < steep(a, b) * (b - a)) {
      const bool right = b - middle > middle - a;
      const double x = right ? middle + kSection * (b - middle) : middle - kSection * (middle - a);
      const double here = g(x);
      if (here < 0 || (sign < 0 && here == 0)) {
        found_.push_back({x, sign * here, false});
        return;
      }
      if (here < least) {
        (right ? a : b) = middle;
        middle = x;
        least = here;
      } else {
        (right ? b : a) = x;
      }
    }
  }

  std::vector<Node> nodes_, found_;
};

}  // namespace pkm
