#include "engine/accelerators/hybrid/strips.hpp"

#include <algorithm>
#include <cmath>

#include "engine/accelerators/hybrid/intersections.hpp"

namespace pkm::hybrid {
namespace {

// Maximum number of bisections: a component missed in 2^-16 of a range changes the area by about 1e-15, relatively.
constexpr int kDepth = 16;

constexpr double kRootTolerance = 1e-13;  // accuracy of heights that are computed in two ways [m]

/// The square roots in the formulas of all curves at one value of z.
struct Node {
  double z;
  std::array<double, kCurves> root;
};

Node node_at(const Slice<double>& s, double z) {
  Node n{.z = z, .root = {}};
  for (std::size_t k = 0; k < kCurves; ++k) n.root[k] = s.curve[k].root(z);
  return n;
}

double x_at(const Slice<double>& s, const Edge& e, const Node& n) {
  return s.constant(e) + n.root[e.curve] * s.sign(e);
}

/// Tests whether the edge `above` can intersect the edge `below` between two heights, at both of which `above` is not
/// below `below`. A convex function is above its tangents, and a concave one is above its chord; this gives a piecewise
/// linear lower bound of the distance between the edges.
/// @return a height at which this bound is negative; kNoIntersection if there is none
double possible_intersection(const Slice<double>& s, const Edge& above, const Edge& below, const Node& p,
                             const Node& q) {
  if (are_bounds_of_chain(above, below)) return kNoIntersection;
  const double high = s.sign(above), low = s.sign(below);
  // If above_is_convex is false, `above` is concave. If below_is_concave is false, `below` is convex.
  const bool above_is_convex = high<0, below_is_concave = low> 0;
  const double width = q.z - p.z, gap_p = x_at(s, above, p) - x_at(s, below, p),
               gap_q = x_at(s, above, q) - x_at(s, below, q);
  if (!above_is_convex && !below_is_concave) return kNoIntersection;
  const auto chord = [&](const Edge& e, double sign) { return sign * (q.root[e.curve] - p.root[e.curve]) / width; };
  const auto tangent = [&](const Edge& e, double sign, const Node& n) {
    return sign * s.curve[e.curve].derivative(n.z, n.root[e.curve]);
  };
  double derivative_p = 0, derivative_q = 0;
  const auto add = [&](const Edge& e, double sign, bool use_tangent, double factor) {
    const double straight = use_tangent ? 0 : chord(e, sign);
    derivative_p += factor * (use_tangent ? tangent(e, sign, p) : straight);
    derivative_q += factor * (use_tangent ? tangent(e, sign, q) : straight);
  };
  add(above, high, above_is_convex, 1);
  add(below, low, below_is_concave, -1);
  if (derivative_p >= 0 || derivative_q <= 0) return kNoIntersection;  // the minimum is at p or q
  // Intersect the lines gap_p + derivative_p (z - p) and gap_q - derivative_q (q - z); a derivative can be infinite.
  double along = (gap_q - gap_p - derivative_q * width) / (derivative_p - derivative_q);
  double smallest = gap_p + derivative_p * along;
  if (std::isinf(derivative_p)) {
    along = 0;
    smallest = std::isinf(derivative_q) ? -1 : gap_q - derivative_q * width;
  } else if (std::isinf(derivative_q)) {
    along = width;
    smallest = gap_p + derivative_p * width;
  }
  if (smallest >= 0) return kNoIntersection;
  return p.z + std::fmin(std::fmax(along, 0.1 * width), 0.9 * width);
}

/// The envelope of the curves of one side over an interval of z, as intervals on which one curve is active.
class Envelope {
 public:
  Envelope(const Slice<double>& s, Side side, std::size_t curves, const Node& low, const Node& high,
           std::vector<StripScratch::EnvelopeInterval>& intervals)
      : s_(s), side_(side), curves_(curves), out_(intervals) {
    out_.clear();
    divide(low, active(low), high, active(high), kDepth);
  }

 private:
  Edge edge(std::size_t curve) const { return {static_cast<std::uint8_t>(curve), side_}; }

  std::size_t active(const Node& n) const {
    std::size_t best = 0;
    double at = x_at(s_, edge(0), n);
    for (std::size_t k = 1; k < curves_; ++k) {
      const double x = x_at(s_, edge(k), n);
      if (!(side_ == kLeft ? x > at : x < at)) continue;
      best = k;
      at = x;
    }
    return best;
  }

  /// Divides the interval between the nodes p, where curve i is active, and q, where curve j is active, into intervals
  /// with one active curve each.
  void divide(const Node& p, std::size_t i, const Node& q, std::size_t j, int depth) {
    if (i != j) {
      const Node n = node_at(s_, intersection(s_, edge(i), edge(j), p.z, q.z));
      const std::size_t k = active(n);
      const bool between = k != i && k != j && depth > 0 && n.z > p.z && n.z < q.z;
      divide(p, i, n, between ? k : i, depth - 1);
      divide(n, between ? k : j, q, j, depth - 1);
      return;
    }
    for (std::size_t k = 0; k < curves_ && depth > 0; ++k) {
      if (k == i || !(p.z < q.z)) continue;
      const double z = side_ == kLeft ? possible_intersection(s_, edge(i), edge(k), p, q)
                                      : possible_intersection(s_, edge(k), edge(i), p, q);
      if (!(z > p.z && z < q.z)) continue;
      const Node n = node_at(s_, z);
      const std::size_t between = active(n);
      divide(p, i, n, between, depth - 1);
      divide(n, between, q, i, depth - 1);
      return;
    }
    if (!(p.z < q.z)) return;
    if (!out_.empty() && out_.back().curve == i)
      out_.back().to = q.z;
    else
      out_.push_back({p.z, q.z, static_cast<std::uint8_t>(i)});
  }

  const Slice<double>& s_;
  Side side_;
  std::size_t curves_;
  std::vector<StripScratch::EnvelopeInterval>& out_;
};

StripBound intersection_at(double z, const Edge& first, const Edge& second) {
  return {.z = z, .kind = StripBound::Kind::intersection, .first = first, .second = second};
}

/// A possible bound of a strip, with the values of the curves at its height.
struct Candidate {
  StripBound end;
  Node node;
  bool positive;  ///< true if x of `right` is not below that of `left`
};

/// Appends the strips between p and q on which `right` is not below `left`.
void add_positive(const Slice<double>& s, const Edge& left, const Edge& right, const Candidate& p, const Candidate& q,
                  int depth, std::vector<Strip>& strips) {
  const double low = p.node.z, high = q.node.z;
  if (p.positive != q.positive) {
    const double z = intersection(s, right, left, low, high);
    Candidate middle{intersection_at(z, left, right), node_at(s, z), p.positive};
    add_positive(s, left, right, p, middle, depth, strips);
    middle.positive = q.positive;
    add_positive(s, left, right, middle, q, depth, strips);
    return;
  }
  if (!(low < high)) return;
  const double z = depth == 0   ? low
                   : p.positive ? possible_intersection(s, right, left, p.node, q.node)
                                : possible_intersection(s, left, right, p.node, q.node);
  if (z > low && z < high) {
    // If a strip continues across the height z, `middle` is not a bound of this strip.
    Candidate middle{intersection_at(z, left, left), node_at(s, z), false};
    middle.positive = x_at(s, right, middle.node) >= x_at(s, left, middle.node);
    add_positive(s, left, right, p, middle, depth - 1, strips);
    add_positive(s, left, right, middle, q, depth - 1, strips);
    return;
  }
  if (!p.positive) return;
  const bool continues =
      !strips.empty() && strips.back().to.z == low && strips.back().left == left && strips.back().right == right;
  if (continues)
    strips.back().to = q.end;
  else
    strips.push_back({p.end, q.end, left, right});
}

/// Finds the strips between two heights if only the first `curves` curves bound x.
void find_strips(const Slice<double>& s, std::size_t curves, const StripBound& low, const StripBound& high,
                 StripScratch& scratch, std::vector<Strip>& strips) {
  strips.clear();
  if (!(low.z < high.z)) return;
  const Node bottom = node_at(s, low.z), top = node_at(s, high.z);
  const Envelope left(s, kLeft, curves, bottom, top, scratch.left),
      right(s, kRight, curves, bottom, top, scratch.right);
  Candidate from{low, bottom, false};
  for (std::size_t i = 0, j = 0; i < scratch.left.size() && j < scratch.right.size();) {
    const auto &l = scratch.left[i], &r = scratch.right[j];
    const Edge lower{l.curve, kLeft}, upper{r.curve, kRight};
    StripBound end = high;
    const bool left_ends = l.to <= r.to, right_ends = r.to <= l.to;
    if (left_ends && i + 1 < scratch.left.size())
      end = intersection_at(l.to, lower, {scratch.left[i + 1].curve, kLeft});
    else if (right_ends && j + 1 < scratch.right.size())
      end = intersection_at(r.to, upper, {scratch.right[j + 1].curve, kRight});
    Candidate to{end, end.z == high.z ? top : node_at(s, end.z), false};
    for (Candidate* at : {&from, &to}) at->positive = x_at(s, upper, at->node) >= x_at(s, lower, at->node);
    add_positive(s, lower, upper, from, to, kDepth, strips);
    from = to;
    i += left_ends;
    j += right_ends;
  }
}

/// Subtracts the strips `inner` from `outer`.
void subtract(const std::vector<Strip>& outer, const std::vector<Strip>& inner, std::vector<Strip>& strips) {
  // Returns true if two heights are equal within their accuracy.
  const auto same = [](const StripBound& p, const StripBound& q) {
    return same_type(p, q) && std::fabs(p.z - q.z) < kRootTolerance;
  };
  strips.clear();
  for (const Strip& o : outer) {
    StripBound from = o.from;
    const auto add = [&](const StripBound& to, const Strip* hole) {
      if (!(from.z < to.z) || same(from, to)) return;
      if (!hole) {
        strips.push_back({from, to, o.left, o.right});
      } else {
        if (hole->left.curve == kCurveH) strips.push_back({from, to, o.left, hole->left});
        if (hole->right.curve == kCurveH) strips.push_back({from, to, hole->right, o.right});
      }
      from = to;
    };
    for (const Strip& n : inner) {
      if (n.to.z <= from.z || n.from.z >= o.to.z) continue;
      add(n.from, nullptr);
      add(n.to.z < o.to.z ? n.to : o.to, &n);
    }
    add(o.to, nullptr);
  }
}

/// Indices of the active lower and the active upper bound of z: the maximum of the lower and the minimum of the upper
/// ones.
std::array<std::size_t, 2> active_ends(const Slice<double>& s) {
  const auto low = std::max_element(s.lower.begin(), s.lower.end()),
             high = std::min_element(s.upper.begin(), s.upper.end());
  return {static_cast<std::size_t>(low - s.lower.begin()), static_cast<std::size_t>(high - s.upper.begin())};
}
Decomposition::Hole hole_of(const Slice<double>& s, double low, double high) {
  return s.hole_end > low ? s.hole_end < high ? Decomposition::Hole::below : Decomposition::Hole::all
                          : Decomposition::Hole::none;
}

}  // namespace

bool track(const Slice<double>& s, Decomposition& decomposition) {
  const auto [lower, upper] = active_ends(s);
  const double low = s.lower[lower], high = s.upper[upper];
  if (lower != decomposition.lower || upper != decomposition.upper || hole_of(s, low, high) != decomposition.hole)
    return false;
  // There are no strips whose heights could be updated, although the nearby slice may have some.
  if (decomposition.strips.empty()) return false;
  StripBound from, to;  // bounds of the previous strip before they were updated
  const Strip* before = nullptr;
  const auto follow = [&](StripBound& end) {
    const auto was = [&end](const StripBound& other) { return same_type(end, other) && end.z == other.z; };
    if (before && was(to))
      end.z = before->to.z;
    else if (before && was(from))
      end.z = before->from.z;
    else
      end.z = end.kind == StripBound::Kind::intersection ? intersection_near(s, end.first, end.second, end.z)
                                                         : height(s, end);
  };
  for (Strip& strip : decomposition.strips) {
    const Strip was = strip;
    follow(strip.from);
    follow(strip.to);
    const bool above = !before || strip.from.z >= before->from.z - kRootTolerance;
    if (!(strip.from.z < strip.to.z && strip.from.z >= low && strip.to.z <= high && above)) return false;
    from = was.from;
    to = was.to;
    before = &strip;
  }
  return true;
}

void decompose(const Slice<double>& s, StripScratch& scratch, Decomposition& decomposition) {
  decomposition.strips.clear();
  const auto [lower, upper] = active_ends(s);
  decomposition.lower = lower;
  decomposition.upper = upper;
  const StripBound low = end_of_z(s, StripBound::Kind::lower, lower),
                   high = end_of_z(s, StripBound::Kind::upper, upper);
  decomposition.hole = hole_of(s, low.z, high.z);
  const bool whole = decomposition.hole == Decomposition::Hole::none;
  find_strips(s, kCurveH, low, high, scratch, whole ? decomposition.strips : scratch.outer);
  if (!whole) {
    const StripBound end =
        decomposition.hole == Decomposition::Hole::below ? end_of_z(s, StripBound::Kind::hole) : high;
    find_strips(s, kCurves, low, end, scratch, scratch.inner);
    subtract(scratch.outer, scratch.inner, decomposition.strips);
  }
}

}  // namespace pkm::hybrid
