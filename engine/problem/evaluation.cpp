#include "engine/problem/evaluation.hpp"

#include <limits>

namespace pkm {

std::size_t EvaluationTable::extend(std::size_t count) {
  const std::size_t first = size();
  resize(first + count);
  return first;
}

void EvaluationTable::resize(std::size_t rows) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  designs.resize(rows * shape_.variables);
  objectives.resize(rows * shape_.objectives, nan);
  margins.resize(rows * shape_.margins, nan);
  reports.resize(rows * shape_.reports, nan);
  slopes.resize(rows * shape_.slopes(), nan);
  status.resize(rows, Status::failed);
  seconds.resize(rows);
}

}  // namespace pkm
