#include "engine/generic/columns/column.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/generic/columns/planar_slice_sensitivity.hpp"
#include "engine/generic/polynomial.hpp"
#include "engine/math/hash.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kCoefficients = 5;
using Quartic = std::array<double, kCoefficients>;  // coefficients of a polynomial of degree four, in ascending order

/// Coefficients of a polynomial in z, transformed to the variable s in [-1, 1] that stands for z in [from, to].
Quartic in_range(Quartic c, double from, double to) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  for (std::size_t i = 0; i + 1 < kCoefficients; ++i)
    for (std::size_t j = kCoefficients - 1; j-- > i;) c[j] += middle * c[j + 1];
  double power = 1;
  for (double& each : c) {
    each *= power;
    power *= half;
  }
  return c;
}

Quartic coefficients_of(const Surface& surface, std::span<const double> registers) {
  Quartic C;
  for (std::size_t i = 0; i < kCoefficients; ++i) C[i] = registers[surface.coefficients[i]];
  return C;
}

double slope_of(const Quartic& c, double z) { return c[1] + z * (2 * c[2] + z * (3 * c[3] + z * 4 * c[4])); }

EndLabel label_of(std::size_t surface, bool falls) { return static_cast<EndLabel>(2 * surface + (falls ? 1 : 0)); }

}  // namespace

Column::Column(SlicePlan plan) : plan_(std::move(plan)) {
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    const Surface& surface = plan_.surfaces[k];
    if (surface.is_high_degree) high_degree_ |= bit(k);
    if (!surface.is_transcendental) continue;
    transcendental_ |= bit(k);
    curves_.push_back({surface.coefficients[0], surface.coefficients[1]});
    curve_surfaces_.push_back(static_cast<EndLabel>(k));
  }
  positive_literals_ = high_degree_;
  for (const CrankSigns& crank : plan_.formula.cranks)
    positive_literals_ &= ~(crank.at_min | crank.at_max | crank.after_min | crank.before_max);
}

/// Finds the roots along z of the constraints of degree at most two.
/// @param signs  receives the signs of these constraints at the lower end of `range`
/// @param range  receives the range of z in which the column can have feasible points
/// @return false if no point of the column is feasible
bool Column::find_quadratic_roots(std::span<const double> registers, Signs& signs, std::array<double, 2>& range,
                                  ColumnScratch& scratch) const {
  const auto [from, to] = plan_.range.back();
  const double low = registers[from], high = registers[to], beyond = 1e-2 * (high - low);
  if (!(high > low)) return false;
  // Enlarge the range slightly, because the bounds of the box are also constraints, whose roots are `low` and `high`.
  range = {low - beyond, high + beyond};
  std::array<Roots, kMaxSurfaces> roots;
  // is_positive[k]: whether constraint k is positive below all of its roots
  std::array<bool, kMaxSurfaces> is_positive;
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if (((high_degree_ | transcendental_) & bit(k)) != 0) continue;
    const auto& at = plan_.surfaces[k].coefficients;
    const std::array<double, 3> c{registers[at[0]], registers[at[1]], registers[at[2]]};
    roots[k] = roots_of(c);
    is_positive[k] = c[2] != 0 ? c[2] > 0 : roots[k].count > 0 ? c[1] < 0 : c[0] >= 0;
    if ((plan_.formula.all & bit(k)) == 0 || is_positive[k]) continue;
    // Constraint k is negative below its first root, so it is satisfied between two roots or above a single root.
    const auto [r, count] = roots[k];
    if (count == 0 || !(r[0] <= range[1]) || !(count == 1 || r[1] >= range[0])) return false;
    const double rest = count == 2 ? 1e-2 * (r[1] - r[0]) : beyond;
    range[0] = std::max(range[0], r[0] - rest);
    if (count == 2) range[1] = std::min(range[1], r[1] + rest);
  }
  signs = 0;
  scratch.quadratic.clear();
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if (((high_degree_ | transcendental_) & bit(k)) != 0) continue;
    const auto [r, count] = roots[k];
    bool is = is_positive[k];
    std::size_t i = 0;
    for (; i < static_cast<std::size_t>(count) && r[i] <= range[0]; ++i) is = !is;
    if (is) signs |= bit(k);
    for (; i < static_cast<std::size_t>(count) && r[i] < range[1]; ++i, is = !is)
      scratch.quadratic.emplace_back(r[i], label_of(k, is));
  }
  return true;
}

/// Finds the roots of the constraints of degree three and four for z between `from` and `to`.
/// @param signs  receives the signs of these constraints at `from`
void Column::find_high_degree_roots(std::span<const double> registers, double from, double to, Signs& signs,
                                    ColumnScratch& scratch) const {
  scratch.high_degree.clear();
  for (Signs rest = high_degree_; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    const Quartic c = in_range(coefficients_of(plan_.surfaces[k], registers), from, to);
    std::array<double, 8> places{};
    const std::size_t count = sign_changes(c, places);
    // The sign is evaluated between `from` and the first sign change: at `from` itself, rounding may give the opposite
    // of the sign with which sign_changes() starts.
    const double first = 0.5 * (count > 0 ? places[0] - 1 : 0);
    bool is = c[0] + first * (c[1] + first * (c[2] + first * (c[3] + first * c[4]))) >= 0;
    if (is) signs |= bit(k);
    for (std::size_t i = 0; i < count; ++i, is = !is)
      scratch.high_degree.emplace_back(from + 0.5 * (to - from) * (places[i] + 1), label_of(k, is));
  }
  std::sort(scratch.high_degree.begin(), scratch.high_degree.end());
}

/// First-order bound of the rounding error of an endpoint's position: rounding error of the polynomial divided by its
/// slope.
double Column::root_error_bound(const std::pair<double, EndLabel>& end, std::span<const double> registers) const {
  const auto [z, label] = end;
  if (plan_.surfaces[label >> 1U].is_transcendental) return 0;
  const Quartic c = coefficients_of(plan_.surfaces[label >> 1U], registers);
  double size = 0, power = 1;
  for (const double each : c) {
    size += std::fabs(each * power);
    power *= z;
  }
  return 1e-14 * size / (std::fabs(slope_of(c, z)) + 1e-14 * size);
}

/// Removes feasible intervals that are shorter than the error bounds of their endpoints. Of endpoints that coincide,
/// each receives the lowest label, so that the type of the column does not depend on rounding errors.
/// @param tie  endpoints at a distance of at most this coincide in any case
void Column::merge_coincident_roots(std::span<const double> registers, double tie, ColumnScratch& scratch) const {
  const auto are_one = [&](const auto& x, const auto& y) {
    const double distance = std::fabs(x.first - y.first);
    return distance <= tie ||
           (distance <= 1e6 * tie && distance <= root_error_bound(x, registers) + root_error_bound(y, registers));
  };
  std::vector<ColumnScratch::Piece>& pieces = scratch.pieces;
  std::erase_if(pieces, [&](const ColumnScratch::Piece& piece) { return are_one(piece.lower, piece.upper); });
  for (std::size_t i = 1; i < pieces.size();)
    if (are_one(pieces[i - 1].upper, pieces[i].lower)) {
      pieces[i - 1].upper = pieces[i].upper;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  const Ends& all = scratch.ends;  // all sign changes of the column, in ascending order of z
  for (ColumnScratch::Piece& piece : pieces) {
    if (is_long(scratch)) check_stop();
    for (auto* const end : {&piece.lower, &piece.upper}) {
      const double first = end->first - 1e6 * tie, last = end->first + 1e6 * tie;
      for (auto other = std::ranges::lower_bound(all, first, {}, &Ends::value_type::first);
           other != all.end() && other->first <= last; ++other)
        if (other->second < end->second && are_one(*end, *other)) *end = *other;
    }
  }
}

double Column::measure(std::span<double> registers, ColumnScratch& scratch) const {
  scratch.type = 0;
  scratch.error = 0;
  scratch.labels.clear();
  scratch.pieces.clear();
  scratch.ends.clear();
  Signs signs = 0;
  std::array<double, 2> range{};
  if (!find_quadratic_roots(registers, signs, range, scratch)) return 0;
  if (transcendental_ != 0) find_transcendental_roots(range, registers, signs, scratch);
  std::sort(scratch.quadratic.begin(), scratch.quadratic.end());
  bool is_in = false;
  std::pair<double, EndLabel> lower{};
  const auto become = [&](bool in, const std::pair<double, EndLabel>& end) {
    if (in == is_in) return;
    is_in = in;
    if (in)
      lower = end;
    else
      scratch.pieces.push_back({lower, end});
  };
  const auto holds = [&](Signs of) { return plan_.formula.holds(of, registers.data()); };
  const double tie = kMergeDistance * (range[1] - range[0]);
  std::pair<double, EndLabel> from{range[0], 0};
  for (std::size_t i = 0; i <= scratch.quadratic.size();) {
    const double to = i < scratch.quadratic.size() ? scratch.quadratic[i].first : range[1];
    // The constraints of degree three and four are evaluated only if all others can be satisfied.
    const bool at_best = holds(signs | positive_literals_);
    if (high_degree_ == 0 || (positive_literals_ == high_degree_ && (!at_best || holds(signs)))) {
      become(at_best, from);
    } else {
      Signs all = signs;
      find_high_degree_roots(registers, from.first, to, all, scratch);
      become(holds(all), from);
      for (const auto& end : scratch.high_degree) {
        all ^= bit(end.second >> 1U);
        become(holds(all), end);
      }
      scratch.ends.insert(scratch.ends.end(), scratch.high_degree.begin(), scratch.high_degree.end());
    }
    const std::size_t first = i;
    for (; i < scratch.quadratic.size() && scratch.quadratic[i].first <= to + tie; ++i)
      signs ^= bit(scratch.quadratic[i].second >> 1U);
    if (i == first) break;
    from = scratch.quadratic[first];
  }
  become(false, from);
  scratch.ends.insert(scratch.ends.end(), scratch.quadratic.begin(), scratch.quadratic.end());
  std::sort(scratch.ends.begin(), scratch.ends.end());

  merge_coincident_roots(registers, tie, scratch);
  if (scratch.pieces.empty()) return 0;
  double sum = 0;
  Fnv1a hash;
  for (const auto& [low, high] : scratch.pieces) {
    sum += high.first - low.first;
    for (const EndLabel end : {low.second, high.second}) {
      scratch.labels.push_back(end);
      hash.add(end);
    }
  }
  scratch.type = hash.value() | 1U;
  return sum;
}

void Column::add_gradient(double factor, std::span<double> registers, std::span<double> adjoints,
                          const ColumnScratch& scratch) const {
  for (const auto& piece : scratch.pieces)
    for (const bool is_upper : {false, true}) {
      const auto [z, label] = is_upper ? piece.upper : piece.lower;
      const Surface& surface = plan_.surfaces[label >> 1U];
      const double along = is_upper ? -factor : factor;
      if (surface.is_transcendental) {
        add_gradient_of_transcendental(surface, z, along, registers, adjoints);
        continue;
      }
      double g = along / slope_of(coefficients_of(surface, registers), z);
      for (std::size_t i = 0; i < kCoefficients; ++i, g *= z) adjoints[surface.coefficients[i]] += g;
    }
}

Dual4 Column::differentiable_end(const std::pair<double, EndLabel>& end, std::span<Dual4> dual_registers) const {
  const auto [z, label] = end;
  const Surface& surface = plan_.surfaces[label >> 1U];
  Dual4 f;
  double slope = 0;
  if (surface.is_transcendental) {
    evaluate_stage_of_z<Dual4>(z, dual_registers);
    f = dual_registers[surface.coefficients[0]];
    slope = dual_registers[surface.coefficients[1]].a;
  } else {
    double power = 1;
    for (std::size_t i = 0; i < kCoefficients; ++i, power *= z) {
      const Dual4& c = dual_registers[surface.coefficients[i]];
      f = f + c * power;
      if (i + 1 < kCoefficients)
        slope += static_cast<double>(i + 1) * dual_registers[surface.coefficients[i + 1]].a * power;
    }
  }
  return differentiable_root(z, f.v, slope);
}

}  // namespace pkm::generic
