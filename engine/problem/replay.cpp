#include "engine/problem/replay.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace pkm {
namespace {

void copy_part(const std::vector<double>& from, std::vector<double>& to, std::size_t row, std::size_t width) {
  std::copy_n(from.begin() + row * width, width, to.begin() + row * width);
}

}  // namespace

void ReplayEvaluator::evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) {
  const EvaluationShape shape = table.shape();
  const std::size_t end = std::max(first, std::min(table.size(), record_.size()));
  if (end > first && !(record_.shape() == shape))
    throw ReplayMismatch("The recorded evaluations do not have this problem's variables, objectives and constraints.");
  for (std::size_t row = first; row < end; ++row) {
    const auto recorded = record_.design(row);
    if (std::memcmp(recorded.data(), table.design(row).data(), recorded.size_bytes()) != 0)
      throw ReplayMismatch("Recorded evaluation " + std::to_string(row) +
                           " is of another design than the optimiser asks for: the record cannot be continued.");
    copy_part(record_.objectives, table.objectives, row, shape.objectives);
    copy_part(record_.margins, table.margins, row, shape.margins);
    copy_part(record_.reports, table.reports, row, shape.reports);
    table.status[row] = record_.status[row];
    table.seconds[row] = record_.seconds[row];
  }
  if (end < table.size()) inner_.evaluate(problem, table, end);
}

}  // namespace pkm
