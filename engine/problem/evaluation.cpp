#include "engine/problem/evaluation.hpp"

#include <algorithm>
#include <limits>

namespace pkm {

std::size_t EvaluationTable::extend(std::size_t count) {
  const std::size_t first = size();
  resize(first + count);
  return first;
}

std::size_t EvaluationTable::append(const EvaluationTable& from, std::size_t row) {
  const std::size_t here = extend(1);
  std::ranges::copy(from.design(row), design(here).begin());
  copy_results(here, from, row);
  return here;
}

EvaluationTable EvaluationTable::slice(std::size_t first, std::size_t end) const {
  EvaluationTable rows(shape_);
  for (std::size_t row = first; row < end; ++row) rows.append(*this, row);
  return rows;
}

void EvaluationTable::copy_results(std::size_t row, const EvaluationTable& from, std::size_t source) {
  const EvaluationSlot to = slot(row);
  std::ranges::copy(from.objective_row(source), to.objectives.begin());
  std::ranges::copy(from.margin_row(source), to.margins.begin());
  std::ranges::copy(from.output_row(source), to.reports.begin());
  std::ranges::copy(from.derivative_row(source), to.derivatives.begin());
  status[row] = from.status[source];
  seconds[row] = from.seconds[source];
}

void EvaluationTable::resize(std::size_t rows) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  designs.resize(rows * shape_.variables);
  objectives.resize(rows * shape_.objectives, nan);
  margins.resize(rows * shape_.margins, nan);
  reports.resize(rows * shape_.reports, nan);
  derivatives.resize(rows * shape_.derivatives(), nan);
  status.resize(rows, Status::failed);
  seconds.resize(rows);
}

}  // namespace pkm
