#include "engine/storage/study_contents.hpp"

#include "engine/core/error.hpp"
#include "engine/storage/schema.hpp"

namespace pkm {

std::span<const std::int64_t> GenerationRecords::population_of(std::size_t g) const {
  PKM_EXPECTS(g < size());
  const auto begin = static_cast<std::size_t>(population_first[g]);
  const std::size_t end = g + 1 < size() ? static_cast<std::size_t>(population_first[g + 1]) : population.size();
  return {population.data() + begin, end - begin};
}

std::vector<std::int64_t> GenerationRecords::generation_of_rows(std::size_t rows) const {
  std::vector<std::int64_t> generation(rows, 0);
  for (std::size_t g = 0; g < size(); ++g)
    for (auto row = static_cast<std::size_t>(first_row[g]); row < end_of(g, rows); ++row)
      generation[row] = static_cast<std::int64_t>(g);
  return generation;
}

std::int64_t StudyContents::evaluations() const {
  std::size_t count = 0;
  for (const StageRecord& stage : stages) count += stage.table.size();
  return static_cast<std::int64_t>(count);
}

bool StudyContents::reproducible() const {
  for (const StageRecord& stage : stages)
    for (const StartOutcome& start : stage.starts)
      if (start.stop == words(StopReason::time)) return false;
  return true;
}

std::string words(Status status) { return schema::to_stored(status); }
std::string words(StudyState state) { return schema::to_stored(state); }

}  // namespace pkm
