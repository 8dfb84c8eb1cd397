#include "engine/generic/corner_curves/integral.hpp"

#include <algorithm>

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

/// Integral of (x dy - y dx)/2 along a curve up to its point p.
/// @param angle  result of angle_of() for p if the curve is a circle
double potential(const CurveAt& curve, const Vector& p, double angle) {
  if (curve.is_circle) return 0.5 * (curve.u * p.y - curve.w * p.x + curve.c * angle);
  return -0.5 * curve.c * (curve.u * p.y - curve.w * p.x);
}

/// Contributions of a curve up to its point p to the derivatives of the area with respect to the curve's u, w and c
/// (see CurveAt): integrals along the curve, as potential() is for the area.
std::array<double, 3> potential_derivatives(const CurveAt& curve, const Vector& p, double angle) {
  if (curve.is_circle) return {p.y - curve.w, curve.u - p.x, 0.5 * angle};
  const double l = curve.w * p.x - curve.u * p.y;  // coordinate of p along the line, in the direction (w, -u)
  return {l * (-curve.c * curve.u + 0.5 * l * curve.w), l * (-curve.c * curve.w - 0.5 * l * curve.u), l};
}

/// Direction of the cut of curve i, which is a circle. The cuts are behind all other curves, in the order of the
/// circles.
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
        branch_(range.branch) {
    std::array<double, kPoints> tau{};
    for (std::size_t q = 0; q < kRule; ++q) tau[q] = map_node(cell.interval, kronrod_rule().node[q]).point;
    evaluate_at_points(first_.series, first_.terms, tau.data(), values_[0].data());
    if (!is_cut()) evaluate_at_points(second_.series, second_.terms, tau.data(), values_[1].data());
  }

  struct Point {
    CurveAt first, second;
    Vector p;
    double angle_of_first = 0, angle_of_second = 0;
  };
  Point at(std::size_t q) const {
    const auto curve = [&](const BoundaryCurve& which, const std::array<double, 3 * kPoints>& values) {
      return CurveAt{which.is_circle(), values[q], values[kPoints + q], values[2 * kPoints + q]};
    };
    Point point{curve(first_, values_[0]), curve(second_, values_[1]), {}};
    if (is_cut()) return point;
    point.p = crossing(point.first, point.second, branch_);
    if (point.first.is_circle) point.angle_of_first = angle_of(point.first, cuts_[0], point.p);
    if (point.second.is_circle) point.angle_of_second = angle_of(point.second, cuts_[1], point.p);
    return point;
  }
  double value(const Point& point) const {
    if (is_cut()) return kPi * point.first.c;
    return potential(point.first, point.p, point.angle_of_first) -
           potential(point.second, point.p, point.angle_of_second);
  }
  bool is_cut() const { return second_.kind == BoundaryCurve::Kind::cut; }

 private:
  const BoundaryCurve &first_, &second_;
  std::array<std::array<double, 2>, 2> cuts_;
  double branch_;
  std::array<std::array<double, 3 * kPoints>, 2> values_;
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
    term[q] = weight * curves.value(curves.at(q));
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
    visit_cell(segment, cell, [&](std::size_t q, double tau, double weight) {
      const auto point = curves.at(q);
      std::array<double, 6> by{};
      if (curves.is_cut()) {
        by[2] = kPi;
      } else {
        const auto f = potential_derivatives(point.first, point.p, point.angle_of_first),
                   g = potential_derivatives(point.second, point.p, point.angle_of_second);
        for (std::size_t i = 0; i < 3; ++i) {
          by[i] = f[i];
          by[3 + i] = -g[i];
        }
      }
      for (double& each : by) each *= weight * level.weight[q];
      std::array<double, kNodes> polynomials;
      polynomials[0] = 1;
      polynomials[1] = tau;
      for (std::size_t k = 2; k < terms; ++k) polynomials[k] = 2 * tau * polynomials[k - 1] - polynomials[k - 2];
      for (std::size_t i = 0; i < 3; ++i) {
        Samples &first = adjoints[range.first][i], &second = adjoints[range.second][i];
        for (std::size_t k = 0; k < terms; ++k) first[k] += by[i] * polynomials[k];
        if (curves.is_cut()) continue;
        for (std::size_t k = 0; k < terms; ++k) second[k] += by[3 + i] * polynomials[k];
      }
    });
  }
}

}  // namespace pkm::generic::corner_curves
