#include "engine/accelerators/four_ppa_two_par/clearance.hpp"

#include <limits>

namespace pkm::four_ppa_two_par {
namespace {

/// Returns true for the groups of lower bars and lower connectors. The links of all other groups of a limb are in the
/// plane of its rail.
bool is_lower(int group) {
  const int kind = group % kGroupsPerLimb;
  return group != kPlatform && (kind == kLowerBars || kind == kLowerConnector);
}

/// True if a change of z moves the links of a group relative to those of all other groups: sliders and upper bars.
bool moves(int group) {
  const int kind = group % kGroupsPerLimb;
  return group != kPlatform && (kind == kSliders || kind == kUpperBars);
}

double radius(const Geometry<double>& g, int group) {
  if (group == kPlatform) return g.R_p;
  if (is_lower(group)) return g.R_d;
  return group % kGroupsPerLimb == kSliders ? g.R_s : g.R_u;
}

/// True if the clearance between two groups is the same at every pose, and therefore equals its lower bound. If it is
/// too small, no pose satisfies the limit.
bool is_constant(const Geometry<double>& g, const GroupPair& pair) {
  if (pair.first == kPlatform) return is_lower(pair.second) && g.d_d <= g.d;
  return pair.first == group_of(0, kLowerConnector) && pair.second == group_of(1, kLowerConnector);
}

Bounds<double> bounds_of_group(const Links<double>& all, int group) {
  const GroupRange range = links_of(group);
  Bounds<double> box = bounds_of(all[range.first].axis);
  for (std::size_t i = range.first + 1; i < range.end; ++i) box = joined(box, all[i].axis);
  return box;
}

}  // namespace

double clearance_lower_bound(const Geometry<double>& g, const GroupPair& pair) {
  const double radii = radius(g, pair.first) + radius(g, pair.second);
  const bool lower_1 = is_lower(pair.first), lower_2 = is_lower(pair.second);
  double axes;
  if (pair.first == kPlatform)
    axes = lower_2 ? std::fmax(0.0, g.d - g.d_d) : std::sqrt(g.l_d * g.l_d + g.d * g.d);
  else if (lower_1 && lower_2)
    axes = g.a;
  else if (!lower_1 && !lower_2)
    axes = g.b;
  else {
    const double s = std::fmax(0.0, (g.b - g.a) / g.l_d);
    axes = s * s >= 2 ? g.l_d : g.l_d * s * std::sqrt(1 - s * s / 4);
  }
  return axes - radii;
}

ClearanceTest::ClearanceTest(const Geometry<double>& g, double min_clearance) : g_(g), min_clearance_(min_clearance) {
  const double infinity = std::numeric_limits<double>::infinity();
  // The segments of two sliders are 2 h - 2 (d_0 + d_u/2 - R_s) apart, or overlap; they are points if
  // R_s > d_0 + d_u/2.
  if (min_clearance > -2 * g.R_s) h_min_ = std::fmax(0.0, std::fmax(g.d_0 + g.d_u / 2, g.R_s) + min_clearance / 2);
  const double below = g.d_d - g.d;  // depth of the point E_j below the platform
  for (const GroupPair& pair : kPairs) {
    if (pair.first == pair.second || clearance_lower_bound(g, pair) >= min_clearance) continue;
    const bool platform_and_lower = pair.first == kPlatform && is_lower(pair.second);
    if (is_constant(g, pair)) {
      h_min_ = infinity;
    } else if (platform_and_lower && below <= g.l_d) {
      const double radii = min_clearance + g.R_p + g.R_d;
      // If radii > d, no pose satisfies the limit, because the point D_j is only d above the platform.
      if (radii > g.d) h_min_ = infinity;
      sin_beta_min_ = radii / below;
    } else {
      (moves(pair.first) || moves(pair.second) ? moving_pairs_ : suspended_pairs_).push_back(pair);
    }
  }
  if (h_min_ < infinity && sin_beta_min_ <= 1) return;
  h_min_ = infinity;
  suspended_pairs_.clear();
  moving_pairs_.clear();
}

double ClearanceTest::excess(const Placement<double>& p) const {
  return std::fmin(excess(p, suspended_pairs_), excess(p, moving_pairs_));
}

double ClearanceTest::excess(const Placement<double>& p, const std::vector<GroupPair>& pairs) const {
  double smallest = std::numeric_limits<double>::infinity();
  if (pairs.empty()) return smallest;
  const Links<double> all = links(g_, p);
  std::array<Bounds<double>, kGroups> box;
  for (int group = 0; group < kGroups; ++group) box[static_cast<std::size_t>(group)] = bounds_of_group(all, group);
  for (const GroupPair& pair : pairs) {
    const double radii = radius(g_, pair.first) + radius(g_, pair.second);
    const double bound =
        distance_of_bounds(box[static_cast<std::size_t>(pair.first)], box[static_cast<std::size_t>(pair.second)]) -
        radii;
    if (bound >= min_clearance_)
      smallest = std::fmin(smallest, bound);
    else
      visit_links(pair, [&](std::size_t i, std::size_t k) {
        smallest = std::fmin(smallest, segment_distance(all[i].axis, all[k].axis) - radii);
      });
  }
  return smallest - min_clearance_;
}

Placement<double> ClearanceTest::place(const SlicedDesign<double>& d, const Slice<double>& t,
                                       const Column<double>& column, double rise) const {
  Placement<double> p{.sin_theta = t.sin_theta, .x = column.x, .drop = column.sigma, .z_c = {}, .h = {}};
  for (std::size_t j = 0; j < 2; ++j) {
    p.z_c[j] = column.z_c(d, rise, j);
    p.h[j] = sqrt_or_zero((g_.l_u - p.z_c[j]) * (g_.l_u + p.z_c[j]));
  }
  return p;
}

const std::vector<ClosedInterval>& ClearanceTest::clear_deltas(const SlicedDesign<double>& d, const Slice<double>& t,
                                                               const HalfSlice<double>& h, std::size_t leaning,
                                                               double low, double high,
                                                               ClearanceScratch& scratch) const {
  scratch.clear.clear();
  if (suspended_pairs_.empty()) {
    if (low < high) scratch.clear.push_back({low, high});
    return scratch.clear;
  }
  const auto excess_at = [&](double delta) {
    return excess(place(d, t, column(d, t, h, leaning, delta), 0), suspended_pairs_);
  };
  // Per unit of delta at given theta, D_1 and D_2 keep their distance and C_j rotates about D_j by d(beta_j), with
  // d(beta_leaning) = cos(beta_other) / (l_d sin 2p), d(beta_other) = -cos(beta_leaning) / (l_d sin 2p). So the
  // relative displacement of suspended links is at most (cos(beta_1) + cos(beta_2)) / sin 2p <= 1 / sin p.
  const auto lipschitz = [&](double from, double) { return 1 / chord(d, t, from).sin_p; };
  scratch.finder.find(excess_at, lipschitz, low, high, scratch.clear);
  return scratch.clear;
}

const std::vector<ClosedInterval>& ClearanceTest::clear_heights(const SlicedDesign<double>& d, const Slice<double>& t,
                                                                const Column<double>& column,
                                                                ClearanceScratch& scratch) const {
  scratch.clear.clear();
  if (moving_pairs_.empty()) {
    if (column.length > 0) scratch.clear.push_back({0, column.length});
    return scratch.clear;
  }
  const auto excess_at = [&](double rise) { return excess(place(d, t, column, rise), moving_pairs_); };
  // Per unit of z, C_j rises by 1 and the sliders move apart by -z_cj/h_j: the relative displacement of two points of a
  // pair of links is at most l_u/h_1 + l_u/h_2, and h increases with z.
  const auto lipschitz = [&](double from, double) {
    const Placement<double> p = place(d, t, column, from);
    return g_.l_u / p.h[0] + g_.l_u / p.h[1];
  };
  scratch.finder.find(excess_at, lipschitz, 0, column.length, scratch.clear);
  return scratch.clear;
}

std::optional<ClearanceTest> reduce_clearance(const Geometry<double>& g, Limits<double>& l) {
  if (!l.clearance_min) return {};
  ClearanceTest test(g, *l.clearance_min);
  l.clearance_min.reset();
  l.h_min = std::fmax(l.h_min, test.h_min());
  if (const double sine = test.sin_beta_min(); sine > l.sin_beta_min) {
    l.sin_beta_min = sine;
    l.cos_beta_min = sqrt_or_zero((1 - sine) * (1 + sine));
  }
  if (test.complete()) return {};
  return test;
}

}  // namespace pkm::four_ppa_two_par
