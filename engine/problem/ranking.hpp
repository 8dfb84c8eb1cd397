// Constrained ranking of designs by the feasibility rules of Deb (2000), for one objective. The rules are stored as a
// sort key, so that comparisons do not access the table: the status decides first, then the objective of feasible
// designs or the total constraint violation of the others. Failed evaluations rank last.
#pragma once

#include <compare>
#include <cstdint>

#include "engine/problem/problem.hpp"

namespace pkm {

/// Sort key of one row of an evaluation table. Total order: by status, then by value, then by row (earlier evaluations
/// first).
struct RankKey {
  Status status = Status::failed;
  double value = 0;  ///< minimised: the first objective of a feasible design, otherwise the total violation
  std::int64_t row = -1;

  auto operator<=>(const RankKey&) const = default;
};

/// Whether design `a` ranks above design `b`, regardless of the order of evaluation. Strict weak order.
inline bool better(const RankKey& a, const RankKey& b) {
  return a.status != b.status ? a.status < b.status : a.value < b.value;
}

/// The sort key of an evaluated row. Without objectives, feasible designs are equal: only feasibility counts.
inline RankKey ranked(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table, std::size_t row) {
  RankKey r{table.status[row], 0, static_cast<std::int64_t>(row)};
  if (r.status == Status::failed) return r;
  if (r.status != Status::feasible) {
    r.value = violation(table.margin_row(row));
  } else if (!objectives.empty()) {
    const double value = table.objective_row(row)[0];
    r.value = objectives[0].direction == Direction::maximise ? -value : value;
  }
  return r;
}

}  // namespace pkm
