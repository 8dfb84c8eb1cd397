#include "engine/mechanisms/hybrid_voxels.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::hybrid {

namespace {

bool inside(double value, double lower, double upper) { return value >= lower && value <= upper; }

bool links_clear(const VoxelDesign& design, const Pose<double>& pose) {
  const Geometry<double>& g = design.frame.g;
  const Links<double> link = links(g, pose, inverse(g, pose, design.frame.signs), shaft(g, pose));
  return std::ranges::all_of(kPairs, [&](const LinkPair& pair) {
    return capsule_distance(link[pair.first], link[pair.second]) >= *design.clearance;
  });
}

}  // namespace

// The margins of hybrid_limits.hpp, cheap ones first, as comparisons of squares and of products with cosines.
bool feasible(const VoxelDesign& design, double x, double z, double beta) {
  const Frame<double>& f = design.frame;
  const Geometry<double>& g = f.g;
  const Limits<double>& l = f.l;
  const auto square = [](double value) { return value * value; };

  // limbs A and B
  if (!(z > 0 && z >= l.z_clear && inside(beta, l.beta_min, l.beta_max))) return false;
  const double A2 = (g.L1 - z) * (g.L1 + z), B2 = (g.L2 - z) * (g.L2 + z);  // n1^2, n2^2
  const double least = square(l.tau_s), greatest_A = square(l.psiA.sin), greatest_C = square(l.psiC.sin);
  if (!inside(A2, least * square(g.L1), greatest_A * square(g.L1))) return false;
  if (!inside(B2, least * square(g.L2), greatest_A * square(g.L2))) return false;
  const double n1 = f.signs[0] * std::sqrt(A2), n2 = f.signs[1] * std::sqrt(B2);
  if (!inside(x - n1, f.lo[0], f.hi[0]) || !inside(x - n2, f.lo[1], f.hi[1])) return false;
  if (!(z * std::fabs(n1 - n2) >= l.tau_p * g.L1 * g.L2 && g.a * 2 + n1 - n2 >= l.gap)) return false;

  // the shaft w of the auxiliary chain
  const auto [sin_b, cos_b] = sincos(beta);
  const double w_y = g.fp * cos_b + g.h2 * sin_b - g.f, Q = z + g.fp * sin_b - g.h2 * cos_b - g.h1;
  const double P = (z - g.h1) * cos_b + g.f * sin_b - g.h2, w2 = x * x + w_y * w_y + Q * Q;
  if (!inside(w2, square(l.lw_min), square(l.lw_max))) return false;
  if (!(Q > 0 && P > 0 && std::fmin(Q * Q, P * P) >= square(l.phi.cos) * w2)) return false;

  // limb C
  const double k = g.e * cos_b - g.d, N1 = z + g.e * sin_b, across2 = k * k + N1 * N1, L2 = g.L3 * g.L3;
  const double C2 = L2 - across2;  // n3^2
  if (!(N1 >= l.z_clear && inside(C2, least * L2, greatest_C * L2))) return false;
  if (!inside(x - f.signs[2] * std::sqrt(C2), f.lo[2], f.hi[2])) return false;
  if (!((z * cos_b + g.d * sin_b) * design.branch >= l.tau_p * g.L3)) return false;
  const double across = std::sqrt(across2);
  if (!(-k * f.side >= l.tau_c * across && std::fabs(k) * f.lam.cos <= N1 * f.lam.sin)) return false;
  if (!(N1 * cos_b - k * sin_b >= f.mu.cos * across)) return false;
  return !design.clearance || links_clear(design, {x, 0, z, beta});
}

Box default_box(const VoxelDesign& design) {
  const Frame<double>& f = design.frame;
  const Geometry<double>& g = f.g;
  const Limits<double>& l = f.l;
  const Box some = {{{-g.L1, g.L1}, {0, g.L1}, {l.beta_min, l.beta_max}}};
  if (f.empty) return some;
  // the range of n = sign |n| for |n| in [low, high]
  const auto signed_range = [](double low, double high, int sign) {
    return sign > 0 ? std::array{low, high} : std::array{-high, -low};
  };
  const auto along = [&](double L, double z) { return std::sqrt(std::fmax(0, (L - z) * (L + z))); };
  const std::array<std::array<double, 2>, 3> n = {signed_range(along(g.L1, f.z_high), along(g.L1, f.z_low), f.signs[0]),
                                                  signed_range(along(g.L2, f.z_high), along(g.L2, f.z_low), f.signs[1]),
                                                  signed_range(l.tau_s * g.L3, g.L3 * l.psiC.sin, f.signs[2])};
  const double shaft = l.lw_max * l.phi.sin;
  Box box = {{{-shaft, shaft}, {f.z_low, f.z_high}, {l.beta_min, l.beta_max}}};
  for (std::size_t i = 0; i < 3; ++i) {
    box[0][0] = std::fmax(box[0][0], f.lo[i] + n[i][0]);
    box[0][1] = std::fmin(box[0][1], f.hi[i] + n[i][1]);
  }
  // limb C reaches no point of the platform's circle beyond the angle K from the line through its rail
  const double k0 = g.e * g.e - g.L3 * g.L3 * (1 - l.tau_s * l.tau_s);
  const double near = std::hypot(g.d, f.z_low), far = std::hypot(g.d, f.z_high);
  const double r = k0 > 0 ? std::clamp(std::sqrt(k0), near, far) : near;
  const double K = (r * r + k0) / (2 * g.e * r);
  box[2][0] = std::fmax(box[2][0], -atan2(f.z_high, g.d));
  box[2][1] = K < 1 ? std::fmin(box[2][1], acos(std::fmax(K, -1)) - atan2(f.z_low, g.d)) : box[2][0];
  for (const auto& [low, high] : box)
    if (!(low < high)) return some;
  return box;
}

VoxelColumns::VoxelColumns(const VoxelDesign& design, const VoxelGrid& grid) : design_(design), grid_(grid) {
  const auto n = static_cast<std::size_t>(grid.cells[1]);
  for (auto* runs : {&first_, &hole_, &after_, &end_}) runs->resize(n);
  for (auto* list : {&z_, &left_, &right_}) list->resize(n);
  const Frame<double>& f = design.frame;
  for (std::size_t j = 0; j < n; ++j) {
    const double z = grid.centre(1, static_cast<std::int64_t>(j));
    const double n1 = f.signs[0] * root_or_zero((f.g.L1 - z) * (f.g.L1 + z));
    const double n2 = f.signs[1] * root_or_zero((f.g.L2 - z) * (f.g.L2 + z));
    z_[j] = z;
    left_[j] = max(f.lo[0] + n1, f.lo[1] + n2);
    right_[j] = min(f.hi[0] + n1, f.hi[1] + n2);
  }
}

void VoxelColumns::fill(std::int64_t k) {
  const Frame<double>& f = design_.frame;
  const double beta = grid_.centre(2, k);
  first_z_ = end_z_ = 0;
  if (f.empty || beta < f.l.beta_min || beta > f.l.beta_max) return;
  const Section<double> s = section(f, beta);
  const double low = *std::ranges::max_element(s.lower), high = *std::ranges::min_element(s.upper);
  first_z_ = std::ranges::lower_bound(z_, low) - z_.begin();
  end_z_ = std::max<std::int64_t>(first_z_, std::ranges::upper_bound(z_, high) - z_.begin());
  const Curve<double> C = s.curve[kCurveC], Q = s.curve[kCurveQ], P = s.curve[kCurveP], L = s.curve[kCurveL],
                      H = s.curve[kCurveH];
  const double sign = s.sign_hi[kCurveC], lo_C = s.lo[kCurveC], hi_C = s.hi[kCurveC];
  const double per_cell = 1 / grid_.step[0], cells = static_cast<double>(grid_.cells[0]);
  const double offset = -grid_.lower[0] * per_cell - 0.5;  // x = 0 in units of cells from the first centre
  const auto square = [](const Curve<double>& c, double z) { return (c.a + c.a_z * z) * (c.b + c.b_z * z); };
  const double hole_end = s.hole_end;
  for (auto j = static_cast<std::size_t>(first_z_); j < static_cast<std::size_t>(end_z_); ++j) {
    const double z = z_[j], C2 = square(C, z), Q2 = square(Q, z), P2 = square(P, z), L2 = square(L, z),
                 H2 = square(H, z);
    const double n3 = sign * std::sqrt(C2 > 0 ? C2 : 0);
    const double QP2 = Q2 < P2 ? Q2 : P2, X2 = QP2 < L2 ? QP2 : L2;
    const double x = std::sqrt(X2 > 0 ? X2 : 0), inside = std::sqrt(((H2 > 0) & (z < hole_end)) ? H2 : 0);
    const double left_C = lo_C + n3, right_C = hi_C + n3;
    double left = left_[j] > left_C ? left_[j] : left_C, right = right_[j] < right_C ? right_[j] : right_C;
    left = left > -x ? left : -x;
    right = right < x ? right : x;
    // in cells: ends as the first centre at or above and the one after the last at or below; the hole is open
    double from = std::ceil(left * per_cell + offset), to = std::floor(right * per_cell + offset) + 1;
    double out = std::floor(-inside * per_cell + offset) + 1, in = std::ceil(inside * per_cell + offset);
    from = from > 0 ? from : 0;
    to = to < cells ? to : cells;
    to = to > from ? to : from;
    from = from < to ? from : to;
    out = out < in ? out : to;  // no hole
    in = out < in ? in : to;
    out = out > from ? out : from;
    out = out < to ? out : to;
    in = in > out ? in : out;
    in = in < to ? in : to;
    first_[j] = static_cast<std::int32_t>(from);
    hole_[j] = static_cast<std::int32_t>(out);
    after_[j] = static_cast<std::int32_t>(in);
    end_[j] = static_cast<std::int32_t>(to);
  }
}

bool VoxelColumns::clear(double x, double z, double beta, bool along_x) const {
  const Frame<double>& f = design_.frame;
  const Pose<double> pose{x, 0, z, beta};
  const Links<double> link = links(f.g, pose, inverse(f.g, pose, f.signs), shaft(f.g, pose));
  for (const auto& [first, second] : kPairs) {
    const bool moves = first == kLinkF || second == kLinkF;  // the others move along x together
    if (moves == along_x && !(capsule_distance(link[first], link[second]) >= *design_.clearance)) return false;
  }
  return true;
}

}  // namespace pkm::hybrid
