// Random numbers of the genetic algorithm, and complete studies without a study file. The cost of the algorithm itself
// is measured in scaling.cpp.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/silent_monitor.hpp"
#include "engine/math/random.hpp"

namespace pkm::benchmarks {
namespace {

void random_doubles(benchmark::State& state) {
  constexpr int kCount = 4096;
  Stream stream(1, 0, 0, Stream::Use::start);
  for (auto _ : state) {
    double sum = 0;
    for (int i = 0; i < kCount; ++i) sum += stream.u01();
    benchmark::DoNotOptimize(sum);
  }
  state.counters["doubles"] = benchmark::Counter(kCount, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(random_doubles)->Unit(benchmark::kMicrosecond);

// From the TOML file to the best design.
void whole_study(benchmark::State& state, Study (*make_study)()) {
  SilentMonitor monitor;
  std::size_t evaluations = 0;
  double best = 0;
  for (auto _ : state) {
    const Study study = make_study();
    ParallelEvaluator evaluator(static_cast<int>(state.range(0)));
    EvaluationTable table(study.problem->shape());
    StageResult result;
    with_team(evaluator.threads(), [&] {
      result = study.stages[0].optimiser->minimise({*study.problem, evaluator, monitor, study.seed, {}}, table);
    });
    evaluations += table.size();
    best = table.objective_row(static_cast<std::size_t>(result.best_row))[0];
  }
  state.counters["designs"] = benchmark::Counter(static_cast<double>(evaluations), benchmark::Counter::kIsRate);
  state.counters["best"] = best;
}
BENCHMARK_CAPTURE(whole_study, paper_problem, paper_study)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(whole_study, wide_bounds, wide_study)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace pkm::benchmarks
