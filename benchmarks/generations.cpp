// Parallel efficiency: one generation of designs on one and on two threads.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/problem/evaluator.hpp"

namespace pkm::benchmarks {
namespace {

// A table with one evaluated generation and the designs of the next, like that of an optimiser.
EvaluationTable two_generations(const Problem& problem, std::size_t population) {
  EvaluationTable table(problem.shape());
  table.extend(population);
  for (std::size_t row = 0; row < population; ++row)
    random_design(problem.space(), 1, static_cast<std::uint32_t>(row), table.design(row));
  ParallelEvaluator(1).evaluate(problem, table, 0);
  table.extend(population);
  for (std::size_t row = population; row < 2 * population; ++row)
    random_design(problem.space(), 1, static_cast<std::uint32_t>(row), table.design(row));
  return table;
}

void generation(benchmark::State& state, Study (*make_study)(), std::size_t population) {
  const Study study = make_study();
  const Problem& problem = *study.problem;
  EvaluationTable table = two_generations(problem, population);
  ParallelEvaluator one(1), two(2);
  const auto by_one = [&] { one.evaluate(problem, table, population); };
  const auto by_two = [&] { two.evaluate(problem, table, population); };
  PairedTimes times;
  with_team(2, [&] {
    times = time_alternately(state, "ten_by_one_thread_s", repeat_10_times(by_one), "ten_by_two_threads_s",
                             repeat_10_times(by_two));
  });
  const double designs = 10 * static_cast<double>(population) * static_cast<double>(state.iterations());
  state.counters["designs_per_s_on_one"] = designs / times.first;
  state.counters["designs_per_s_on_two"] = designs / times.second;
  state.counters["efficiency_percent"] = 100 * times.ratio() / 2;
}
void voxels_1000(benchmark::State& state) { generation(state, paper_study, 1000); }
void voxels_200(benchmark::State& state) { generation(state, paper_study, 200); }
void voxels_20(benchmark::State& state) { generation(state, paper_study, 20); }
void columns_1000(benchmark::State& state) { generation(state, wide_study, 1000); }
void columns_20(benchmark::State& state) { generation(state, wide_study, 20); }
BENCHMARK(voxels_1000)->Name("generation/voxels_1000_designs")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(voxels_200)->Name("generation/voxels_200_designs")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(voxels_20)->Name("generation/voxels_20_designs")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(columns_1000)->Name("generation/columns_1000_designs")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(columns_20)->Name("generation/columns_20_designs")->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace pkm::benchmarks
