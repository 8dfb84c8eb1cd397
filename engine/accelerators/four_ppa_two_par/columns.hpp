// 4PPa-2PaR: exact volumes and weighted samples, by quadrature over theta of the closed-form areas of slices.
#pragma once

#include <type_traits>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"
#include "engine/accelerators/four_ppa_two_par/coupling.hpp"
#include "engine/accelerators/four_ppa_two_par/theta_intervals.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm::four_ppa_two_par {

/// Scratch memory of one workspace analysis.
template <class S>
struct ColumnScratch {
  std::vector<CriticalValue<S>> critical_values;
  std::vector<Subinterval<S>> intervals;  ///< intervals of theta on which the area of the slice is smooth
  std::vector<QuadratureCell<S>> integrals;
  std::vector<Subinterval<S>> deltas, heights;  ///< intervals of delta within a slice, and of z within a column
  ClearanceScratch clearance;
  ColumnConditioning<S> poses;
  std::array<std::vector<S>, 2> inertia;  ///< inertia fields at a pose, and at its mirror image in x = b/2
};

/// Estimate of the rounding error of the area of a slice [m^2], which is a difference of terms of the size l_d (l_d +
/// l_u).
template <class S>
double area_roundoff(const Geometry<S>& g) {
  return 1e-15 * value_of(g.l_d) * (value_of(g.l_d) + value_of(g.l_u));
}

/// Volume of the workspace on the plane y of the design [m^2 rad].
template <class S>
Integral<S> plane_volume(const SlicedDesign<S>& d, double tolerance, ColumnScratch<S>& scratch) {
  find_theta_intervals(d, scratch.critical_values, scratch.intervals);
  const auto slice_area = [&](const S& theta) {
    const auto [s, c] = sincos(theta);
    return area(d, slice(d, s, c));
  };
  Integral<S> result = integrate<S>(slice_area, scratch.intervals, tolerance, area_roundoff(d.g), scratch.integrals);
  result.value *= S(2.0);  // the volume of theta < 0 equals that of theta > 0
  result.error *= 2;
  return result;
}

/// Integral over y in [0, L0/2] of the areas of slices at one theta >= 0 [m^3]. The area depends on y only through the
/// two depths. Its critical values in y therefore have a closed form; they are the y at which the stroke of a limb
/// begins to limit z, the depth of a limb or the difference of both depths equals a bound of delta, or the nearer end
/// of the rail changes. With r_j = Z_low - Delta_j, the points (H_j, r_j) are on a circle of radius l_u; if both
/// strokes limit z, a given difference r_1 - r_2 defines a chord of this circle.
template <class S>
S area_over_y(const SlicedDesign<S>& d, Slice<S> t, const GaussRule& rule) {
  const Geometry<S>& g = d.g;
  const S middle = g.L0 * 0.5, shift = g.a * t.sin_theta * 0.5, from = d.l.h_min + shift;
  std::array<S, 24> y;
  std::size_t n = 0;
  const auto add = [&](const S& value) {
    if (value_of(value) > value_of(from) && value_of(value) < value_of(middle)) y[n++] = value;
  };
  // H_1 = y - shift, H_2 = min(y + shift, L0 - y - shift): strokes of the two limbs on their shorter sides
  const auto add_stroke = [&](const S& H) {
    add(H + shift);
    add(H - shift);
    add(g.L0 - H - shift);
  };
  add_stroke(d.stroke_free);
  for (const S& end : {t.delta_end, t.delta_low}) {
    if (!(value_of(end) > 0)) continue;
    const S rest = d.z_low - end, above = d.z_high + end;
    if (value_of(rest) > value_of(d.z_high)) {
      add_stroke(sqrt_or_zero(S((g.l_u - rest) * (g.l_u + rest))));  // value at which Delta_j equals the end of delta
      // The y at which Delta_2 - Delta_1 equals the bound `end` of delta, if the stroke of limb 2 does not limit z.
      add(sqrt_or_zero(S((g.l_u - above) * (g.l_u + above))) + shift);
    }
    const auto offset = [&](const S& width) {  // H of the midpoint of a chord whose components are (width, end)
      const S square = width * width + end * end;
      return S(end * sqrt_or_zero(S(g.l_u * g.l_u / square - 0.25)));
    };
    add(offset(S(shift * 2.0)));                  // value at which H_2 - H_1 = 2 shift
    add(middle - offset(S(g.L0 - shift * 2.0)));  // value at which H_1 + H_2 = L0 - 2 shift
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
    set_depths(d, S(lower + length * 0.5), t);
    const double full = value_of(d.z_low - d.z_high);
    // Where both depths are `full`, the strokes do not limit z in this interval of y.
    if (value_of(t.depth[0]) == full && value_of(t.depth[1]) == full) {
      sum += area(d, t) * length;
      continue;
    }
    visit_nodes(Subinterval<S>{lower, y[i], true, true}, rule, [&](const S& at, const S& jacobian, double weight) {
      set_depths(d, at, t);
      sum += area(d, t) * jacobian * weight;
    });
  }
  return sum;
}

/// Volume integrated over y [m^3 rad]. By symmetry, it is 4 times the volume of theta >= 0 and y <= L0/2.
template <class S>
Integral<S> volume_over_y(const Geometry<S>& g, const Limits<S>& l, double tolerance, ColumnScratch<S>& scratch) {
  static const GaussRule rule = gauss_legendre(20);
  const SlicedDesign<S> d = sliced_design(g, l, S(g.L0 * 0.5));
  find_theta_intervals(d, scratch.critical_values, scratch.intervals);
  const auto areas = [&](const S& theta) {
    const auto [s, c] = sincos(theta);
    const Slice<S> t = slice_range(d, s, c);
    return t.empty ? S(0.0) : area_over_y(d, t, rule);
  };
  Integral<S> result =
      integrate<S>(areas, scratch.intervals, tolerance, area_roundoff(g) * value_of(g.L0), scratch.integrals);
  result.value *= S(4.0);
  result.error *= 4;
  return result;
}

/// Finds the intervals of delta in a half slice on which the length of columns is smooth. They lie below and above
/// HalfSlice::knee, up to which the length is constant, and exclude the parts in which a clearance limit is violated.
/// @param scratch  receives the intervals in `deltas`
template <class S>
void find_delta_intervals(const SlicedDesign<S>& d, const Slice<S>& t, const HalfSlice<S>& h, std::size_t leaning,
                          const ClearanceTest* test, ColumnScratch<S>& scratch) {
  scratch.deltas.clear();
  for (const auto& [low, high] : {std::pair{h.low, h.knee}, std::pair{h.knee, h.end}}) {
    if (!(value_of(high) > value_of(low))) continue;
    if constexpr (std::is_same_v<S, double>) {
      if (test) {
        for (const ClosedInterval& clear : test->clear_deltas(d, t, h, leaning, low, high, scratch.clearance))
          scratch.deltas.push_back({clear.lower, clear.upper});
        continue;
      }
    }
    scratch.deltas.push_back({low, high});
  }
}

/// Calls visit(half, leaning, images) for both halves of a slice (images = 1), or, if they are symmetric, for one half
/// that represents both (images = 2). Each call finds the result of find_delta_intervals() in scratch.deltas.
template <class S, class Visit>
void visit_halves(const SlicedDesign<S>& d, const Slice<S>& t, const ClearanceTest* test, ColumnScratch<S>& scratch,
                  const Visit& visit) {
  if (t.empty) return;
  const bool symmetric = value_of(t.depth[0]) == value_of(t.depth[1]);
  for (std::size_t leaning = 0; leaning < (symmetric ? 1u : 2u); ++leaning) {
    const HalfSlice<S> h = half_slice(t, leaning);
    if (h.empty) continue;
    find_delta_intervals(d, t, h, leaning, test, scratch);
    visit(h, leaning, symmetric ? 2.0 : 1.0);
  }
}

/// Finds the feasible intervals of z in a column: the whole column or, with a clearance test, the parts in which the
/// links are clear.
/// @param scratch  receives the intervals in `heights`
template <class S>
void find_height_intervals(const SlicedDesign<S>& d, const Slice<S>& t, const Column<S>& column,
                           const ClearanceTest* test, ColumnScratch<S>& scratch) {
  scratch.heights.clear();
  if constexpr (std::is_same_v<S, double>) {
    if (test) {
      for (const ClosedInterval& clear : test->clear_heights(d, t, column, scratch.clearance))
        scratch.heights.push_back({clear.lower, clear.upper, true, true});
      return;
    }
  }
  scratch.heights.push_back({S(0.0), column.length, true, true});
}

/// Selects the values that each sample of a workspace analysis contains, and provides the data from which they are
/// computed.
template <class S>
struct SampleContents {
  bool conditioning = false, poses = false, inertia = false;
  S gamma{};           ///< ratio a / (2 L_c), with the characteristic length L_c
  Masses<S> masses{};  ///< masses of the design; set only if the inertia is requested

  /// Returns true if mirrored poses need separate samples, because their inertia or coordinates differ.
  bool distinguishes_images() const { return inertia || poses; }
};

/// The result of a workspace analysis to which samples are added.
template <class S>
struct SampleTarget {
  explicit SampleTarget(WorkspaceResult<S>& to) : workspace(to), conditioning(to.find(kConditioning)) {}
  WorkspaceResult<S>& workspace;
  std::vector<S>* conditioning;  ///< values of the conditioning; null if it is not requested
};

/// Adds one sample to the result.
/// @param inertia   result of inertia_values() at the pose
/// @param mirrored  true: adds the inertia of the mirror image of that pose, in which the sliders of each rail are
/// exchanged
template <class S>
void add_sample(const SampleContents<S>& contents, const S& weight, const Pose<S>& pose, const S& conditioning,
                const std::vector<S>& inertia, bool mirrored, const SampleTarget<S>& to) {
  to.workspace.weight.push_back(weight);
  if (to.conditioning) to.conditioning->push_back(conditioning);
  if (contents.poses) to.workspace.pose.push_back(pose);
  if (contents.inertia) add_inertia(inertia, mirrored, to.workspace);
}

/// Selects the planes to be sampled: y (near), L0 - y (far) or both, where y <= L0/2 is the plane of the design.
enum class Planes { near, far, both };

/// Adds weighted samples of one plane or of both planes: the nodes of a Gauss rule in theta, delta and z on every
/// interval on which the integrand is smooth. The sum of the weights approximates `weight` times the volume of the
/// planes.
///
/// A node represents its mirror images. The slice at -theta is the mirror image in x = b/2 of the slice at theta. If
/// both limbs have the same depth, each slice is symmetric. The slice of the plane L0 - y at -theta is that of the
/// plane y at theta. All images have the same conditioning, so one sample with their total weight is sufficient. If
/// inertia or poses are requested, every image is a separate sample, because the inertia is permuted among the joints,
/// and the poses differ.
/// @param test  clearance test of poses; null: links may collide
template <class S>
void sample(const SlicedDesign<S>& d, const SampleContents<S>& contents, Planes planes, const S& weight,
            const GaussRule& theta_rule, const GaussRule& inner_rule, const ClearanceTest* test,
            ColumnScratch<S>& scratch, WorkspaceResult<S>& workspace) {
  const Geometry<S>& g = d.g;
  const SampleTarget<S> to(workspace);
  std::vector<S>&inertia = scratch.inertia[0], &inertia_across = scratch.inertia[1];
  const auto add_images = [&](const S& own_weight, const S& theta, const SinCosOf<S>& turn, const Column<S>& col,
                              const std::array<S, 2>& z_c, const S& index, bool symmetric) {
    const auto find_inertia = [&](const Column<S>& at, const std::array<S, 2>& at_z_c, std::vector<S>& values) {
      inertia_values(joint_inertia(g, contents.masses, turn.sin, turn.cos, at.x, at.sigma, at_z_c), workspace, values);
    };
    if (contents.inertia) {
      find_inertia(col, z_c, inertia);
      find_inertia({.x = {col.x[1], col.x[0]}, .sigma = {col.sigma[1], col.sigma[0]}}, {z_c[1], z_c[0]},
                   inertia_across);
    }
    const S x = col.x[0] + g.a * turn.cos * 0.5, x_across = g.b - x, z = z_c[0] - col.sigma[0] - g.d;
    for (const Planes plane : {Planes::near, Planes::far}) {
      if (planes != Planes::both && planes != plane) continue;
      const S y = plane == Planes::near ? d.y : S(g.L0 - d.y);
      if (symmetric || plane == Planes::near) {
        add_sample(contents, own_weight, {x, y, z, theta}, index, inertia, false, to);
        add_sample(contents, own_weight, {x_across, y, z, S(-theta)}, index, inertia_across, true, to);
      }
      if (symmetric || plane == Planes::far) {
        add_sample(contents, own_weight, {x, y, z, S(-theta)}, index, inertia, true, to);
        add_sample(contents, own_weight, {x_across, y, z, theta}, index, inertia_across, false, to);
      }
    }
  };
  find_theta_intervals(d, scratch.critical_values, scratch.intervals);
  visit_nodes(scratch.intervals, theta_rule, [&](const S& theta, const S& theta_jacobian, double theta_weight) {
    const SinCosOf<S> turn = sincos(theta);
    const Slice<S> t = slice(d, turn.sin, turn.cos);
    visit_halves(d, t, test, scratch, [&](const HalfSlice<S>& h, std::size_t leaning, double halves) {
      const double images = 2 * halves * (planes == Planes::both ? 2.0 : 1.0);
      const S outer = weight * theta_jacobian * theta_weight;
      visit_nodes(scratch.deltas, inner_rule, [&](const S& delta, const S& delta_jacobian, double delta_weight) {
        const Column<S> col = column(d, t, h, leaning, delta);
        find_height_intervals(d, t, col, test, scratch);
        for (const Subinterval<S>& interval : scratch.heights) {
          ColumnConditioning<S>& poses = scratch.poses;
          poses.clear();
          visit_nodes(interval, inner_rule,
                      [&](const S& rise, const S&, double) { poses.add(col.z_c(d, rise, 0), col.z_c(d, rise, 1)); });
          if (contents.conditioning) poses.compute({g.l_u, contents.gamma, turn.sin, turn.cos, col.x, col.sigma});
          std::size_t n = 0;
          visit_nodes(interval, inner_rule, [&](const S&, const S& jacobian, double z_weight) {
            const S each = outer * col.derivative * delta_jacobian * jacobian * (delta_weight * z_weight);
            const S index = contents.conditioning ? poses.index[n] : S(0.0);
            if (contents.distinguishes_images())
              add_images(each, theta, turn, col, {poses.z_c[0][n], poses.z_c[1][n]}, index, halves == 2);
            else
              add_sample(contents, S(each * images), {}, index, inertia, false, to);
            ++n;
          });
        }
      });
    });
  });
}

}  // namespace pkm::four_ppa_two_par
