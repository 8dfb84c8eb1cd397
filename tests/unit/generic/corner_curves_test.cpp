// Corner curves of hand-written circles, lines and conics against closed forms and dense slices, and their derivatives
// against differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "engine/generic/corner_curves/integral.hpp"
#include "engine/math/random.hpp"

namespace pkm::generic::corner_curves {
namespace {

/// u, w and c of a curve as functions of the outer coordinate, and for a conic xx, xy and yy (boundary_curve.hpp).
struct TestCurve {
  bool is_circle;
  std::function<double(double)> u, w, c, xx{}, xy{}, yy{};

  bool is_conic() const { return static_cast<bool>(xx); }
  CurveAt at(double t) const {
    CurveAt curve{is_circle, u(t), w(t), c(t)};
    if (is_conic()) {
      curve.is_conic = true;
      curve.xx = xx(t);
      curve.xy = xy(t);
      curve.yy = yy(t);
    }
    return curve;
  }
  std::function<double(double)>& function(std::size_t i) { return *std::array{&u, &w, &c, &xx, &xy, &yy}[i]; }
};

struct TestSlices {
  OuterRange outer;
  std::vector<TestCurve> curves;
  SliceFormula formula;

  /// Requires that points lie outside or inside of a curve.
  void require(std::size_t i, bool outside) {
    formula.literals.resize(curves.size());
    (outside ? formula.literals[i].outside : formula.literals[i].inside) |= bit(i);
    formula.formula.all |= bit(i);
  }
  BoundaryCurve interpolated(const TestCurve& curve) const {
    BoundaryCurve to;
    to.kind = curve.is_circle    ? BoundaryCurve::Kind::circle
              : curve.is_conic() ? BoundaryCurve::Kind::conic
                                 : BoundaryCurve::Kind::line;
    if (curve.is_conic()) to.quadratic.emplace();
    for (std::size_t n = 0; n < kNodes; ++n) {
      const CurveAt at = curve.at(map_node(outer, 0.5 * (1 + chebyshev_nodes()[n])).point);
      to.values[0][n] = at.u;
      to.values[1][n] = at.w;
      to.values[2][n] = at.c;
      if (!curve.is_conic()) continue;
      to.quadratic->values[0][n] = at.xx;
      to.quadratic->values[1][n] = at.xy;
      to.quadratic->values[2][n] = at.yy;
    }
    EXPECT_TRUE(to.interpolate(1e-12));
    return to;
  }
  std::vector<BoundaryCurve> boundaries() const {
    std::vector<BoundaryCurve> all;
    for (const TestCurve& curve : curves) {
      all.push_back(interpolated(curve));
      EXPECT_TRUE(!curve.is_conic() || all.back().find_graphs({1.3, 1.3}));
    }
    return all;
  }
  /// Whether every conic consists of graphs y(x) or x(y) in the slices.
  bool have_graphs() const {
    return std::ranges::all_of(curves, [&](const TestCurve& curve) {
      return !curve.is_conic() || interpolated(curve).find_graphs({1.3, 1.3});
    });
  }
  SegmentIntegral integrate(double tolerance = 1e-11) const {
    SegmentIntegral integral{outer, boundaries(), {}, {}, {}};
    DecompositionScratch scratch;
    EXPECT_TRUE(decompose(integral.curves, formula, integral.decomposition, scratch));
    integral.start();
    while (integral.area.error > tolerance * std::fabs(integral.area.value) && integral.refine()) continue;
    return integral;
  }
  /// By the midpoint rule over columns whose ends are exact.
  double dense(int steps, double half_width) const {
    double sum = 0;
    std::vector<double> ends;
    std::vector<CurveAt> at;
    for (int i = 0; i < steps; ++i) {
      const double t = outer.lower + (outer.upper - outer.lower) * (i + 0.5) / steps;
      at.clear();
      for (const TestCurve& curve : curves) at.push_back(curve.at(t));
      for (int j = 0; j < steps; ++j) {
        const double x = half_width * (2 * (j + 0.5) / steps - 1);
        ends = {-half_width, half_width};
        for (const CurveAt& curve : at) {
          const double square = curve.c - (x - curve.u) * (x - curve.u);
          if (curve.is_circle && square > 0)
            ends.insert(ends.end(), {curve.w - std::sqrt(square), curve.w + std::sqrt(square)});
          else if (!curve.is_circle && !curve.is_conic && curve.w != 0)
            ends.push_back(-(curve.u * x + curve.c) / curve.w);
          if (!curve.is_conic) continue;
          const double linear = curve.w + curve.xy * x, constant = curve.h({x, 0});
          const double of_roots = linear * linear - 4 * curve.yy * constant;
          for (const double sign : {-1.0, 1.0})
            if (of_roots > 0) ends.push_back((-linear + sign * std::sqrt(of_roots)) / (2 * curve.yy));
        }
        std::ranges::sort(ends);
        for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
          const Vector p{x, 0.5 * (ends[k] + ends[k + 1])};
          Signs signs = 0;
          for (std::size_t curve = 0; curve < at.size(); ++curve)
            if (at[curve].h(p) > 0) signs |= bit(curve);
          if (std::fabs(p.y) < half_width && formula.holds(signs)) sum += ends[k + 1] - ends[k];
        }
      }
    }
    return sum * 2 * half_width * (outer.upper - outer.lower) / (static_cast<double>(steps) * steps);
  }
};

std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

double lens(double d, double r, double s) {
  if (d >= r + s) return 0;
  if (d <= std::fabs(r - s)) return kPi * std::min(r, s) * std::min(r, s);
  const double a = (d * d + r * r - s * s) / (2 * d), b = d - a, h = std::sqrt(r * r - a * a);
  return r * r * std::atan2(h, a) + s * s * std::atan2(h, b) - d * h;
}

/// Two discs that pass over each other: they are apart, cross, and one lies inside of the other.
TEST(CornerCurves, IntegrateTheLensOfTwoCircles) {
  constexpr double kR = 0.7, kS = 0.3;
  TestSlices slices{{-1.5, 2, false, false},
                    {{true, [](double t) { return t; }, constant(0.1), constant(kR * kR)},
                     {true, constant(0), constant(0.1), constant(kS * kS)}},
                    {}};
  slices.require(0, false);
  slices.require(1, false);
  const std::vector<Subinterval<double>> pieces = {{-kR - kS, kS - kR, true, true}, {kR - kS, kR + kS, true, true}};
  std::vector<QuadratureCell<double>> scratch;
  const double known =
      integrate<double>([&](double t) { return lens(std::fabs(t), kR, kS); }, pieces, 1e-13, 0, scratch).value +
      2 * (kR - kS) * kPi * kS * kS;
  const SegmentIntegral found = slices.integrate();
  EXPECT_NEAR(found.area.value, known, 1e-11);
  EXPECT_LT(std::fabs(found.area.value - known), found.area.error + 1e-14);
  EXPECT_EQ(found.decomposition.unbalanced, 0);
}

/// A circle that appears where its squared radius becomes positive: half of an ellipsoid.
TEST(CornerCurves, IntegrateACircleWithoutCorners) {
  TestSlices slices{
      {0, 1.5, false, false}, {{true, constant(0.2), constant(0), [](double t) { return 1 - t * t; }}}, {}};
  slices.require(0, false);
  EXPECT_NEAR(slices.integrate().area.value, 2 * kPi / 3, 1e-12);
}

/// A = 0, Q = 0 and Q = A^2 of a root: a circle, a diameter and the tangent at its end, for all t.
TEST(CornerCurves, ResolveCurvesThatMeetInOnePointForAllOuterCoordinates) {
  const auto centre = [](double t) { return 0.3 * t; };
  // A = y, Q = (1 - x)(1 + x): A >= 0 or Q >= A^2, in |x| < 1
  TestSlices slices{{-1, 1, false, false},
                    {{true, centre, constant(0), constant(1)},
                     {false, constant(0), constant(1), constant(0)},
                     {false, constant(1), constant(0), [&](double t) { return 1 - centre(t); }},
                     {false, constant(1), constant(0), [&](double t) { return -1 - centre(t); }},
                     {false, constant(0), constant(1), constant(-2)}},
                    {}};
  slices.require(2, true);
  slices.require(3, false);
  slices.require(4, false);
  slices.formula.literals[0].inside |= bit(0);
  slices.formula.literals[1].outside |= bit(1);
  slices.formula.formula.any = {bit(0) | bit(1)};
  const SegmentIntegral found = slices.integrate();
  EXPECT_NEAR(found.area.value, 2 * (4 + kPi / 2), 1e-11);
  EXPECT_EQ(found.decomposition.unbalanced, 0);
}

/// @param conics  number of conics, in addition to circles and lines
TestSlices random_slices(Stream& random, std::size_t conics = 0) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.u01(); };
  const auto wave = [&](double middle, double amplitude) -> std::function<double(double)> {
    const double a = between(-middle, middle), b = between(-amplitude, amplitude), c = between(0, 6);
    return [=](double t) { return a + b * std::sin(1.3 * t + c); };
  };
  TestSlices slices{{-1, 1.5, false, false}, {}, {}};
  const std::size_t circles = 2 + random.below(4), lines = random.below(3);
  for (std::size_t i = 0; i < circles; ++i) {
    const auto size = wave(0, 0.4);
    const double mean = between(0.3, 1.2);
    slices.curves.push_back({true, wave(0.6, 0.5), wave(0.6, 0.5), [=](double t) { return mean + size(t); }});
  }
  for (std::size_t i = 0; i < lines; ++i) {
    const double angle = between(0, 6), turn = between(-0.3, 0.3);
    slices.curves.push_back({false, [=](double t) { return std::cos(angle + turn * t); },
                             [=](double t) { return std::sin(angle + turn * t); }, wave(0.4, 0.3)});
  }
  // Graphs y(x), for |x| <= 1.3, or x(y): hyperbolas, which have no or few tangents of other directions, and wide
  // ellipses.
  if (conics > 0) slices.outer = {-0.4, 0.5, false, false};
  for (std::size_t i = 0; i < conics; ++i) {
    const auto linear = wave(0.3, 0.2), across = wave(0.2, 0.2), shift = wave(0.3, 0.3);
    const double bend = between(-0.2, 0.6), size = between(0.5, 0.9);
    TestCurve conic{false,
                    linear,
                    shift,
                    [=](double t) { return -size - 0.1 * std::sin(t); },
                    [=](double t) { return -bend - 0.05 * std::cos(t); },
                    across,
                    constant(1)};
    if (random.chance(0.5)) {
      std::swap(conic.u, conic.w);
      std::swap(conic.xx, conic.yy);
    }
    slices.curves.push_back(conic);
  }
  const std::size_t own = slices.curves.size();
  for (const double sign : {1.0, -1.0}) {
    slices.curves.push_back({false, constant(sign), constant(0), constant(1.3)});
    slices.curves.push_back({false, constant(0), constant(sign), constant(1.3)});
  }
  for (std::size_t i = own; i < own + 4; ++i) slices.require(i, true);
  for (std::size_t i = 0; i < 2; ++i) slices.require(i, random.chance(0.4));
  for (std::size_t i = 2; i < own; i += 2) {
    Signs some = 0;
    for (std::size_t k = i; k < std::min(i + 2, own); ++k) {
      (random.chance(0.4) ? slices.formula.literals[k].outside : slices.formula.literals[k].inside) |= bit(k);
      some |= bit(k);
    }
    slices.formula.formula.any.push_back(some);
  }
  return slices;
}

TEST(CornerCurves, AgreeWithDenseSlices) {
  int compared = 0;
  Stream random(71, 0, 0, Stream::Use::start);
  for (int k = 0; k < 90; ++k) {
    SCOPED_TRACE(k);
    const TestSlices slices = random_slices(random, k < 60 ? 0 : 1 + static_cast<std::size_t>(k % 3));
    if (!slices.have_graphs()) continue;
    const SegmentIntegral found = slices.integrate(1e-9);
    // The three pairs of a triple with a conic find its common points separately.
    EXPECT_LE(found.decomposition.unbalanced, k < 60 ? 0 : 1e-9);
    EXPECT_NEAR(found.area.value, slices.dense(200, 1.3), 5e-4);
    ++compared;
  }
  EXPECT_GE(compared, 80);
}

/// By the functions of every circle and conic, whose changes are waves.
TEST(CornerCurves, HaveTheDerivativesOfDifferences) {
  Stream random(72, 0, 0, Stream::Use::start);
  for (int k = 0; k < 30; ++k) {
    SCOPED_TRACE(k);
    const TestSlices slices = random_slices(random, k < 20 ? 0 : 1 + static_cast<std::size_t>(k % 2));
    const SegmentIntegral found = slices.integrate(1e-12);
    std::vector<CurveAdjoints> adjoints(found.curves.size());
    for (auto& curve : adjoints)
      for (Samples& each : curve) each.fill(0);
    add_adjoints(found, kNodes, adjoints);
    for (std::size_t i = 0; i < slices.curves.size(); ++i)
      for (std::size_t f = 0; f < (slices.curves[i].is_conic() ? 6U : slices.curves[i].is_circle ? 3U : 0U); ++f) {
        Samples by;
        transpose_to_values(adjoints[i][f], kNodes, by);
        double derivative = 0;
        for (std::size_t n = 0; n < kNodes; ++n)
          derivative += by[n] * std::cos(map_node(slices.outer, 0.5 * (1 + chebyshev_nodes()[n])).point);
        const auto moved = [&](double by_much) {
          TestSlices other = slices;
          auto& changed = other.curves[i].function(f);
          changed = [=, before = changed](double t) { return before(t) + by_much * std::cos(t); };
          return other.integrate(1e-12).area.value;
        };
        constexpr double kStep = 1e-5;
        EXPECT_NEAR(derivative, (moved(kStep) - moved(-kStep)) / (2 * kStep), 1e-6 * (1 + std::fabs(derivative)));
      }
  }
}

TEST(ChebyshevRoots, AreAllFound) {
  const auto roots_of = [](const std::function<double(double)>& f) {
    Samples values, series;
    for (std::size_t n = 0; n < kNodes; ++n) values[n] = f(chebyshev_nodes()[n]);
    to_coefficients(values, series);
    std::vector<Root> roots;
    isolate_roots(series, interpolation_error(series, 1e-15), roots);
    return roots;
  };
  const auto simple = roots_of([](double x) { return std::sin(6 * (x - 0.1)); });
  ASSERT_EQ(simple.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(simple[i].at, 0.1 + (static_cast<double>(i) - 2) * kPi / 6, 1e-14);
    EXPECT_EQ(simple[i].width, 0);
  }
  const auto pair = roots_of([](double x) { return (x - 0.3) * (x - 0.3) - 1e-8; });
  ASSERT_EQ(pair.size(), 2U);
  EXPECT_NEAR(pair[0].at, 0.3 - 1e-4, 1e-11);
  const auto touching = roots_of([](double x) { return (x - 0.3) * (x - 0.3) * std::exp(x); });
  ASSERT_EQ(touching.size(), 1U);
  EXPECT_NEAR(touching[0].at, 0.3, touching[0].width);
  EXPECT_GT(touching[0].width, 0);
  EXPECT_LT(touching[0].width, 1e-6);
  EXPECT_TRUE(roots_of([](double x) { return 1.01 + std::sin(3 * x); }).empty());
}

}  // namespace
}  // namespace pkm::generic::corner_curves
