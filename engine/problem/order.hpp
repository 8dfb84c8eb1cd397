// The feasibility rules for one objective (Deb 2000) as a sort key: better designs first, without looking into the
// table again at every comparison. Status comes first, then the objective among feasible designs, the violation among
// the others. A failed evaluation is worse than everything.
#pragma once

#include <compare>
#include <cstdint>

#include "engine/problem/problem.hpp"

namespace pkm {

/// A row of a table and how good it is. Total order: status, then value, then the earlier evaluation.
struct Ranked {
  Status status = Status::failed;
  double value = 0;  ///< to be minimised: the first objective of a feasible design, else the violation
  std::int64_t row = -1;

  auto operator<=>(const Ranked&) const = default;
};

/// Whether a design is better than another, whichever was evaluated first. Strict weak order.
inline bool better(const Ranked& a, const Ranked& b) {
  return a.status != b.status ? a.status < b.status : a.value < b.value;
}

/// The key of an evaluated row. A problem without objectives ranks by feasibility alone.
inline Ranked ranked(const std::vector<ObjectiveInfo>& objectives, const EvaluationTable& table, std::size_t row) {
  Ranked r{table.status[row], 0, static_cast<std::int64_t>(row)};
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
