#include "engine/generic/columns/column.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/stop.hpp"
#include "engine/generic/columns/polynomial.hpp"
#include "engine/generic/columns/section_motion.hpp"
#include "engine/math/hash.hpp"

namespace pkm::generic {
namespace {

constexpr std::size_t kCoefficients = 5;
using Quartic = std::array<double, kCoefficients>;  // by powers, the lowest first

/// By s in [-1, 1], from coefficients by z in [from, to].
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

Column::Column(SectionPlan plan) : plan_(std::move(plan)) {
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k)
    if (const Surface& surface = plan_.surfaces[k]; surface.is_steep || surface.is_curve)
      (surface.is_steep ? steep_ : curves_) |= bit(k);
  helps_ = steep_;
  for (const CrankSigns& crank : plan_.formula.cranks)
    helps_ &= ~(crank.at_min | crank.at_max | crank.after_min | crank.before_max);
}

/// False: nothing is feasible. @param signs  of the flat surfaces at the lower end of the range
bool Column::find_flat_ends(std::span<const double> registers, Signs& signs, std::array<double, 2>& range,
                            ColumnRoom& room) const {
  const auto [from, to] = plan_.range.back();
  const double low = registers[from], high = registers[to], beyond = 1e-2 * (high - low);
  if (!(high > low)) return false;
  range = {low - beyond, high + beyond};  // the box's ends are surfaces, too
  std::array<Roots, kMostSurfaces> roots;
  std::array<bool, kMostSurfaces> is_positive;  // below its roots
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if (((steep_ | curves_) & bit(k)) != 0) continue;
    const auto& at = plan_.surfaces[k].coefficients;
    const std::array<double, 3> c{registers[at[0]], registers[at[1]], registers[at[2]]};
    roots[k] = roots_of(c);
    is_positive[k] = c[2] != 0 ? c[2] > 0 : roots[k].count > 0 ? c[1] < 0 : c[0] >= 0;
    if ((plan_.formula.all & bit(k)) == 0 || is_positive[k]) continue;
    const auto [r, count] = roots[k];  // it is >= 0 between its roots, or above the one it has
    if (count == 0 || !(r[0] <= range[1]) || !(count == 1 || r[1] >= range[0])) return false;
    const double rest = count == 2 ? 1e-2 * (r[1] - r[0]) : beyond;
    range[0] = std::max(range[0], r[0] - rest);
    if (count == 2) range[1] = std::min(range[1], r[1] + rest);
  }
  signs = 0;
  room.flat.clear();
  for (std::size_t k = 0; k < plan_.surfaces.size(); ++k) {
    if (((steep_ | curves_) & bit(k)) != 0) continue;
    const auto [r, count] = roots[k];
    bool is = is_positive[k];
    std::size_t i = 0;
    for (; i < static_cast<std::size_t>(count) && r[i] <= range[0]; ++i) is = !is;
    if (is) signs |= bit(k);
    for (; i < static_cast<std::size_t>(count) && r[i] < range[1]; ++i, is = !is)
      room.flat.emplace_back(r[i], label_of(k, is));
  }
  return true;
}

/// Those between two flat ends. @param signs  of the steep surfaces at `from`
void Column::find_steep_ends(std::span<const double> registers, double from, double to, Signs& signs,
                             ColumnRoom& room) const {
  room.steep.clear();
  for (Signs rest = steep_; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    const Quartic c = in_range(coefficients_of(plan_.surfaces[k], registers), from, to);
    bool is = c[0] - c[1] + c[2] - c[3] + c[4] >= 0;
    if (is) signs |= bit(k);
    std::array<double, 8> places{};
    const std::size_t count = sign_changes(c, places);
    for (std::size_t i = 0; i < count; ++i, is = !is)
      room.steep.emplace_back(from + 0.5 * (to - from) * (places[i] + 1), label_of(k, is));
  }
  std::sort(room.steep.begin(), room.steep.end());
}

/// How well an end is known.
double Column::blur(const std::pair<double, EndLabel>& end, std::span<const double> registers) const {
  const auto [z, label] = end;
  if (plan_.surfaces[label >> 1U].is_curve) return 0;
  const Quartic c = coefficients_of(plan_.surfaces[label >> 1U], registers);
  double size = 0, power = 1;
  for (const double each : c) {
    size += std::fabs(each * power);
    power *= z;
  }
  return 1e-14 * size / (std::fabs(slope_of(c, z)) + 1e-14 * size);
}

/// Leaves out what rounding may have made, and names ends that it cannot tell apart by the first surface.
void Column::settle(std::span<const double> registers, double tie, ColumnRoom& room) const {
  const auto are_one = [&](const auto& x, const auto& y) {
    const double distance = std::fabs(x.first - y.first);
    return distance <= tie || (distance <= 1e6 * tie && distance <= blur(x, registers) + blur(y, registers));
  };
  std::vector<ColumnRoom::Piece>& pieces = room.pieces;
  std::erase_if(pieces, [&](const ColumnRoom::Piece& piece) { return are_one(piece.lower, piece.upper); });
  for (std::size_t i = 1; i < pieces.size();)
    if (are_one(pieces[i - 1].upper, pieces[i].lower)) {
      pieces[i - 1].upper = pieces[i].upper;
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  for (ColumnRoom::Piece& piece : pieces) {
    if (is_long(room)) check_stop();
    for (auto* const end : {&piece.lower, &piece.upper})
      for (const auto& other : room.ends)
        if (other.second < end->second && are_one(*end, other)) *end = other;
  }
}

double Column::measure(std::span<double> registers, ColumnRoom& room) const {
  room.structure = 0;
  room.labels.clear();
  room.pieces.clear();
  room.ends.clear();
  Signs signs = 0;
  std::array<double, 2> range{};
  if (!find_flat_ends(registers, signs, range, room)) return 0;
  if (curves_ != 0) find_curve_ends(range, registers, signs, room);
  std::sort(room.flat.begin(), room.flat.end());
  bool is_in = false;
  std::pair<double, EndLabel> lower{};
  const auto become = [&](bool in, const std::pair<double, EndLabel>& end) {
    if (in == is_in) return;
    is_in = in;
    if (in)
      lower = end;
    else
      room.pieces.push_back({lower, end});
  };
  const auto holds = [&](Signs of) { return plan_.formula.holds(of, registers.data()); };
  const double tie = kTie * (range[1] - range[0]);
  std::pair<double, EndLabel> from{range[0], 0};
  for (std::size_t i = 0; i <= room.flat.size();) {
    const double to = i < room.flat.size() ? room.flat[i].first : range[1];
    // Steep surfaces are looked at where they matter.
    const bool at_best = holds(signs | helps_);
    if (steep_ == 0 || (helps_ == steep_ && (!at_best || holds(signs)))) {
      become(at_best, from);
    } else {
      Signs all = signs;
      find_steep_ends(registers, from.first, to, all, room);
      become(holds(all), from);
      for (const auto& end : room.steep) {
        all ^= bit(end.second >> 1U);
        become(holds(all), end);
      }
      room.ends.insert(room.ends.end(), room.steep.begin(), room.steep.end());
    }
    const std::size_t first = i;
    for (; i < room.flat.size() && room.flat[i].first <= to + tie; ++i) signs ^= bit(room.flat[i].second >> 1U);
    if (i == first) break;
    from = room.flat[first];
  }
  become(false, from);
  room.ends.insert(room.ends.end(), room.flat.begin(), room.flat.end());
  std::sort(room.ends.begin(), room.ends.end());

  settle(registers, tie, room);
  if (room.pieces.empty()) return 0;
  double sum = 0;
  Fnv1a hash;
  for (const auto& [low, high] : room.pieces) {
    sum += high.first - low.first;
    for (const EndLabel end : {low.second, high.second}) {
      room.labels.push_back(end);
      hash.add(end);
    }
  }
  room.structure = hash.value() | 1U;
  return sum;
}

void Column::add_slopes(double factor, std::span<double> registers, std::span<double> adjoints,
                        const ColumnRoom& room) const {
  for (const auto& piece : room.pieces)
    for (const bool is_upper : {false, true}) {
      const auto [z, label] = is_upper ? piece.upper : piece.lower;
      const Surface& surface = plan_.surfaces[label >> 1U];
      const double along = is_upper ? -factor : factor;
      if (surface.is_curve) {
        add_slopes_of_curve(surface, z, along, registers, adjoints);
        continue;
      }
      double g = along / slope_of(coefficients_of(surface, registers), z);
      for (std::size_t i = 0; i < kCoefficients; ++i, g *= z) adjoints[surface.coefficients[i]] += g;
    }
}

Dual4 Column::moving_end(const std::pair<double, EndLabel>& end, std::span<Dual4> moving) const {
  const auto [z, label] = end;
  const Surface& surface = plan_.surfaces[label >> 1U];
  Dual4 f;
  double slope = 0;
  if (surface.is_curve) {
    set_z<Dual4>(z, moving);
    f = moving[surface.coefficients[0]];
    slope = moving[surface.coefficients[1]].a;
  } else {
    double power = 1;
    for (std::size_t i = 0; i < kCoefficients; ++i, power *= z) {
      const Dual4& c = moving[surface.coefficients[i]];
      f = f + c * power;
      if (i + 1 < kCoefficients) slope += static_cast<double>(i + 1) * moving[surface.coefficients[i + 1]].a * power;
    }
  }
  return moved(z, f.v, slope);
}

}  // namespace pkm::generic
