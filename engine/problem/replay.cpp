#include "engine/problem/replay.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace pkm {
void ReplayEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  const EvaluationShape shape = table.shape();
  const std::size_t recorded_end = row_ + (end_ - first_);  // first row of the table that is new
  const std::size_t end = std::max(first, std::min(table.size(), recorded_end));
  if (end > first && !(record_.shape() == shape))
    throw ReplayMismatch("The recorded evaluations do not have this problem's variables, objectives and constraints.");
  for (std::size_t row = first; row < end; ++row) {
    const std::size_t source = first_ + (row - row_);
    const auto recorded = record_.design(source);
    if (std::memcmp(recorded.data(), table.design(row).data(), recorded.size_bytes()) != 0)
      throw ReplayMismatch("Recorded evaluation " + std::to_string(source) +
                           " is of another design than the optimiser asks for: the record cannot be continued.");
    const EvaluationSlot slot = table.slot(row);
    std::ranges::copy(record_.objective_row(source), slot.objectives.begin());
    std::ranges::copy(record_.margin_row(source), slot.margins.begin());
    std::ranges::copy(record_.report_row(source), slot.reports.begin());
    std::ranges::copy(record_.slope_row(source), slot.slopes.begin());
    table.status[row] = record_.status[source];
    table.seconds[row] = record_.seconds[source];
  }
  if (end < table.size()) inner_.evaluate(problem, table, end);
}

}  // namespace pkm
