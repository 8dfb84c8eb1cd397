// The feasibility rules as a sort key: better designs first (Deb 2000), the same order as `better`, without looking
// into the table again at every comparison.
#pragma once

#include <cstdint>

#include "engine/problem/problem.hpp"

namespace pkm {

/// A row of a table and how good it is. Total order: status, then value, then the earlier evaluation.
struct Ranked {
  Status status = Status::failed;
  double value = 0;  ///< to be minimised: the first objective of a feasible design, else the violation
  std::int64_t row = -1;

  friend bool operator<(const Ranked& a, const Ranked& b) {
    if (a.status != b.status) return a.status < b.status;
    if (a.value != b.value) return a.value < b.value;
    return a.row < b.row;
  }
};

/// The key of an evaluated row. A problem without objectives ranks by feasibility alone.
inline Ranked ranked(const Problem& problem, const EvaluationTable& table, std::size_t row) {
  Ranked r{table.status[row], 0, static_cast<std::int64_t>(row)};
  if (r.status == Status::failed) return r;
  if (r.status != Status::feasible) {
    r.value = violation(table.margin_row(row));
  } else if (!problem.objectives().empty()) {
    const double value = table.objective_row(row)[0];
    r.value = problem.objectives()[0].direction == Direction::maximise ? -value : value;
  }
  return r;
}

}  // namespace pkm
