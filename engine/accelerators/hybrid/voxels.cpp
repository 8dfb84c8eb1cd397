#include "engine/accelerators/hybrid/voxels.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::hybrid {

Box default_box(const SlicedDesign<double>& d) {
  const Geometry<double>& g = d.g;
  const Limits<double>& l = d.l;
  const Box any = {{{-g.L1, g.L1}, {0, g.L1}, {l.beta_min, l.beta_max}}};
  if (d.empty) return any;
  // Returns the range of n if n has the given sign and |n| is in [low, high].
  const auto signed_range = [](double low, double high, int sign) {
    return sign > 0 ? std::array{low, high} : std::array{-high, -low};
  };
  const auto along = [&](double L, double z) { return std::sqrt(std::fmax(0, (L - z) * (L + z))); };
  const std::array<std::array<double, 2>, 3> n = {signed_range(along(g.L1, d.z_high), along(g.L1, d.z_low), d.signs[0]),
                                                  signed_range(along(g.L2, d.z_high), along(g.L2, d.z_low), d.signs[1]),
                                                  signed_range(l.tau_s * g.L3, g.L3 * l.psiC.sin, d.signs[2])};
  const double shaft = l.lw_max * l.phi.sin;
  Box box = {{{-shaft, shaft}, {d.z_low, d.z_high}, {l.beta_min, l.beta_max}}};
  for (std::size_t i = 0; i < 3; ++i) {
    box[0][0] = std::fmax(box[0][0], d.lo[i] + n[i][0]);
    box[0][1] = std::fmin(box[0][1], d.hi[i] + n[i][1]);
  }
  // The direction to C' differs from that of limb C's rail by at most acos(K), with K below: for larger angles, C' is
  // out of reach of the limb.
  const double k0 = g.e * g.e - g.L3 * g.L3 * (1 - l.tau_s * l.tau_s);
  const double near = std::hypot(g.d, d.z_low), far = std::hypot(g.d, d.z_high);
  const double r = k0 > 0 ? std::clamp(std::sqrt(k0), near, far) : near;
  const double K = (r * r + k0) / (2 * g.e * r);
  box[2][0] = std::fmax(box[2][0], -atan2(d.z_high, g.d));
  box[2][1] = K < 1 ? std::fmin(box[2][1], acos(std::fmax(K, -1)) - atan2(d.z_low, g.d)) : box[2][0];
  for (const auto& [low, high] : box)
    if (!(low < high)) return any;
  return box;
}

void VoxelHeights::fill(const SlicedDesign<double>& d, const VoxelGrid& grid) {
  const auto n = static_cast<std::size_t>(grid.cells[1] + kLanes);
  for (auto* list : {&z, &left, &right}) list->resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const double at = grid.centre(1, static_cast<std::int64_t>(j));
    const double n1 = d.signs[0] * sqrt_or_zero((d.g.L1 - at) * (d.g.L1 + at));
    const double n2 = d.signs[1] * sqrt_or_zero((d.g.L2 - at) * (d.g.L2 + at));
    z[j] = at;
    left[j] = max(d.lo[0] + n1, d.lo[1] + n2);
    right[j] = min(d.hi[0] + n1, d.hi[1] + n2);
  }
}

VoxelColumns::Columns VoxelColumns::find_runs(std::int64_t k, CellRuns& runs) const {
  const SlicedDesign<double>& d = design;
  const double beta = grid.centre(2, k);
  if (d.empty || beta < d.l.beta_min || beta > d.l.beta_max) return {};
  for (auto* list : {&runs.first, &runs.hole, &runs.after, &runs.end}) list->resize(heights.z.size());
  const Slice<double> s = slice(d, beta);
  const double low = *std::ranges::max_element(s.lower), high = *std::ranges::min_element(s.upper);
  const auto begin = heights.z.begin(), end = begin + grid.cells[1];
  const auto first_z = static_cast<std::size_t>(std::lower_bound(begin, end, low) - begin);
  const auto end_z = std::max(first_z, static_cast<std::size_t>(std::upper_bound(begin, end, high) - begin));
  const Edge left_C{kCurveC, kLeft}, right_C{kCurveC, kRight};
  const ColumnsAtBeta columns{.C = s.curve[kCurveC],
                              .Q = s.curve[kCurveQ],
                              .P = s.curve[kCurveP],
                              .L = s.curve[kCurveL],
                              .H = s.curve[kCurveH],
                              .sign = s.sign(right_C),
                              .lo_C = s.constant(left_C),
                              .hi_C = s.constant(right_C),
                              .z_high = high,
                              .hole_end = s.hole_end,
                              .x_lower = grid.lower[0],
                              .x_step = grid.step[0],
                              .cells = static_cast<double>(grid.cells[0]),
                              .z = heights.z.data(),
                              .left = heights.left.data(),
                              .right = heights.right.data(),
                              .first_z = first_z,
                              .end_z = end_z};
  return {first_z, end_z, with_instruction_set([&]<InstructionSet set>() { return fill<set>(columns, runs); })};
}

std::int64_t VoxelColumns::count(std::int64_t k, CellRuns& runs, bool& touches) const {
  const Columns at = find_runs(k, runs);
  const auto has_cells = [&](std::size_t j) {
    return at.first_z <= j && j < at.end_z && runs.hole[j] - runs.first[j] + (runs.end[j] - runs.after[j]) > 0;
  };
  if (at.tally.cells > 0)
    touches = touches || at.tally.touches || grid.at_end(2, k) || has_cells(0) ||
              has_cells(static_cast<std::size_t>(grid.cells[1] - 1));
  return static_cast<std::int64_t>(at.tally.cells);
}

}  // namespace pkm::hybrid
