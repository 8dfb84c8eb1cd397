#include "engine/accelerators/crr_cru/slice.hpp"

#include <algorithm>

#include "engine/math/hash.hpp"

namespace pkm::crr_cru {
namespace {

/// Lists all critical points of the formulas of a slice, in ascending u, whether or not they are on its boundary.
void find_candidates(const Slice<double>& s, std::vector<Decomposition::Candidate>& list) {
  using Kind = CriticalPoint::Kind;
  list.clear();
  const double first = s.u.interval[0].lower, last = s.u.interval[s.u.size - 1].upper;
  const auto add = [&](Kind kind, std::size_t a, std::size_t b, int sign) {
    const CriticalPoint point{.kind = kind,
                              .first = static_cast<std::uint8_t>(a),
                              .second = static_cast<std::uint8_t>(b),
                              .sign = static_cast<std::int8_t>(sign)};
    bool exists = false;
    const double u = abscissa(s, point, &exists);
    if (exists && u > first && u < last) list.push_back({u, point});
  };
  for (std::size_t circle = 0; circle < 2 * s.annuli; ++circle)
    for (const int sign : {-1, 1}) {
      add(Kind::turning_point, circle, 0, sign);
      for (std::size_t end = 0; end < 2 * s.v.size; ++end) add(Kind::intersection_with_v, circle, end, sign);
      if (s.annuli == 2 && circle < 2)
        for (const std::size_t other : {2, 3}) add(Kind::intersection_of_circles, circle, other, sign);
    }
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.u < b.u; });
}

/// The feasible intervals of v at a value of u.
IntervalSet<double> column_at(const Slice<double>& s, double u) {
  IntervalSet<double> column = s.v;
  for (std::size_t i = 0; i < column.size; ++i) {
    column.interval[i].lower_label = {EndpointLabel::v_bound, i, false};
    column.interval[i].upper_label = {EndpointLabel::v_bound, i, true};
  }
  for (std::size_t i = 0; i < s.annuli; ++i) {
    const Annulus<double>& annulus = s.annulus[i];
    const double w2 = (u - annulus.u) * (u - annulus.u);
    intersect_annulus(column, annulus.v, annulus.out2 - w2, annulus.in2 - w2, annulus.limb);
  }
  return column;
}

std::uint64_t signature_of(const Slice<double>& s, const std::vector<Column>& columns) {
  if (columns.empty()) return 0;
  Fnv1a hash;
  const auto add = [&hash](auto... values) { (hash.add(values), ...); };
  for (const auto* set : {&s.u, &s.v}) {
    add(set->size);
    for (std::size_t i = 0; i < set->size; ++i)
      add(set->interval[i].lower_label.hash(), set->interval[i].upper_label.hash());
  }
  for (const Column& column : columns) {
    for (const CriticalPoint& point : {column.lower, column.upper})
      add(static_cast<std::size_t>(point.kind), point.first, point.second, point.sign > 0);
    add(column.ends);
    for (std::size_t k = 0; k < column.ends; ++k) add(column.end[k].hash());
  }
  return hash.value();
}

}  // namespace

void decompose(const Slice<double>& s, Decomposition& decomposition) {
  std::vector<Column>& columns = decomposition.columns;
  columns.clear();
  decomposition.signature = 0;
  if (s.u.size == 0 || s.v.size == 0) return;
  find_candidates(s, decomposition.candidates);
  for (std::size_t i = 0; i < s.u.size; ++i) {
    const Interval<double>& part = s.u.interval[i];
    CriticalPoint from = CriticalPoint::end_of_u(2 * i);
    double low = part.lower;
    bool is_adjacent = false;  // true: the previous column ends at `from`
    const auto add_until = [&](double high, const CriticalPoint& to) {
      if (high > low) {
        const IntervalSet<double> found = column_at(s, 0.5 * (low + high));
        Column column{.lower = from, .upper = to, .end = {}, .ends = 2 * found.size};
        for (std::size_t k = 0; k < found.size; ++k) {
          column.end[2 * k] = found.interval[k].lower_label;
          column.end[2 * k + 1] = found.interval[k].upper_label;
        }
        if (is_adjacent && columns.back().ends == column.ends && columns.back().end == column.end)
          columns.back().upper = to;
        else if (column.ends > 0)
          columns.push_back(column);
        is_adjacent = column.ends > 0;
      }
      from = to;
      low = high;
    };
    for (const auto& [u, point] : decomposition.candidates)
      if (u > part.lower && u < part.upper) add_until(u, point);
    add_until(part.upper, CriticalPoint::end_of_u(2 * i + 1));
  }
  decomposition.signature = signature_of(s, columns);
}

}  // namespace pkm::crr_cru
