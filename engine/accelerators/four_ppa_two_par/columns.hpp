// 4PPa-2PaR: exact volume, and weighted samples, by quadrature over theta of closed-form sections.
#pragma once

#include <type_traits>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"
#include "engine/accelerators/four_ppa_two_par/coupling.hpp"
#include "engine/accelerators/four_ppa_two_par/theta_intervals.hpp"
#include "engine/mechanism/survey.hpp"

namespace pkm::four_ppa_two_par {

/// Storage that surveys reuse.
template <class S>
struct ColumnScratch {
  std::vector<Break<S>> breaks;
  std::vector<Piece<S>> pieces;
  std::vector<QuadratureCell<S>> integrals;
  std::vector<Piece<S>> ranges, parts;
  ClearanceScratch clearance;
  ColumnConditioning<S> poses;
  std::array<std::vector<S>, 2> inertia;  ///< values of fields at a pose and across the section
};

/// Rounding of a section's area [m^2]: it is a difference of terms of this size times some 2^-53.
template <class S>
double area_roundoff(const Geometry<S>& g) {
  return 1e-15 * value_of(g.l_d) * (value_of(g.l_d) + value_of(g.l_u));
}

/// Volume of the workspace on one plane y [m^2 rad].
template <class S>
Integral<S> plane_volume(const Frame<S>& f, double tolerance, ColumnScratch<S>& scratch) {
  find_pieces(f, scratch.breaks, scratch.pieces);
  const auto section_area = [&](const S& theta) {
    const auto [s, c] = sincos(theta);
    return area(f, section(f, s, c));
  };
  Integral<S> result = integrate<S>(section_area, scratch.pieces, tolerance, area_roundoff(f.g), scratch.integrals);
  result.value *= S(2.0);  // even in theta
  result.error *= 2;
  return result;
}

/// Section areas at one theta >= 0, integrated over y in [0, L0/2] [m^3]. The area depends on y through the two depths
/// alone, so its kinks in y are known: where a limb's stroke begins to cut, where its depth or the difference of both
/// overtakes an end of delta, and where the nearer end of the rail changes. With r_j = Z_low - Delta_j, the points
/// (H_j, r_j) lie on a circle of radius l_u; where both strokes cut, a given difference r_1 - r_2 is a chord of it.
template <class S>
S area_over_y(const Frame<S>& f, Section<S> t, const GaussRule& rule) {
  const Geometry<S>& g = f.g;
  const S middle = g.L0 * 0.5, shift = g.a * t.sin_theta * 0.5, from = f.l.h_min + shift;
  std::array<S, 24> y;
  std::size_t n = 0;
  const auto add = [&](const S& value) {
    if (value_of(value) > value_of(from) && value_of(value) < value_of(middle)) y[n++] = value;
  };
  const auto add_stroke = [&](const S& H) {  // H_1 = y - shift, H_2 = min(y + shift, L0 - y - shift)
    add(H + shift);
    add(H - shift);
    add(g.L0 - H - shift);
  };
  add_stroke(f.stroke_free);
  for (const S& end : {t.delta_end, t.delta_low}) {
    if (!(value_of(end) > 0)) continue;
    const S rest = f.z_low - end, above = f.z_high + end;
    if (value_of(rest) > value_of(f.z_high)) {
      add_stroke(sqrt_or_zero(S((g.l_u - rest) * (g.l_u + rest))));     // Delta_j = end
      add(sqrt_or_zero(S((g.l_u - above) * (g.l_u + above))) + shift);  // Delta_2 - Delta_1 = end, H_2 does not cut
    }
    const auto offset = [&](const S& width) {  // of the middle of a chord with components (width, end)
      const S square = width * width + end * end;
      return S(end * sqrt_or_zero(S(g.l_u * g.l_u / square - 0.25)));
    };
    add(offset(S(shift * 2.0)));                  // H_2 - H_1 = 2 shift
    add(middle - offset(S(g.L0 - shift * 2.0)));  // H_1 + H_2 = L0 - 2 shift
  }
  add(middle - shift);
  if (!(value_of(middle) > value_of(from))) return S(0.0);
  std::sort(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(n),
            [](const S& p, const S& q) { return value_of(p) < value_of(q); });
  y[n++] = middle;
  S sum(0.0), lower = from;
  for (std::size_t i = 0; i < n; lower = y[i++]) {
    const S length = y[i] - lower;
    if (!(value_of(length) > 0)) continue;
    set_depths(f, S(lower + length * 0.5), t);
    const double full = value_of(f.z_low - f.z_high);
    if (value_of(t.depth[0]) == full && value_of(t.depth[1]) == full) {  // the stroke does not cut here
      sum += area(f, t) * length;
      continue;
    }
    visit_nodes(Piece<S>{lower, y[i], true, true}, rule, [&](const S& at, const S& jacobian, double weight) {
      set_depths(f, at, t);
      sum += area(f, t) * jacobian * weight;
    });
  }
  return sum;
}

/// Volume integrated over y [m^3 rad]; theta and y each in the half that symmetry leaves.
template <class S>
Integral<S> volume_over_y(const Geometry<S>& g, const Limits<S>& l, double tolerance, ColumnScratch<S>& scratch) {
  static const GaussRule rule = gauss_legendre(20);
  const Frame<S> f = frame(g, l, S(g.L0 * 0.5));
  find_pieces(f, scratch.breaks, scratch.pieces);
  const auto areas = [&](const S& theta) {
    const auto [s, c] = sincos(theta);
    const Section<S> t = section_range(f, s, c);
    return t.empty ? S(0.0) : area_over_y(f, t, rule);
  };
  Integral<S> result =
      integrate<S>(areas, scratch.pieces, tolerance, area_roundoff(g) * value_of(g.L0), scratch.integrals);
  result.value *= S(4.0);
  result.error *= 4;
  return result;
}

/// The pieces of a half section's delta on which the length of columns is smooth: up to the knee and beyond it, or what
/// a clearance limit leaves of them.
template <class S>
void feasible_ranges(const Frame<S>& f, const Section<S>& t, const Half<S>& h, std::size_t leaning,
                     const ClearanceTest* test, ColumnScratch<S>& scratch) {
  scratch.ranges.clear();
  for (const auto& [low, high] : {std::pair{h.low, h.knee}, std::pair{h.knee, h.end}}) {
    if (!(value_of(high) > value_of(low))) continue;
    if constexpr (std::is_same_v<S, double>) {
      if (test) {
        for (const Part& range : test->clear_ranges(f, t, h, leaning, low, high, scratch.clearance))
          scratch.ranges.push_back({range.lower, range.upper});
        continue;
      }
    }
    scratch.ranges.push_back({low, high});
  }
}

/// The parts of one column's z interval that carry samples: all of it, or those on which links are clear.
template <class S>
void feasible_parts(const Frame<S>& f, const Section<S>& t, const Column<S>& column, const ClearanceTest* test,
                    ColumnScratch<S>& scratch) {
  scratch.parts.clear();
  if constexpr (std::is_same_v<S, double>) {
    if (test) {
      for (const Part& part : test->clear_parts(f, t, column, scratch.clearance))
        scratch.parts.push_back({part.lower, part.upper, true, true});
      return;
    }
  }
  scratch.parts.push_back({S(0.0), column.length, true, true});
}

/// What samples are to hold.
template <class S>
struct SampleContents {
  bool conditioning = false, poses = false, inertia = false;
  S gamma{};           ///< a / (2 L_c)
  Masses<S> masses{};  ///< where inertia counts

  bool told_apart() const { return inertia || poses; }
};

/// A survey that takes samples, its field looked up once for all of them.
template <class S>
struct Sampled {
  explicit Sampled(Survey<S>& to) : survey(to), conditioning(to.find(kConditioning)) {}
  Survey<S>& survey;
  std::vector<S>* conditioning;  ///< null where it was not demanded
};

/// Adds one sample of what was demanded.
/// @param inertia   of inertia_values()
/// @param mirrored  the pose is that of `inertia` with theta -> -theta (mirrored in y): the two sliders of each rail
///                  change places
template <class S>
void add_sample(const SampleContents<S>& contents, const S& weight, const Pose<S>& pose, const S& conditioning,
                const std::vector<S>& inertia, bool mirrored, const Sampled<S>& to) {
  to.survey.weight.push_back(weight);
  if (to.conditioning) to.conditioning->push_back(conditioning);
  if (contents.poses) to.survey.pose.push_back(pose);
  if (contents.inertia) add_inertia(inertia, mirrored, to.survey);
}

/// Which of the two planes y and L0 - y are sampled, where y <= L0/2 is the frame's.
enum class Planes { near, far, both };

/// The poses that a node stands for. The section at -theta is that at theta mirrored in x = b/2; where both limbs have
/// the same depth, each section is symmetric itself; and the plane L0 - y has, at -theta, the section of the plane y.
/// Conditioning is the same at all of them, so one sample carries their weight together. Coupling indices change
/// joints, and poses are told apart, so that then every pose has a sample of its own.
struct Images {
  bool symmetric;  ///< the half of the section that the node does not lie in is meant too
  Planes planes;

  double count() const { return (symmetric ? 4.0 : 2.0) * (planes == Planes::both ? 2.0 : 1.0); }
};

/// A node of a plane's section.
template <class S>
struct Node {
  S theta, sin_theta, cos_theta;
  std::array<S, 2> x, sigma, z_c;  ///< of the two limbs [m]
};

template <class S>
void add_samples(const Frame<S>& f, const SampleContents<S>& contents, const Images& images, const S& weight,
                 const Node<S>& n, const S& index, std::array<std::vector<S>, 2>& inertia, const Sampled<S>& to) {
  const Geometry<S>& g = f.g;
  auto& [here, across] = inertia;
  if (!contents.told_apart()) {
    add_sample(contents, S(weight * images.count()), {}, index, here, false, to);
    return;
  }
  const auto find = [&](const std::array<S, 2>& at_x, const std::array<S, 2>& sigma, const std::array<S, 2>& z_c,
                        std::vector<S>& values) {
    if (contents.inertia)
      inertia_values(joint_inertia(g, contents.masses, n.sin_theta, n.cos_theta, at_x, sigma, z_c), to.survey, values);
  };
  find(n.x, n.sigma, n.z_c, here);
  find({n.x[1], n.x[0]}, {n.sigma[1], n.sigma[0]}, {n.z_c[1], n.z_c[0]}, across);
  const S x = n.x[0] + g.a * n.cos_theta * 0.5, x_across = g.b - x, z = n.z_c[0] - n.sigma[0] - g.d;
  for (const Planes plane : {Planes::near, Planes::far}) {
    if (images.planes != Planes::both && images.planes != plane) continue;
    const S y = plane == Planes::near ? f.y : S(g.L0 - f.y);
    if (images.symmetric || plane == Planes::near) {
      add_sample(contents, weight, {x, y, z, n.theta}, index, here, false, to);
      add_sample(contents, weight, {x_across, y, z, S(-n.theta)}, index, across, true, to);
    }
    if (images.symmetric || plane == Planes::far) {
      add_sample(contents, weight, {x, y, z, S(-n.theta)}, index, here, true, to);
      add_sample(contents, weight, {x_across, y, z, n.theta}, index, across, false, to);
    }
  }
}

/// Weighted samples over one plane or both: Gauss nodes in theta, delta and z on every smooth piece. Their weights,
/// over `weight`, add up to the planes' volumes within the rule's accuracy.
/// @param test  what a clearance limit leaves to be tested pose by pose, or null
template <class S>
void sample(const Frame<S>& f, const SampleContents<S>& contents, Planes planes, const S& weight,
            const GaussRule& theta_rule, const GaussRule& inner_rule, const ClearanceTest* test,
            ColumnScratch<S>& scratch, Survey<S>& survey) {
  find_pieces(f, scratch.breaks, scratch.pieces);
  const Sampled<S> to(survey);
  visit_nodes(scratch.pieces, theta_rule, [&](const S& theta, const S& theta_jacobian, double theta_weight) {
    const auto [sine, cosine] = sincos(theta);
    const S &s = sine, &c = cosine;
    const Section<S> t = section(f, s, c);
    if (t.empty) return;
    const Images images{value_of(t.depth[0]) == value_of(t.depth[1]), planes};
    for (std::size_t leaning = 0; leaning < (images.symmetric ? 1u : 2u); ++leaning) {
      const Half<S> h = half_section(t, leaning);
      if (h.empty) continue;
      const S outer = weight * theta_jacobian * theta_weight;
      feasible_ranges(f, t, h, leaning, test, scratch);
      visit_nodes(scratch.ranges, inner_rule, [&](const S& delta, const S& delta_jacobian, double delta_weight) {
        const Column<S> col = column(f, t, h, leaning, delta);
        feasible_parts(f, t, col, test, scratch);
        for (const Piece<S>& part : scratch.parts) {
          ColumnConditioning<S>& poses = scratch.poses;
          poses.clear();
          visit_nodes(part, inner_rule,
                      [&](const S& rise, const S&, double) { poses.add(col.z_c(f, rise, 0), col.z_c(f, rise, 1)); });
          if (contents.conditioning) poses.compute({f.g.l_u, contents.gamma, s, c, col.x, col.sigma});
          std::size_t n = 0;
          visit_nodes(part, inner_rule, [&](const S&, const S& jacobian, double z_weight) {
            const S each = outer * col.slope * delta_jacobian * jacobian * (delta_weight * z_weight);
            const Node<S> node{theta, s, c, col.x, col.sigma, {poses.z_c[0][n], poses.z_c[1][n]}};
            add_samples(f, contents, images, each, node, contents.conditioning ? poses.index[n] : S(0.0),
                        scratch.inertia, to);
            ++n;
          });
        }
      });
    }
  });
}

}  // namespace pkm::four_ppa_two_par
