#include "engine/accelerators/crr_cru/section.hpp"

#include <algorithm>

#include "engine/math/hash.hpp"

namespace pkm::crr_cru {
namespace {

/// Every break that the section's formulas may have, whether it matters or not.
void list_candidates(const Section<double>& s, std::vector<Structure::Candidate>& list) {
  using Kind = BreakCode::Kind;
  list.clear();
  const double first = s.u.interval[0].lower, last = s.u.interval[s.u.size - 1].upper;
  const auto add = [&](Kind kind, std::size_t a, std::size_t b, int sign) {
    const BreakCode code{.kind = kind,
                         .first = static_cast<std::uint8_t>(a),
                         .second = static_cast<std::uint8_t>(b),
                         .sign = static_cast<std::int8_t>(sign)};
    bool exists = false;
    const double u = break_at(s, code, &exists);
    if (exists && u > first && u < last) list.push_back({u, code});
  };
  for (std::size_t circle = 0; circle < 2 * s.rings; ++circle)
    for (const int sign : {-1, 1}) {
      add(Kind::extreme, circle, 0, sign);
      for (std::size_t end = 0; end < 2 * s.v.size; ++end) add(Kind::crossing_v, circle, end, sign);
      if (s.rings == 2 && circle < 2)
        for (const std::size_t other : {2, 3}) add(Kind::crossing_ring, circle, other, sign);
    }
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.u < b.u; });
}

/// Intervals of v over u.
IntervalSet<double> column_at(const Section<double>& s, double u) {
  IntervalSet<double> column = s.v;
  for (std::size_t i = 0; i < column.size; ++i) {
    column.interval[i].lower_code = EndCode::of_v(2 * i);
    column.interval[i].upper_code = EndCode::of_v(2 * i + 1);
  }
  for (std::size_t i = 0; i < s.rings; ++i) {
    const Ring<double>& ring = s.ring[i];
    const double w2 = (u - ring.u) * (u - ring.u);
    cut(column, ring.v, ring.out2 - w2, ring.in2 - w2, ring.limb);
  }
  return column;
}

std::uint64_t signature_of(const Section<double>& s, const std::vector<Column>& columns) {
  if (columns.empty()) return 0;
  Fnv1a hash;
  const auto add = [&hash](auto... values) { (hash.add(values), ...); };
  for (const auto* set : {&s.u, &s.v}) {
    add(set->size);
    for (std::size_t i = 0; i < set->size; ++i)
      add(set->interval[i].lower_code.number(), set->interval[i].upper_code.number());
  }
  for (const Column& column : columns) {
    for (const BreakCode& code : {column.lower, column.upper})
      add(static_cast<std::size_t>(code.kind), code.first, code.second, code.sign > 0);
    add(column.ends);
    for (std::size_t k = 0; k < column.ends; ++k) add(column.end[k].number());
  }
  return hash.value();
}

}  // namespace

void find_structure(const Section<double>& s, Structure& structure) {
  structure.columns.clear();
  structure.signature = 0;
  if (s.u.size == 0 || s.v.size == 0) return;
  list_candidates(s, structure.candidates);
  for (std::size_t i = 0; i < s.u.size; ++i) {
    const Interval<double>& part = s.u.interval[i];
    BreakCode from = BreakCode::end_of_u(2 * i);
    double low = part.lower;
    bool joins = false;  // the column before reaches up to `from`
    const auto go_to = [&](double high, const BreakCode& to) {
      if (high > low) {
        const IntervalSet<double> found = column_at(s, 0.5 * (low + high));
        Column column{.lower = from, .upper = to, .end = {}, .ends = 2 * found.size};
        for (std::size_t k = 0; k < found.size; ++k) {
          column.end[2 * k] = found.interval[k].lower_code;
          column.end[2 * k + 1] = found.interval[k].upper_code;
        }
        const bool same = joins && structure.columns.back().ends == column.ends &&
                          std::equal(column.end.begin(), column.end.begin() + static_cast<std::ptrdiff_t>(column.ends),
                                     structure.columns.back().end.begin());
        if (same)
          structure.columns.back().upper = to;
        else if (column.ends > 0)
          structure.columns.push_back(column);
        joins = column.ends > 0;
      }
      from = to;
      low = high;
    };
    for (const auto& [u, code] : structure.candidates)
      if (u > part.lower && u < part.upper) go_to(u, code);
    go_to(part.upper, BreakCode::end_of_u(2 * i + 1));
  }
  structure.signature = signature_of(s, structure.columns);
}

}  // namespace pkm::crr_cru
