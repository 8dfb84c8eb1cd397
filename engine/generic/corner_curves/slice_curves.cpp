#include "engine/generic/corner_curves/slice_curves.hpp"

#include <algorithm>
#include <bit>

#include "engine/math/satisfied.hpp"

namespace pkm::generic::corner_curves {
namespace {

// A curve does not pass through a rectangle if |h| is larger than this everywhere in the rectangle, which is enlarged
// by the same amount.
constexpr double kMargin = 1e-9;
constexpr std::size_t kMiddle = kNodes / 2;

/// Interval that contains all values of a series of a curve.
struct Range {
  double low, high;
};
Range range_of(const Samples& series, const BoundaryCurve& curve) {
  double rest = curve.error;
  for (std::size_t k = 1; k < curve.terms; ++k) rest += std::fabs(series[k]);
  return {series[0] - rest, series[0] + rest};
}
Range product(const Range& a, const Range& b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}

/// An interval that contains all values of the function h of a curve in the rectangle with the ranges x and y.
Range values_in(const BoundaryCurve& curve, const Range& x, const Range& y) {
  const Range u = range_of(curve.series[0], curve), w = range_of(curve.series[1], curve),
              c = range_of(curve.series[2], curve);
  if (!curve.is_circle()) {
    const Range a = product(u, x), b = product(w, y);
    Range sum{a.low + b.low + c.low, a.high + b.high + c.high};
    if (!curve.is_conic()) return sum;
    const auto square = [](const Range& p) {
      const double near = p.low > 0 ? p.low : p.high < 0 ? p.high : 0;
      return Range{near * near, std::fmax(p.low * p.low, p.high * p.high)};
    };
    const Range powers[3] = {square(x), product(x, y), square(y)};
    for (std::size_t i = 0; i < 3; ++i) {
      const Range term = product(range_of(curve.quadratic->series[i], curve), powers[i]);
      sum = {sum.low + term.low, sum.high + term.high};
    }
    return sum;
  }
  const auto squares = [](const Range& p, const Range& q) {
    const double low = p.low - q.high, high = p.high - q.low;
    const double near = low > 0 ? low : high < 0 ? -high : 0, far = std::fmax(-low, high);
    return Range{near * near, far * far};
  };
  const Range a = squares(x, u), b = squares(y, w);
  return {a.low + b.low - c.high, a.high + b.high - c.low};
}

/// Accuracy of the functions u, w and c of a boundary curve: curves that differ by less count as equal. Roots of
/// quadratics and of limits have larger rounding errors where two of them are about to merge.
double accuracy_of(CurveSource::Kind kind) {
  using Kind = CurveSource::Kind;
  return kind == Kind::lower_root || kind == Kind::upper_root || kind == Kind::limit ? 1e-10 : 1e-12;
}

/// Maximum difference of the values of two curves of the same kind, relative to 1 + the magnitude of the value;
/// std::nullopt if it is larger than `most`, or if the curves are of different kinds.
std::optional<double> difference(const BoundaryCurve& a, const BoundaryCurve& b, double most) {
  if (a.kind != b.kind) return {};
  double largest = 0;
  const auto compare = [&](const std::array<Samples, 3>& x, const std::array<Samples, 3>& y) {
    for (std::size_t f = 0; f < 3; ++f)
      for (std::size_t n = 0; n < kNodes; ++n) {
        largest = std::max(largest, std::fabs(x[f][n] - y[f][n]) / (1 + std::fabs(x[f][n])));
        if (largest > most) return false;
      }
    return true;
  };
  if (!compare(a.values, b.values) || (a.is_conic() && !compare(a.quadratic->values, b.quadratic->values))) return {};
  return largest;
}

bool is_defined(const std::array<Samples, 6>& c, bool& nowhere) {
  std::size_t defined = 0;
  for (std::size_t n = 0; n < kNodes; ++n)
    defined += std::ranges::all_of(c, [&](const Samples& each) { return std::isfinite(each[n]); });
  nowhere = defined == 0;
  return defined == kNodes;
}

}  // namespace

std::size_t SliceCurves::add_curve(const BoundaryCurve& curve, const CurveSource& source) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double most = std::max(accuracy_of(sources[i].kind), accuracy_of(source.kind));
    const auto between = difference(curves[i], curve, most);
    if (!between) continue;
    curves[i].merged = std::max(curves[i].merged, *between);
    return i;
  }
  curves.push_back(curve);
  sources.push_back(source);
  formula.literals.emplace_back();
  return curves.size() - 1;
}

/// Adds a line. Its normal is reversed if necessary, so that two constraints with opposite signs share one curve.
/// @param positive  set of the surfaces that are >= 0 where the given line has h > 0
/// @param number    receives the index of the curve
void SliceCurves::add_line(BoundaryCurve& line, CurveSource source, Signs positive, std::size_t* number) {
  const double u = line.values[0][kMiddle], w = line.values[1][kMiddle];
  const bool flips = std::fabs(u) >= std::fabs(w) ? u < 0 : w < 0;
  if (flips) {
    for (Samples& each : line.values)
      for (double& value : each) value = -value;
    source.sign = -source.sign;
  }
  const std::size_t at = add_curve(line, source);
  (flips ? formula.literals[at].inside : formula.literals[at].outside) |= positive;
  if (number) *number = at;
}

/// Adds a conic in the coordinates of the frame, scaled such that its coefficients have magnitudes up to 1. The sign of
/// its largest quadratic coefficient is normalised, so that opposite constraints share one curve.
void SliceCurves::add_conic(std::size_t surface, const std::array<Samples, 6>& c) {
  BoundaryCurve conic;
  conic.kind = BoundaryCurve::Kind::conic;
  auto& [u, w, constant] = conic.values;
  auto& [xx, xy, yy] = conic.quadratic.emplace().values;
  const double v = frame.v, z = frame.z, scale = frame.scale;
  double largest = 0;
  for (std::size_t n = 0; n < kNodes; ++n) {
    constant[n] = c[0][n] + v * (c[1][n] + v * c[3][n] + z * c[4][n]) + z * (c[2][n] + z * c[5][n]);
    u[n] = scale * (c[1][n] + 2 * v * c[3][n] + z * c[4][n]);
    w[n] = scale * (c[2][n] + v * c[4][n] + 2 * z * c[5][n]);
    xx[n] = scale * scale * c[3][n];
    xy[n] = scale * scale * c[4][n];
    yy[n] = scale * scale * c[5][n];
    for (const Samples* each : {&constant, &u, &w, &xx, &xy, &yy}) largest = std::max(largest, std::fabs((*each)[n]));
  }
  double sign = 0;
  for (const Samples* each : {&xx, &xy, &yy})
    if (std::fabs((*each)[kMiddle]) > std::fabs(sign)) sign = (*each)[kMiddle];
  const double factor = (sign < 0 ? -1 : 1) / largest;
  for (Samples* each : {&constant, &u, &w, &xx, &xy, &yy})
    for (double& value : *each) value *= factor;
  const std::size_t at = add_curve(conic, {CurveSource::Kind::conic, surface, factor});
  (factor < 0 ? formula.literals[at].inside : formula.literals[at].outside) |= bit(surface);
}

/// Adds the two parallel lines that are the roots of a quadratic in one coordinate.
bool SliceCurves::add_strip(std::size_t surface, bool along_v, const std::array<Samples, 6>& c) {
  const Samples &c0 = c[0], &b = along_v ? c[1] : c[2], &a = along_v ? c[3] : c[5];
  const bool is_inside = a[kMiddle] < 0;
  std::array<BoundaryCurve, 2> lines;
  for (std::size_t n = 0; n < kNodes; ++n) {
    if ((a[n] < 0) != is_inside || a[n] == 0) return false;
    const double square = b[n] * b[n] - 4 * a[n] * c0[n];
    if (square < 0) {
      bool never = true;
      for (std::size_t k = 0; k < kNodes; ++k) never = never && b[k] * b[k] - 4 * a[k] * c0[k] < 0;
      if (never && !is_inside) formula.constant |= bit(surface);
      return never;
    }
    const double q = -0.5 * (b[n] + (b[n] < 0 ? -1 : 1) * std::sqrt(square));
    const double r = q / a[n], s = q == 0 ? r : c0[n] / q;
    const double centre = along_v ? frame.v : frame.z;
    for (const bool upper : {false, true}) {
      auto& [u, w, at] = lines[upper].values;
      u[n] = along_v ? 1 : 0;
      w[n] = along_v ? 0 : 1;
      at[n] = -((upper ? std::fmax(r, s) : std::fmin(r, s)) - centre) / frame.scale;
    }
  }
  SliceFormula::Strip strip{0, 0, bit(surface), is_inside};
  add_line(lines[0], {CurveSource::Kind::lower_root, surface, 1}, 0, &strip.first);
  add_line(lines[1], {CurveSource::Kind::upper_root, surface, 1}, 0, &strip.second);
  if (strip.first == strip.second) return false;
  formula.strips.push_back(strip);
  return true;
}

bool SliceCurves::add_surface(std::size_t surface, Shape shape, const std::array<Samples, 6>& c) {
  bool nowhere = false;
  if (!is_defined(c, nowhere)) return nowhere;  // an undefined value violates the constraint
  BoundaryCurve curve;
  switch (shape) {
    case Shape::constant:
      if (is_satisfied(c[0][kMiddle])) formula.constant |= bit(surface);
      return true;
    case Shape::strip_along_v:
    case Shape::strip_along_z:
      return add_strip(surface, shape == Shape::strip_along_v, c);
    case Shape::line: {
      double smallest = std::hypot(c[1][0], c[2][0]), largest = smallest;
      for (std::size_t n = 0; n < kNodes; ++n) {
        const double size = std::sqrt(c[1][n] * c[1][n] + c[2][n] * c[2][n]);
        smallest = std::min(smallest, size);
        largest = std::max(largest, size);
        curve.values[0][n] = c[1][n] / size;
        curve.values[1][n] = c[2][n] / size;
        curve.values[2][n] = (c[0][n] + c[1][n] * frame.v + c[2][n] * frame.z) / (size * frame.scale);
      }
      if (!(smallest > 1e-6 * largest)) return false;
      add_line(curve, {CurveSource::Kind::line, surface, 1}, bit(surface));
      return true;
    }
    case Shape::conic:
      add_conic(surface, c);
      return true;
    case Shape::circle:
      break;
  }
  const bool is_inside = c[3][kMiddle] < 0;
  curve.kind = BoundaryCurve::Kind::circle;
  for (std::size_t n = 0; n < kNodes; ++n) {
    const double a = c[3][n];
    if ((a < 0) != is_inside || a == 0) return false;
    const double v = -0.5 * c[1][n] / a, z = -0.5 * c[2][n] / a;
    curve.values[0][n] = (v - frame.v) / frame.scale;
    curve.values[1][n] = (z - frame.z) / frame.scale;
    curve.values[2][n] = (v * v + z * z - c[0][n] / a) / (frame.scale * frame.scale);
  }
  const std::size_t at = add_curve(curve, {CurveSource::Kind::circle, surface, 1});
  (is_inside ? formula.literals[at].inside : formula.literals[at].outside) |= bit(surface);
  return true;
}

/// Adds the lower or upper bound of v as a line, beyond which no point is feasible.
void SliceCurves::add_bound(BoundaryCurve& line, bool upper) {
  std::size_t at = 0;
  add_line(line, {CurveSource::Kind::v_bound, upper ? std::size_t{1} : 0, 1}, 0, &at);
  formula.bounds.push_back({at, !upper});
}

/// Adds the roots v of limits (constraints that do not depend on z) as lines, and the condition that no point is
/// feasible where a limit is violated between them.
bool SliceCurves::add_limits(const std::vector<LimitRoot>& roots) {
  std::size_t before = 0;  // index of the line at the previous root
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const bool is_first = i == 0 || roots[i - 1].limit != roots[i].limit,
               is_last = i + 1 == roots.size() || roots[i + 1].limit != roots[i].limit;
    BoundaryCurve line;
    line.values[0].fill(1);
    line.values[1].fill(0);
    for (std::size_t n = 0; n < kNodes; ++n) line.values[2][n] = (frame.v - roots[i].v[n]) / frame.scale;
    std::size_t at = 0;
    add_line(line, {CurveSource::Kind::limit, roots[i].limit, 1}, 0, &at);
    if (!is_first && at == before) return false;
    if (roots[i].rises && !is_first)
      formula.strips.push_back({before, at, 0, false});
    else if (roots[i].rises || is_last)
      formula.bounds.push_back({at, roots[i].rises});
    before = at;
  }
  return true;
}

/// Simplifies the formula of feasibility for a curve whose function h has the same sign in all relevant points. The
/// curve remains in `curves`, but the formula does not use its sign any more.
/// @param i        index of the curve
/// @param outside  the sign of h; true: h > 0
void SliceCurves::remove_constant(std::size_t i, bool outside) {
  auto& literal = formula.literals[i];
  formula.constant |= outside ? literal.outside : literal.inside;
  literal = {};
  std::erase_if(formula.bounds, [&](const auto& each) { return each.curve == i; });
  for (auto strip = formula.strips.begin(); strip != formula.strips.end();) {
    if (strip->first != i && strip->second != i) {
      ++strip;
      continue;
    }
    const bool is_first = strip->first == i;
    auto& other = formula.literals[is_first ? strip->second : strip->first];
    // All points are on the side of this line on which the strip lies, so that the other line alone decides.
    if (is_first == outside) {
      const bool is_other_inside = is_first == strip->is_inside;
      (is_other_inside ? other.inside : other.outside) |= strip->surface;
      if (strip->surface == 0) formula.bounds.push_back({is_first ? strip->second : strip->first, !is_other_inside});
    } else if (!strip->is_inside) {
      formula.constant |= strip->surface;
    }
    strip = formula.strips.erase(strip);
  }
}

SliceCurves::Status SliceCurves::simplify() {
  Formula& f = formula.formula;
  // Find a rectangle that contains all points which satisfy the constraints that no feasible point can violate.
  constexpr double kFar = 1e6;
  Range x{-kFar, kFar}, y{-kFar, kFar};
  const auto bound = [&](std::size_t i, bool outside) {
    if (curves[i].is_conic()) return;
    const auto& series = curves[i].series;
    const Range u = range_of(series[0], curves[i]), w = range_of(series[1], curves[i]),
                c = range_of(series[2], curves[i]);
    if (curves[i].is_circle()) {
      if (outside) return;
      const double radius = std::sqrt(std::fmax(0, c.high));
      x = {std::fmax(x.low, u.low - radius), std::fmin(x.high, u.high + radius)};
      y = {std::fmax(y.low, w.low - radius), std::fmin(y.high, w.high + radius)};
      return;
    }
    for (const bool along_x : {true, false}) {
      const Range& normal = along_x ? u : w;
      const Range& across = along_x ? w : u;
      Range& place = along_x ? x : y;
      if (normal.low < 0.999999 || std::fmax(-across.low, across.high) > 1e-13) continue;
      // kMargin covers the error of the curve, and its displacement within the rectangle if it is inclined by 1e-13.
      (outside ? place.low : place.high) =
          outside ? std::fmax(place.low, -c.high - kMargin) : std::fmin(place.high, -c.low + kMargin);
    }
  };
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto [out, in] = formula.literals[i];
    if ((in & ~out & f.all) != 0) bound(i, false);
    if ((out & ~in & f.all) != 0) bound(i, true);
  }
  for (const auto& strip : formula.strips)
    if (strip.is_inside && (strip.surface & f.all) != 0) {
      bound(strip.first, true);
      bound(strip.second, false);
    }
  for (const auto& each : formula.bounds) bound(each.curve, each.outside);
  if (!(x.low < x.high && y.low < y.high)) return Status::empty;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Range h = values_in(curves[i], x, y);
    const bool outside = h.low > kMargin;
    if (!outside && !(h.high < -kMargin)) continue;
    if (std::ranges::any_of(formula.bounds,
                            [&](const auto& each) { return each.curve == i && each.outside != outside; }))
      return Status::empty;
    remove_constant(i, outside);
  }

  Signs possible = formula.constant;
  for (const auto& literal : formula.literals) possible |= literal.outside | literal.inside;
  for (const auto& strip : formula.strips) possible |= strip.surface;
  if ((f.all & ~possible) != 0) return Status::empty;
  for (auto clause = f.any.begin(); clause != f.any.end();) {
    const Signs some = *clause & possible;
    if (some == 0) return Status::empty;
    const bool is_single = std::has_single_bit(some);
    if (is_single) f.all |= some;
    clause = is_single || (some & formula.constant) != 0 ? f.any.erase(clause) : clause + 1;
  }
  remove_irrelevant();
  const std::array<double, 2> half_widths = {std::fmax(-x.low, x.high), std::fmax(-y.low, y.high)};
  for (BoundaryCurve& curve : curves)
    if (curve.is_conic() && !curve.find_graphs(half_widths)) return Status::unresolved;
  return Status::filled;
}

void SliceCurves::remove_irrelevant() {
  const Formula& f = formula.formula;
  Signs relevant = f.all & ~formula.constant;
  for (const Signs clause : f.any) relevant |= clause;
  for (const CrankSigns& crank : f.cranks)
    relevant |= crank.at_min | crank.at_max | crank.after_min | crank.before_max | crank.reach;
  std::erase_if(formula.strips,
                [&](const auto& strip) { return strip.surface != 0 && (strip.surface & relevant) == 0; });
  std::array<std::size_t, kMaxCurves> place{};
  std::size_t kept = 0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& [outside, inside] = formula.literals[i];
    const bool is_used =
        std::ranges::any_of(formula.strips, [&](const auto& strip) { return strip.first == i || strip.second == i; }) ||
        std::ranges::any_of(formula.bounds, [&](const auto& each) { return each.curve == i; });
    if (((outside | inside) & relevant) == 0 && !is_used) continue;
    place[i] = kept;
    if (kept != i) {
      curves[kept] = curves[i];
      sources[kept] = sources[i];
      formula.literals[kept] = formula.literals[i];
    }
    ++kept;
  }
  curves.resize(kept);
  sources.resize(kept);
  formula.literals.resize(kept);
  for (auto& strip : formula.strips) {
    strip.first = place[strip.first];
    strip.second = place[strip.second];
  }
  for (auto& each : formula.bounds) each.curve = place[each.curve];
}

SliceCurves::Status SliceCurves::build(const SlicePlan& plan, const OuterPlan& outer, const NodeValues& nodes,
                                       const std::vector<LimitRoot>& limits, const Frame& where,
                                       const double* registers) {
  frame = where;
  curves.clear();
  sources.clear();
  formula.formula = plan.formula;
  formula.registers = registers;
  formula.constant = 0;
  formula.literals.clear();
  formula.strips.clear();
  formula.bounds.clear();
  for (std::size_t k = 0; k < plan.surfaces.size(); ++k)
    if (!add_surface(k, outer.shapes[k], nodes.surfaces[k])) return Status::unresolved;
  for (const bool upper : {false, true}) {
    BoundaryCurve line;
    for (std::size_t n = 0; n < kNodes; ++n) {
      const double sign = upper ? -1 : 1;
      line.values[0][n] = sign;
      line.values[1][n] = 0;
      line.values[2][n] = sign * (frame.v - nodes.v[upper][n]) / frame.scale;
    }
    add_bound(line, upper);
  }
  if (!add_limits(limits) || curves.size() > kMaxCurves) return Status::unresolved;
  for (std::size_t i = 0; i < curves.size(); ++i)
    if (!curves[i].interpolate(accuracy_of(sources[i].kind))) return Status::unresolved;
  return simplify();
}

}  // namespace pkm::generic::corner_curves
