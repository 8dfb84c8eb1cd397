#include "engine/problem/replay.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace pkm {
void ReplayEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  const std::size_t end = std::max(first, std::min(table.size(), record_.size()));
  if (end > first && !(record_.shape() == table.shape()))
    throw ReplayMismatch(
        "the variables, objectives or constraints of the recorded evaluations differ from those of the problem");
  for (std::size_t row = first; row < end; ++row) {
    const auto recorded = record_.design(row);
    if (std::memcmp(recorded.data(), table.design(row).data(), recorded.size_bytes()) != 0)
      throw ReplayMismatch("recorded evaluation " + std::to_string(row) +
                           " differs from the design that the optimiser requests; the record cannot be continued");
    table.copy_results(row, record_, row);
  }
  if (end < table.size()) inner_.evaluate(problem, table, end);
}

}  // namespace pkm
