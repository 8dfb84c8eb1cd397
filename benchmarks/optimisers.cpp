// The genetic algorithm: what it costs itself, the random numbers it draws, and a whole study without a file.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/silent_monitor.hpp"
#include "benchmarks/sphere.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/random.hpp"

namespace pkm::benchmarks {
namespace {

void ga_overhead(benchmark::State& state) {
  const Sphere problem(4);
  const OptimiserEntry& entry = *find_named(all_optimisers(), "ga");
  Options options = default_options(entry.options);
  options.set("population", std::int64_t{state.range(0)});
  options.set("generations", std::int64_t{100});
  const auto optimiser = entry.make(options, problem.space());
  SerialEvaluator evaluator;
  Silent monitor;
  std::size_t evaluations = 0;
  for (auto _ : state) {
    EvaluationTable table(problem.shape());
    optimiser->minimise({problem, evaluator, monitor, 1, {}}, table);
    evaluations += table.size();
  }
  using benchmark::Counter;
  state.counters["s_per_evaluation"] = Counter(static_cast<double>(evaluations), Counter::kIsRate | Counter::kInvert);
}
BENCHMARK(ga_overhead)->Name("ga_overhead/population")->Arg(20)->Arg(1000)->Unit(benchmark::kMicrosecond);

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
  Silent monitor;
  std::size_t evaluations = 0;
  double best = 0;
  for (auto _ : state) {
    const Study study = make_study();
    ParallelEvaluator evaluator(static_cast<int>(state.range(0)));
    EvaluationTable table(study.problem->shape());
    const StageResult result =
        study.stages[0].optimiser->minimise({*study.problem, evaluator, monitor, study.seed, {}}, table);
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
