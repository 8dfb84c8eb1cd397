// Growth of the cost with the number of threads, the population and the number of variables. For the grid: voxels/grid.
#include <benchmark/benchmark.h>

#include <string>
#include <thread>

#include "benchmarks/inputs.hpp"
#include "benchmarks/silent_monitor.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/problem/evaluator.hpp"

namespace pkm::benchmarks {
namespace {

// A problem with negligible evaluation cost: the sum of squares.
class Sphere final : public Problem {
 public:
  explicit Sphere(std::size_t variables) : space_(axes(variables)) {}
  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<OutputInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, Scratch&, EvaluationSlot result) const override {
    double sum = 0;
    for (const double x : design) sum += x * x;
    result.objectives[0] = sum;
    result.status = Status::feasible;
  }

 private:
  static std::vector<Variable> axes(std::size_t count) {
    std::vector<Variable> list;
    for (std::size_t i = 0; i < count; ++i) list.push_back({"x" + std::to_string(i + 1), "m", -1, 2});
    return list;
  }

  DesignSpace space_;
  std::vector<ObjectiveInfo> objectives_{{"sphere", "m^2", "sum of squares", Direction::minimise}};
  std::vector<MarginInfo> margins_;
  std::vector<OutputInfo> reports_;
};

/// Runs the genetic algorithm and reports the time per design.
void run_ga(benchmark::State& state, const Problem& problem, std::int64_t population, std::int64_t generations,
            Evaluator& evaluator) {
  const OptimiserEntry& entry = *find_named(all_optimisers(), "ga");
  Options options = default_options(entry.options);
  options.set("population", population);
  options.set("generations", generations);
  const auto optimiser = entry.make(options, problem.space());
  SilentMonitor monitor;
  std::size_t evaluations = 0;
  for (auto _ : state) {
    EvaluationTable table(problem.shape());
    optimiser->minimise({problem, evaluator, monitor, 1, {}}, table);
    evaluations += table.size();
  }
  using benchmark::Counter;
  state.counters["s_per_design"] = Counter(static_cast<double>(evaluations), Counter::kIsRate | Counter::kInvert);
}

// The paper's study with a population of 200, on 1, 2, .. threads up to the number of cores.
void threads(benchmark::State& state) {
  const Study study = paper_study();
  ParallelEvaluator evaluator(static_cast<int>(state.range(0)));
  with_team(evaluator.threads(), [&] { run_ga(state, *study.problem, 200, 50, evaluator); });
}
BENCHMARK(threads)
    ->Name("scaling/threads")
    ->DenseRange(1, static_cast<int>(std::thread::hardware_concurrency()))
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

// The paper's study: time per design of evaluation and algorithm together.
void population(benchmark::State& state) {
  const Study study = paper_study();
  ParallelEvaluator evaluator(1);
  run_ga(state, *study.problem, state.range(0), 10, evaluator);
}
BENCHMARK(population)->Name("scaling/population")->RangeMultiplier(10)->Range(10, 10000)->Unit(benchmark::kMillisecond);

// The algorithm alone, with evaluations of negligible cost.
void ga_only(benchmark::State& state, std::int64_t generations) {
  const Sphere problem(4);
  ParallelEvaluator evaluator(1);
  run_ga(state, problem, state.range(0), generations, evaluator);
}
void ga_overhead(benchmark::State& state) { ga_only(state, 100); }
BENCHMARK(ga_overhead)->Name("ga_overhead/population")->Arg(20)->Arg(1000)->Unit(benchmark::kMicrosecond);
void ga_population(benchmark::State& state) { ga_only(state, 10); }
BENCHMARK(ga_population)
    ->Name("scaling/ga_population")
    ->RangeMultiplier(10)
    ->Range(10, 100000)
    ->Unit(benchmark::kMillisecond);

void ga_variables(benchmark::State& state) {
  const Sphere problem(static_cast<std::size_t>(state.range(0)));
  ParallelEvaluator evaluator(1);
  run_ga(state, problem, 100, 20, evaluator);
}
BENCHMARK(ga_variables)->Name("scaling/ga_variables")->RangeMultiplier(2)->Range(1, 128)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pkm::benchmarks
