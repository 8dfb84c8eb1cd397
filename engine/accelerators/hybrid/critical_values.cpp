#include "engine/accelerators/hybrid/critical_values.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/roots.hpp"

namespace pkm::hybrid {
namespace {

/// The degeneracy at which a strip vanishes: its bounds coincide, or, if both are intersections of the same two edges,
/// the edges become tangent.
Degeneracy vanishing_strip(const Strip& strip) {
  const StripBound &p = strip.from, &q = strip.to;
  const bool same = (p.first == q.first && p.second == q.second) || (p.first == q.second && p.second == q.first);
  const bool tangent = p.kind == StripBound::Kind::intersection && q.kind == p.kind && same;
  return {.kind = tangent ? Degeneracy::Kind::tangency : Degeneracy::Kind::heights,
          .first = p,
          .second = q,
          .left = p.first,
          .right = p.second};
}

/// Finds the degeneracy at which the type of the slice changes between two samples; std::nullopt if none is identified.
std::optional<Degeneracy> find_degeneracy(const SampledSlice& lower, const SampledSlice& upper) {
  using Kind = StripBound::Kind;
  const Slice<double>&s = lower.slice, &t = upper.slice;
  const Decomposition &below = lower.decomposition, &above = upper.decomposition;
  const StripBound low = end_of_z(s, Kind::lower, below.lower), high = end_of_z(s, Kind::upper, below.upper),
                   hole = end_of_z(s, Kind::hole);
  const auto heights = [](const StripBound& first, const StripBound& second) {
    return Degeneracy{Degeneracy::Kind::heights, first, second};
  };
  // Returns true if two bounds have different orders in the two samples.
  const auto changes = [&](const StripBound& first, const StripBound& second) {
    const Degeneracy candidate = heights(first, second);
    return (distance(s, candidate) >= 0) != (distance(t, candidate) >= 0);
  };
  if (below.lower != above.lower) return heights(low, end_of_z(s, Kind::lower, above.lower));
  if (below.upper != above.upper) return heights(high, end_of_z(s, Kind::upper, above.upper));
  if (changes(low, high)) return heights(low, high);
  if (changes(low, hole)) return heights(low, hole);
  if (hole.z > low.z && changes(hole, high)) return heights(hole, high);
  for (const StripBound& at : {low, high, hole}) {
    if (at.z < low.z || at.z > high.z) continue;
    std::array<Edge, kSides * kCurves> edge;
    std::array<double, kSides * kCurves> in_s, in_t;
    for (std::size_t k = 0; k < edge.size(); ++k) {
      edge[k] = {static_cast<std::uint8_t>(k / kSides), static_cast<Side>(k % kSides)};
      in_s[k] = edge_at_end(s, edge[k], at);
      in_t[k] = edge_at_end(t, edge[k], at);
    }
    for (std::size_t i = 0; i < edge.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if ((in_s[i] >= in_s[j]) == (in_t[i] >= in_t[j])) continue;
        // The edges -x and x of one curve of the auxiliary chain intersect only where the square root in the formula of
        // the curve vanishes.
        const bool opposite = edge[j].curve >= kCurveQ && edge[i].curve >= kCurveQ && edge[i].side != edge[j].side;
        if (!opposite)
          return Degeneracy{.kind = Degeneracy::Kind::edges, .first = at, .left = edge[j], .right = edge[i]};
      }
  }
  // If none of these degeneracies has been found, a strip vanishes: the shortest strip that exists in only one of the
  // two samples. Strips whose pair of edges bounds no strip in the other sample are preferred, because any other strip
  // may exist in both samples with different bounds.
  std::optional<Degeneracy> found;
  double shortest = std::numeric_limits<double>::infinity();
  const auto find_vanishing = [&](const Decomposition& here, const Decomposition& there, const auto& same) {
    for (const Strip& strip : here.strips) {
      const bool stays = std::ranges::any_of(there.strips, [&](const Strip& of) { return same(of, strip); });
      if (stays || strip.to.z - strip.from.z >= shortest) continue;
      shortest = strip.to.z - strip.from.z;
      found = vanishing_strip(strip);
    }
  };
  const auto same_edges = [](const Strip& p, const Strip& q) { return p.left == q.left && p.right == q.right; };
  const auto same_strip = [](const Strip& p, const Strip& q) { return same_type(p, q); };
  find_vanishing(below, above, same_edges);
  find_vanishing(above, below, same_edges);
  if (found) return found;
  find_vanishing(below, above, same_strip);
  find_vanishing(above, below, same_strip);
  return found;
}

/// Returns true if the intersections in a degeneracy belong to a sample, i.e. if each of them is a bound of one of the
/// sample's strips.
bool has_heights(const SampledSlice& sample, const Degeneracy& degeneracy) {
  const auto has = [&](const StripBound& end) {
    return end.kind != StripBound::Kind::intersection ||
           std::ranges::any_of(sample.decomposition.strips,
                               [&](const Strip& s) { return s.from.z == end.z || s.to.z == end.z; });
  };
  return degeneracy.kind == Degeneracy::Kind::edges || (has(degeneracy.first) && has(degeneracy.second));
}

/// The x of an edge as a function of z: value, first and second derivative with respect to z. The value and the first
/// derivative also have derivatives with respect to beta.
struct EdgeDerivatives {
  Dual<1> x, derivative;
  double curvature;
};
EdgeDerivatives edge_derivatives(const Slice<Dual<1>>& s, const Edge& edge, double z) {
  const Curve<Dual<1>>& c = s.curve[edge.curve];
  const Dual<1> root = c.root(z), derivative = c.derivative(z, root);
  const double sign = s.sign(edge);
  return {s.constant(edge) + root * sign, derivative * sign,
          sign * (value_of(c.curvature()) - derivative.a * derivative.a) / root.a};
}

/// The height (z) of a bound of a strip, with its derivative with respect to beta. The height of an intersection is
/// improved by one Newton step.
Dual<1> newton_height(const Slice<Dual<1>>& s, const StripBound& end) {
  if (end.kind != StripBound::Kind::intersection) return height(s, end);
  const EdgeDerivatives first = edge_derivatives(s, end.first, end.z), second = edge_derivatives(s, end.second, end.z);
  return end.z - (second.x - first.x) / (second.derivative.a - first.derivative.a);
}

/// Performs one step of Newton's method for a degeneracy, in beta and in the heights of intersections.
/// @return the step in beta
double newton_step(const Slice<Dual<1>>& s, Degeneracy& degeneracy) {
  if (degeneracy.kind == Degeneracy::Kind::edges) {
    const Dual<1> difference = distance(s, degeneracy);
    return -difference.a / difference.v[0];
  }
  if (degeneracy.kind == Degeneracy::Kind::heights) {
    const Dual<1> first = newton_height(s, degeneracy.first), second = newton_height(s, degeneracy.second),
                  difference = second - first;
    const double step = -difference.a / difference.v[0];
    degeneracy.first.z = first.a + first.v[0] * step;
    degeneracy.second.z = second.a + second.v[0] * step;
    return step;
  }
  // At a tangency, the distance of the edges and its derivative with respect to z are 0.
  const EdgeDerivatives left = edge_derivatives(s, degeneracy.left, degeneracy.first.z),
                        right = edge_derivatives(s, degeneracy.right, degeneracy.first.z);
  const Dual<1> difference = right.x - left.x, derivative = right.derivative - left.derivative;
  const double curvature = right.curvature - left.curvature,
               determinant = difference.v[0] * curvature - derivative.a * derivative.v[0];
  degeneracy.first.z += (derivative.v[0] * difference.a - difference.v[0] * derivative.a) / determinant;
  return (derivative.a * derivative.a - curvature * difference.a) / determinant;
}

/// Finds a degeneracy between two values of beta by Newton's method.
/// @param width  a step smaller than this ends the iteration, because the next one would be below rounding
/// @param beta   initial value, and result
/// @return false if the iteration does not converge
bool refine(const SlicedDesign<Dual<1>>& by_beta, double lower, double upper, double width, double& beta,
            Degeneracy& degeneracy) {
  if (degeneracy.kind == Degeneracy::Kind::tangency)
    degeneracy.first.z = 0.5 * (degeneracy.first.z + degeneracy.second.z);
  constexpr int kMaxSteps = 12;
  const auto step = [&](double at) { return newton_step(slice(by_beta, Dual<1>::variable(at, 0)), degeneracy); };
  const NewtonResult found =
      iterate_newton(step, beta, lower, upper, kMaxSteps, [&](double, double last) { return std::fabs(last) < width; });
  beta = found.x;
  return found.has_converged;
}

class CriticalValueSearch {
 public:
  CriticalValueSearch(const SlicedDesign<double>& plain, const SlicedDesign<Dual<1>>& by_beta,
                      CriticalValueScratch& scratch)
      : design_(plain), by_beta_(by_beta), scratch_(scratch) {
    constexpr std::size_t kSamples = 192;  // number of samples of beta; narrower components and gaps can be missed
    const double low = plain.l.beta_min, high = plain.l.beta_max;
    scratch_.count = 0;
    range_ = high - low;
    if (plain.empty || !(range_ > 0)) return;
    offset_ = 1e-7 * range_;
    used_ = 2;  // elements 0 and 1 of the samples are the adjacent samples of this loop
    fill(low + offset_, sample_number(0));
    begin(low, {}, sample_number(0));
    for (std::size_t k = 1; k <= kSamples; ++k) {
      const SampledSlice &before = sample_number((k - 1) % 2), &next = sample_number(k % 2);
      fill(k == kSamples ? high - offset_ : low + range_ * (static_cast<double>(k) / kSamples), sample_number(k % 2));
      bisect(before, next, kDepth);
    }
    end(high, {});
  }

 private:
  static constexpr int kDepth = 60;

  SampledSlice& sample_number(std::size_t i) {
    while (scratch_.samples.size() <= i) scratch_.samples.emplace_back();
    return scratch_.samples[i];
  }
  void fill(double beta, SampledSlice& s) {
    s.beta = beta;
    s.slice = slice(design_, beta);
    decompose(s.slice, scratch_.strips, s.decomposition);
  }
  const SampledSlice& sample(double beta) {
    SampledSlice& s = sample_number(used_++);
    fill(beta, s);
    return s;
  }

  /// Begins an interval of beta, given a sampled slice slightly above its lower endpoint.
  void begin(double at, const std::optional<Degeneracy>& degeneracy, const SampledSlice& above) {
    open_ = !above.decomposition.strips.empty();
    if (!open_) return;
    if (scratch_.count == scratch_.intervals.size()) scratch_.intervals.emplace_back();
    BetaInterval& s = scratch_.intervals[scratch_.count++];
    s.lower = at;
    s.at_lower = degeneracy;
    s.decomposition = above.decomposition;
  }
  void end(double at, const std::optional<Degeneracy>& degeneracy) {
    if (!open_) return;
    BetaInterval& s = scratch_.intervals[scratch_.count - 1];
    s.upper = at;
    s.at_upper = degeneracy;
  }

  /// Finds all critical values of beta between two samples, recursively.
  void bisect(const SampledSlice& low, const SampledSlice& high, int depth) {
    if (same_type(low.decomposition, high.decomposition)) return;
    const double length = high.beta - low.beta;
    if (!(length > 1e-10 * range_) || depth == 0) {
      const double at = 0.5 * (low.beta + high.beta);
      end(at, {});
      begin(at, {}, high);
      return;
    }
    const std::size_t used = used_;
    std::optional<Degeneracy> degeneracy = find_degeneracy(low, high);
    double at;
    if (!degeneracy || !find_critical_value(low, high, *degeneracy, at)) {
      const SampledSlice& middle = sample(0.5 * (low.beta + high.beta));
      bisect(low, middle, depth - 1);
      bisect(middle, high, depth - 1);
      used_ = used;
      return;
    }
    const double beside = std::fmin(offset_, 0.1 * length);
    const SampledSlice& below = at - beside > low.beta ? sample(at - beside) : low;
    const SampledSlice& above = at + beside < high.beta ? sample(at + beside) : high;
    bisect(low, below, depth - 1);
    if (!same_type(below.decomposition, above.decomposition)) {
      end(at, degeneracy);
      begin(at, degeneracy, above);
    }
    bisect(above, high, depth - 1);
    used_ = used;
  }

  bool find_critical_value(const SampledSlice& low, const SampledSlice& high, Degeneracy& degeneracy,
                           double& at) const {
    const auto residual = [&](const SampledSlice& s) {
      return has_heights(s, degeneracy) ? std::fabs(distance(s.slice, degeneracy))
                                        : std::numeric_limits<double>::infinity();
    };
    at = (residual(low) < residual(high) ? low : high).beta;
    return refine(by_beta_, low.beta, high.beta, 1e-9 * range_, at, degeneracy);
  }

  const SlicedDesign<double>& design_;
  const SlicedDesign<Dual<1>>& by_beta_;
  CriticalValueScratch& scratch_;
  double range_ = 0, offset_ = 0;
  std::size_t used_ = 0;
  bool open_ = false;
};

}  // namespace

void find_beta_intervals(const SlicedDesign<double>& plain, const SlicedDesign<Dual<1>>& by_beta,
                         CriticalValueScratch& scratch) {
  CriticalValueSearch(plain, by_beta, scratch);
}

}  // namespace pkm::hybrid
