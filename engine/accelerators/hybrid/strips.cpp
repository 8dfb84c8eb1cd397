#include "engine/accelerators/hybrid/strips.hpp"

#include <algorithm>
#include <cmath>

#include "engine/accelerators/hybrid/intersections.hpp"

namespace pkm::hybrid {
namespace {

constexpr int kDepth = 16;  // of cuts: what could hide in 2^-16 of a range changes areas by some 1e-15

constexpr double kSearches = 1e-13;  // m, of heights found by different searches

/// All curves' roots at one height.
struct Node {
  double z;
  std::array<double, kCurves> root;
};

Node node_at(const Section<double>& s, double z) {
  Node n{.z = z, .root = {}};
  for (std::size_t k = 0; k < kCurves; ++k) n.root[k] = s.curve[k].root(z);
  return n;
}

double place(const Section<double>& s, const Edge& e, const Node& n) {
  return s.constant(e) + n.root[e.curve] * s.sign(e);
}

/// Where `above` may come down to `below` between two heights at which it is not below it: at that height its least
/// bound is negative; NaN: it stays above. A convex function lies above its tangents, a concave one above its chord.
double may_meet(const Section<double>& s, const Edge& above, const Edge& below, const Node& p, const Node& q) {
  if (of_chain(above, below)) return kNowhere;
  const double high = s.sign(above), low = s.sign(below);
  const bool high_bends = high<0, low_bends = low> 0;  // convex, and the other concave
  const double width = q.z - p.z, gap_p = place(s, above, p) - place(s, below, p),
               gap_q = place(s, above, q) - place(s, below, q);
  if (!high_bends && !low_bends) return kNowhere;
  const auto chord = [&](const Edge& e, double sign) { return sign * (q.root[e.curve] - p.root[e.curve]) / width; };
  const auto tangent = [&](const Edge& e, double sign, const Node& n) {
    return sign * s.curve[e.curve].slope(n.z, n.root[e.curve]);
  };
  double slope_p = 0, slope_q = 0;
  const auto add = [&](const Edge& e, double sign, bool bends, double factor) {
    const double straight = bends ? 0 : chord(e, sign);
    slope_p += factor * (bends ? tangent(e, sign, p) : straight);
    slope_q += factor * (bends ? tangent(e, sign, q) : straight);
  };
  add(above, high, high_bends, 1);
  add(below, low, low_bends, -1);
  if (slope_p >= 0 || slope_q <= 0) return kNowhere;  // rises from p, or falls to q
  // the two lines gap_p + slope_p (z - p) and gap_q - slope_q (q - z) meet; a slope may be infinite
  double along = (gap_q - gap_p - slope_q * width) / (slope_p - slope_q);
  double least = gap_p + slope_p * along;
  if (std::isinf(slope_p)) {
    along = 0;
    least = std::isinf(slope_q) ? -1 : gap_q - slope_q * width;
  } else if (std::isinf(slope_q)) {
    along = width;
    least = gap_p + slope_p * width;
  }
  if (least >= 0) return kNowhere;
  return p.z + std::fmin(std::fmax(along, 0.1 * width), 0.9 * width);
}

/// The curves of one side in force over a range of z.
class Envelope {
 public:
  Envelope(const Section<double>& s, Side side, std::size_t curves, const Node& low, const Node& high,
           std::vector<StripScratch::Stretch>& stretches)
      : s_(s), side_(side), curves_(curves), out_(stretches) {
    out_.clear();
    cut(low, in_force(low), high, in_force(high), kDepth);
  }

 private:
  Edge edge(std::size_t curve) const { return {static_cast<std::uint8_t>(curve), side_}; }

  std::size_t in_force(const Node& n) const {
    std::size_t best = 0;
    double at = place(s_, edge(0), n);
    for (std::size_t k = 1; k < curves_; ++k) {
      const double x = place(s_, edge(k), n);
      if (!(side_ == kLeft ? x > at : x < at)) continue;
      best = k;
      at = x;
    }
    return best;
  }

  /// From p, where curve i is in force, to q, where j is.
  void cut(const Node& p, std::size_t i, const Node& q, std::size_t j, int depth) {
    if (i != j) {
      const Node n = node_at(s_, meeting(s_, edge(i), edge(j), p.z, q.z));
      const std::size_t k = in_force(n);
      const bool between = k != i && k != j && depth > 0 && n.z > p.z && n.z < q.z;
      cut(p, i, n, between ? k : i, depth - 1);
      cut(n, between ? k : j, q, j, depth - 1);
      return;
    }
    for (std::size_t k = 0; k < curves_ && depth > 0; ++k) {
      if (k == i || !(p.z < q.z)) continue;
      const double z = side_ == kLeft ? may_meet(s_, edge(i), edge(k), p, q) : may_meet(s_, edge(k), edge(i), p, q);
      if (!(z > p.z && z < q.z)) continue;
      const Node n = node_at(s_, z);
      const std::size_t between = in_force(n);
      cut(p, i, n, between, depth - 1);
      cut(n, between, q, i, depth - 1);
      return;
    }
    if (!(p.z < q.z)) return;
    if (!out_.empty() && out_.back().curve == i)
      out_.back().to = q.z;
    else
      out_.push_back({p.z, q.z, static_cast<std::uint8_t>(i)});
  }

  const Section<double>& s_;
  Side side_;
  std::size_t curves_;
  std::vector<StripScratch::Stretch>& out_;
};

StripEnd meeting_at(double z, const Edge& first, const Edge& second) {
  return {.z = z, .kind = StripEnd::Kind::meeting, .first = first, .second = second};
}

/// An end of a strip and the curves there.
struct Place {
  StripEnd end;
  Node node;
  bool positive;  ///< `right` is not left of `left`
};

/// Appends the parts between p and q on which `right` is right of `left`.
void add_positive(const Section<double>& s, const Edge& left, const Edge& right, const Place& p, const Place& q,
                  int depth, std::vector<Strip>& strips) {
  const double low = p.node.z, high = q.node.z;
  if (p.positive != q.positive) {
    const double z = meeting(s, right, left, low, high);
    Place middle{meeting_at(z, left, right), node_at(s, z), p.positive};
    add_positive(s, left, right, p, middle, depth, strips);
    middle.positive = q.positive;
    add_positive(s, left, right, middle, q, depth, strips);
    return;
  }
  if (!(low < high)) return;
  const double z = depth == 0   ? low
                   : p.positive ? may_meet(s, right, left, p.node, q.node)
                                : may_meet(s, left, right, p.node, q.node);
  if (z > low && z < high) {
    Place middle{meeting_at(z, left, left), node_at(s, z), false};  // no end, if the strip goes on
    middle.positive = place(s, right, middle.node) >= place(s, left, middle.node);
    add_positive(s, left, right, p, middle, depth - 1, strips);
    add_positive(s, left, right, middle, q, depth - 1, strips);
    return;
  }
  if (!p.positive) return;
  const bool goes_on =
      !strips.empty() && strips.back().to.z == low && strips.back().left == left && strips.back().right == right;
  if (goes_on)
    strips.back().to = q.end;
  else
    strips.push_back({p.end, q.end, left, right});
}

/// Strips between two heights from the first `curves` curves.
void find_plain_strips(const Section<double>& s, std::size_t curves, const StripEnd& low, const StripEnd& high,
                       StripScratch& scratch, std::vector<Strip>& strips) {
  strips.clear();
  if (!(low.z < high.z)) return;
  const Node bottom = node_at(s, low.z), top = node_at(s, high.z);
  const Envelope left(s, kLeft, curves, bottom, top, scratch.left),
      right(s, kRight, curves, bottom, top, scratch.right);
  Place from{low, bottom, false};
  for (std::size_t i = 0, j = 0; i < scratch.left.size() && j < scratch.right.size();) {
    const auto &l = scratch.left[i], &r = scratch.right[j];
    const Edge lower{l.curve, kLeft}, upper{r.curve, kRight};
    StripEnd end = high;
    const bool left_ends = l.to <= r.to, right_ends = r.to <= l.to;
    if (left_ends && i + 1 < scratch.left.size())
      end = meeting_at(l.to, lower, {scratch.left[i + 1].curve, kLeft});
    else if (right_ends && j + 1 < scratch.right.size())
      end = meeting_at(r.to, upper, {scratch.right[j + 1].curve, kRight});
    Place to{end, end.z == high.z ? top : node_at(s, end.z), false};
    for (Place* at : {&from, &to}) at->positive = place(s, upper, at->node) >= place(s, lower, at->node);
    add_positive(s, lower, upper, from, to, kDepth, strips);
    from = to;
    i += left_ends;
    j += right_ends;
  }
}

/// Takes the columns of `inner` out of those of `outer`.
void take_out(const std::vector<Strip>& outer, const std::vector<Strip>& inner, std::vector<Strip>& strips) {
  const auto same = [](const StripEnd& p, const StripEnd& q) {  // but for the rounding of either search
    return alike(p, q) && std::fabs(p.z - q.z) < kSearches;
  };
  strips.clear();
  for (const Strip& o : outer) {
    StripEnd from = o.from;
    const auto add = [&](const StripEnd& to, const Strip* hole) {
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

/// The ends of z in force, as numbers of the lower and the upper one.
std::array<std::size_t, 2> ends_in_force(const Section<double>& s) {
  const auto low = std::max_element(s.lower.begin(), s.lower.end()),
             high = std::min_element(s.upper.begin(), s.upper.end());
  return {static_cast<std::size_t>(low - s.lower.begin()), static_cast<std::size_t>(high - s.upper.begin())};
}
Structure::Hole hole_of(const Section<double>& s, double low, double high) {
  return s.hole_end > low ? s.hole_end < high ? Structure::Hole::below : Structure::Hole::all : Structure::Hole::none;
}

}  // namespace

bool follow_strips(const Section<double>& s, Structure& structure) {
  const auto [lower, upper] = ends_in_force(s);
  const double low = s.lower[lower], high = s.upper[upper];
  if (lower != structure.lower || upper != structure.upper || hole_of(s, low, high) != structure.hole) return false;
  if (structure.strips.empty()) return false;  // of a gap that no break is known of: there are strips beyond it
  StripEnd from, to;                           // of the strip before, where it was
  const Strip* before = nullptr;
  const auto follow = [&](StripEnd& end) {
    const auto was = [&end](const StripEnd& other) { return alike(end, other) && end.z == other.z; };
    if (before && was(to))
      end.z = before->to.z;
    else if (before && was(from))
      end.z = before->from.z;
    else
      end.z = end.kind == StripEnd::Kind::meeting ? meeting_near(s, end.first, end.second, end.z) : height(s, end);
  };
  for (Strip& strip : structure.strips) {
    const Strip was = strip;
    follow(strip.from);
    follow(strip.to);
    const bool above = !before || strip.from.z >= before->from.z - kSearches;
    if (!(strip.from.z < strip.to.z && strip.from.z >= low && strip.to.z <= high && above)) return false;
    from = was.from;
    to = was.to;
    before = &strip;
  }
  return true;
}

void find_strips(const Section<double>& s, StripScratch& scratch, Structure& structure) {
  structure.strips.clear();
  const auto [lower, upper] = ends_in_force(s);
  structure.lower = lower;
  structure.upper = upper;
  const StripEnd low = end_of_z(s, StripEnd::Kind::lower, lower), high = end_of_z(s, StripEnd::Kind::upper, upper);
  structure.hole = hole_of(s, low.z, high.z);
  const bool whole = structure.hole == Structure::Hole::none;
  find_plain_strips(s, kCurveH, low, high, scratch, whole ? structure.strips : scratch.outer);
  if (!whole) {
    const StripEnd end = structure.hole == Structure::Hole::below ? end_of_z(s, StripEnd::Kind::hole) : high;
    find_plain_strips(s, kCurves, low, end, scratch, scratch.inner);
    take_out(scratch.outer, scratch.inner, structure.strips);
  }
}

}  // namespace pkm::hybrid
