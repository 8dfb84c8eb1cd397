#include "engine/runner/generation_record.hpp"

#include <cmath>
#include <span>

#include "engine/core/team.hpp"

namespace pkm {
namespace {

using Rows = std::vector<std::int64_t>;

/// Mean, over the variables, of the standard deviation of the population divided by the range of the variable.
double diversity(const DesignSpace& space, const EvaluationTable& table, const Rows& population) {
  if (population.empty() || space.dimension() == 0) return 0;
  const std::size_t members = population.size(), dimension = space.dimension();
  const auto n = static_cast<double>(members);
  // Unit coordinates of all members, one variable after the other: a contiguous copy, because the rows of the
  // evaluation table are far apart in memory.
  std::vector<double> units(members * dimension);
  const auto gather = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto design = table.design(static_cast<std::size_t>(population[i]));
      for (std::size_t v = 0; v < dimension; ++v) units[v * members + i] = space.to_unit(v, design[v]);
    }
  };
  constexpr std::size_t kMinParallel = 10'000;
  if (members < kMinParallel)
    gather(0, members);
  else
    parallel_for(members, gather);
  double sum = 0;
  for (std::size_t v = 0; v < dimension; ++v) {
    const std::span unit = std::span(units).subspan(v * members, members);
    double mean = 0, square = 0;
    for (const double u : unit) mean += u / n;
    for (const double u : unit) square += (u - mean) * (u - mean) / n;
    sum += std::sqrt(square);
  }
  return sum / static_cast<double>(dimension);
}

double feasible_share(const EvaluationTable& table, const Rows& population) {
  if (population.empty()) return 0;
  std::size_t feasible = 0;
  for (const auto row : population) feasible += table.status[static_cast<std::size_t>(row)] == Status::feasible;
  return static_cast<double>(feasible) / static_cast<double>(population.size());
}

/// Removes all generations of a stage except the first `size`.
void truncate(StageRecord& stage, std::size_t size) {
  GenerationRecords& list = stage.generations;
  if (stage.front)
    for (auto* series : {&stage.front->hypervolume, &stage.front->spread, &stage.front->igd_plus}) series->resize(size);
  list.population.resize(static_cast<std::size_t>(list.population_first[size]));
  for (auto* column : {&list.first_row, &list.best_row, &list.population_first}) column->resize(size);
  for (auto* column : {&list.feasible_share, &list.diversity, &list.seconds}) column->resize(size);
}

/// Replaces the recorded front by the current one and appends its quality indicators to their series.
void record_front(const Front& front, std::optional<FrontRecord>& record) {
  if (!record) record.emplace();
  record->rows = front.rows;
  record->reference = front.reference;
  record->hypervolume.push_back(front.hypervolume);
  record->spread.push_back(front.spread);
  record->igd_plus.push_back(front.igd_plus);
}

}  // namespace

void record_generation(const Generation& g, const DesignSpace& space, double seconds, StageRecord& stage) {
  GenerationRecords& list = stage.generations;
  if (const auto index = static_cast<std::size_t>(g.number); index < list.size()) truncate(stage, index);
  list.first_row.push_back(static_cast<std::int64_t>(g.first_row));
  list.best_row.push_back(g.best_row);
  list.feasible_share.push_back(feasible_share(*g.table, *g.population));
  list.diversity.push_back(diversity(space, *g.table, *g.population));
  list.seconds.push_back(seconds);
  list.population_first.push_back(static_cast<std::int64_t>(list.population.size()));
  list.population.insert(list.population.end(), g.population->begin(), g.population->end());
  if (g.front) record_front(*g.front, stage.front);
  if (g.starts && g.starts->size() != stage.starts.size()) stage.starts = *g.starts;
}

}  // namespace pkm
