#include "engine/generic/corner_curves/integral.hpp"

#include <algorithm>

#include "engine/generic/conic.hpp"
#include "engine/math/portable.hpp"

namespace pkm::generic::corner_curves {
namespace {

constexpr std::size_t kRule = NestedRule::kNodes;

/// Angle in [0, 2 pi) of a point p of a circle, counted from the direction of the circle's cut.
double angle_of(const CurveAt& circle, const std::array<double, 2>& cut, const Vector& p) {
  const double x = p.x - circle.u, y = p.y - circle.w;
  const double angle = portable::atan2(cut[0] * y - cut[1] * x, cut[0] * x + cut[1] * y);
  return angle < 0 ? angle + 2 * kPi : angle;
}

/// The arc of a conic from the coordinate axis to the point p, as a graph of the root s of P(t, s) over t, where (t, s)
/// is (x, y), or (y, x) if the conic swaps them.
struct ConicArc {
  Conic P;
  Arc arc;

  ConicArc(const CurveAt& curve, const Vector& p) {
    const double t = curve.swaps ? p.y : p.x, s = curve.swaps ? p.x : p.y;
    P.c = curve.swaps ? std::array{curve.c, curve.w, curve.u, curve.yy, curve.xy, curve.xx}
                      : std::array{curve.c, curve.u, curve.w, curve.xx, curve.xy, curve.yy};
    for (const double each : P.c) P.scale += std::fabs(each);
    const double middle = -(P.c[2] + t * P.c[4]);  // the sum of both roots times c[5]
    arc = {(P.c[5] > 0) == (2 * P.c[5] * s > middle) ? 1 : 0, 0, t};
  }
};

/// Integral of (x dy - y dx)/2 along a curve up to the point p. @param angle  angle_of() the point on a circle
double potential(const CurveAt& curve, const Vector& p, double angle) {
  if (curve.is_conic) {
    const ConicArc conic(curve, p);
    const double below = area_below(conic.P, conic.arc) - 0.5 * p.x * p.y;
    return curve.swaps ? below : -below;
  }
  if (curve.is_circle) return 0.5 * (curve.u * p.y - curve.w * p.x + curve.c * angle);
  return -0.5 * curve.c * (curve.u * p.y - curve.w * p.x);
}

/// Derivatives of the area with respect to the functions u, w and c of a curve (of a conic also xx, xy and yy, see
/// CurveAt), as integrals along the curve up to the point p.
std::array<double, 6> potential_derivatives(const CurveAt& curve, const Vector& p, double angle) {
  if (curve.is_circle) return {p.y - curve.w, curve.u - p.x, 0.5 * angle};
  if (curve.is_conic) {
    const ConicArc conic(curve, p);
    std::array<double, 6> by{};
    add_gradient_of_area(conic.P, conic.arc, curve.swaps ? 1 : -1, by);
    return curve.swaps ? std::array{by[2], by[1], by[0], by[5], by[4], by[3]}
                       : std::array{by[1], by[2], by[0], by[3], by[4], by[5]};
  }
  const double l = curve.w * p.x - curve.u * p.y;  // coordinate of p along the line, in the direction (w, -u)
  return {l * (-curve.c * curve.u + 0.5 * l * curve.w), l * (-curve.c * curve.w - 0.5 * l * curve.u), l};
}

/// Direction from which angles on the circle with the index i are counted, i.e. of its cut. The cuts are behind all
/// other curves, in the order of the circles.
std::array<double, 2> cut_of(const std::vector<BoundaryCurve>& curves, std::size_t i) {
  if (!curves[i].is_circle()) return {1, 0};
  std::size_t at = 0;
  while (curves[at].kind != BoundaryCurve::Kind::cut) ++at;
  for (std::size_t k = 0; k < i; ++k) at += curves[k].is_circle();
  return {-curves[at].values[1][0], curves[at].values[0][0]};
}

/// The two curves of an active range, and their crossing, at the nodes of the Kronrod rule in a subinterval of the
/// range.
class CellCurves {
 public:
  CellCurves(const SegmentIntegral& segment, const ActiveRange& range, const RangeCell& cell)
      : first_(segment.curves[range.first]),
        second_(segment.curves[range.second]),
        cuts_{cut_of(segment.curves, range.first),
              is_cut() ? std::array<double, 2>{} : cut_of(segment.curves, range.second)},
        branch_(range.branch),
        path_(range.path < 0 ? nullptr : &segment.decomposition.paths[static_cast<std::size_t>(range.path)]) {
    for (std::size_t q = 0; q < kRule; ++q) tau_[q] = map_node(cell.interval, kronrod_rule().node[q]).point;
    for (const std::size_t k : {0, 1}) {
      if (k == 1 && is_cut()) break;
      const BoundaryCurve& curve = k == 0 ? first_ : second_;
      evaluate_at_points(curve.series, curve.terms, tau_.data(), values_[k].data());
      if (curve.is_conic()) evaluate_at_points(curve.quadratic->series, curve.terms, tau_.data(), quadratic_[k].data());
    }
  }

  CurveAt first(std::size_t q) const { return curve_at(first_, 0, q); }
  CurveAt second(std::size_t q) const { return curve_at(second_, 1, q); }
  /// The crossing of the curves at a node.
  CrossingAt crossing_at(std::size_t q, const CurveAt& first, const CurveAt& second) const {
    if (is_cut()) return {};
    CrossingAt at{path_ ? path_->at(tau_[q], first, second) : crossing(first, second, branch_)};
    if (first.is_circle) at.angle_on_first = angle_of(first, cuts_[0], at.p);
    if (second.is_circle) at.angle_on_second = angle_of(second, cuts_[1], at.p);
    return at;
  }
  double value(const CurveAt& first, const CurveAt& second, const CrossingAt& at) const {
    if (is_cut()) return kPi * first.c;
    return potential(first, at.p, at.angle_on_first) - potential(second, at.p, at.angle_on_second);
  }
  bool is_cut() const { return second_.kind == BoundaryCurve::Kind::cut; }
  const double* nodes() const { return tau_.data(); }

 private:
  CurveAt curve_at(const BoundaryCurve& curve, std::size_t k, std::size_t q) const {
    const auto value = [q](const std::array<double, 3 * kPoints>& values, std::size_t f) {
      return values[f * kPoints + q];
    };
    CurveAt at{curve.is_circle(), value(values_[k], 0), value(values_[k], 1), value(values_[k], 2)};
    if (curve.is_conic()) {
      at.is_conic = true;
      at.swaps = curve.swaps;
      at.xx = value(quadratic_[k], 0);
      at.xy = value(quadratic_[k], 1);
      at.yy = value(quadratic_[k], 2);
    }
    return at;
  }

  const BoundaryCurve &first_, &second_;
  std::array<std::array<double, 2>, 2> cuts_;
  double branch_;
  const CrossingPath* path_;  ///< path of the crossing; null: neither of the curves is a conic
  std::array<double, kPoints> tau_{};
  std::array<std::array<double, 3 * kPoints>, 2> values_, quadratic_;
};

/// Calls visit(index, tau, weight) for the nodes of the Kronrod rule in a subinterval of an active range.
template <class Visit>
void visit_cell(const SegmentIntegral& segment, const RangeCell& cell, const Visit& visit) {
  const NestedRule& rule = kronrod_rule();
  const double kappa = segment.decomposition.ranges[cell.range].weight;
  for (std::size_t q = 0; q < kRule; ++q) {
    const auto [tau, jacobian] = map_node(cell.interval, rule.node[q]);
    visit(q, tau, kappa * jacobian * outer_derivative(segment.outer, tau));
  }
}

void integrate_cell(const SegmentIntegral& segment, RangeCell& cell) {
  const CellCurves curves(segment, segment.decomposition.ranges[cell.range], cell);
  const NestedRule::Level& level = kronrod_rule().level[0];
  std::array<double, kRule> term;
  cell.value = cell.size = 0;
  visit_cell(segment, cell, [&](std::size_t q, double, double weight) {
    const CurveAt first = curves.first(q), second = curves.second(q);
    cell.crossings[q] = curves.crossing_at(q, first, second);
    term[q] = weight * curves.value(first, second, cell.crossings[q]);
    cell.value += level.weight[q] * term[q];
    cell.size += level.weight[q] * std::fabs(term[q]);
  });
  cell.error = rule_error(level, term, cell.value);
}

}  // namespace

void SegmentIntegral::start() {
  cells.clear();
  for (std::size_t r = 0; r < decomposition.ranges.size(); ++r) {
    const ActiveRange& range = decomposition.ranges[r];
    cells.push_back(
        {static_cast<std::uint32_t>(r), {range.low, range.high, range.root_at_low, range.root_at_high}, 0, 0, 0});
    integrate_cell(*this, cells.back());
  }
  sum();
}

bool SegmentIntegral::refine() {
  constexpr double kShortest = 1e-10;
  const auto reducible_error = [](const RangeCell& cell) {
    return cell.interval.upper - cell.interval.lower > kShortest ? cell.error : 0;
  };
  const auto worst = std::ranges::max_element(cells, {}, reducible_error);
  if (worst == cells.end() || reducible_error(*worst) == 0) return false;
  bisect_cell(cells, static_cast<std::size_t>(worst - cells.begin()),
              [&](RangeCell& cell) { integrate_cell(*this, cell); });
  sum();
  return true;
}

void SegmentIntegral::sum() {
  constexpr double kRounding = 4 * 0x1p-53;
  area = {};
  double size = 0;
  for (const RangeCell& cell : cells) {
    area.value += cell.value;
    area.error += cell.error;
    size += cell.size;
  }
  area.error += kRounding * size;
  area.evaluations = static_cast<long>(cells.size() * kRule);
}

void add_adjoints(const SegmentIntegral& segment, std::size_t terms, std::vector<CurveAdjoints>& adjoints) {
  const NestedRule::Level& level = kronrod_rule().level[0];
  for (const RangeCell& cell : segment.cells) {
    const ActiveRange& range = segment.decomposition.ranges[cell.range];
    const CellCurves curves(segment, range, cell);
    // For each function of the two curves, the derivatives of the integral with respect to its values at the nodes of
    // the rule, and the adjoints of its series.
    std::array<std::array<double, kPoints>, 12> by_values;
    std::array<double*, 12> by_series;
    const std::size_t of_first = segment.curves[range.first].is_conic() ? 6 : 3;
    const std::size_t of_second = curves.is_cut() ? 0 : segment.curves[range.second].is_conic() ? 6 : 3;
    for (std::size_t i = 0; i < of_first; ++i) by_series[i] = adjoints[range.first][i].data();
    for (std::size_t i = 0; i < of_second; ++i) by_series[of_first + i] = adjoints[range.second][i].data();
    visit_cell(segment, cell, [&](std::size_t q, double, double weight) {
      const CrossingAt& at = cell.crossings[q];
      std::array<double, 6> f{}, g{};
      if (curves.is_cut()) {
        f[2] = kPi;
      } else {
        f = potential_derivatives(curves.first(q), at.p, at.angle_on_first);
        g = potential_derivatives(curves.second(q), at.p, at.angle_on_second);
      }
      const double factor = weight * level.weight[q];
      for (std::size_t i = 0; i < of_first; ++i) by_values[i][q] = factor * f[i];
      for (std::size_t i = 0; i < of_second; ++i) by_values[of_first + i][q] = -factor * g[i];
    });
    with_instruction_set([&]<InstructionSet set> {
      add_adjoints_of_series<set>(curves.nodes(), kRule, by_values[0].data(), of_first + of_second, terms,
                                  by_series.data());
    });
  }
}

}  // namespace pkm::generic::corner_curves
