// How cost grows: with threads, population and number of variables. With the grid: voxel_survey/grid.
#include <benchmark/benchmark.h>

#include <string>
#include <thread>

#include "benchmarks/inputs.hpp"
#include "benchmarks/silent_monitor.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/problem/evaluator.hpp"

namespace pkm::benchmarks {
namespace {

// A problem whose evaluation costs next to nothing: the sum of squares.
class Sphere final : public Problem {
 public:
  explicit Sphere(std::size_t variables) : space_(axes(variables)) {}
  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<ReportInfo>& reports() const override { return reports_; }
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
  std::vector<ReportInfo> reports_;
};

/// Runs the genetic algorithm and counts designs per second.
void run_ga(benchmark::State& state, const Problem& problem, std::int64_t population, std::int64_t generations,
            Evaluator& evaluator) {
  const OptimiserEntry& entry = *find_named(all_optimisers(), "ga");
  Options options = default_options(entry.options);
  options.set("population", population);
  options.set("generations", generations);
  const auto optimiser = entry.make(options, problem.space());
  Silent monitor;
  std::size_t evaluations = 0;
  for (auto _ : state) {
    EvaluationTable table(problem.shape());
    optimiser->minimise({problem, evaluator, monitor, 1, {}}, table);
    evaluations += table.size();
  }
  using benchmark::Counter;
  state.counters["s_per_design"] = Counter(static_cast<double>(evaluations), Counter::kIsRate | Counter::kInvert);
}

// The paper's study with a population of 200 on 1, 2, ... as many threads as there are cores.
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

// The paper's study: what a design takes of a population's evaluation and of the algorithm itself.
void population(benchmark::State& state) {
  const Study study = paper_study();
  ParallelEvaluator evaluator(1);
  run_ga(state, *study.problem, state.range(0), 10, evaluator);
}
BENCHMARK(population)->Name("scaling/population")->RangeMultiplier(10)->Range(10, 10000)->Unit(benchmark::kMillisecond);

// The algorithm alone, with free evaluations.
void own(benchmark::State& state, std::int64_t generations) {
  const Sphere problem(4);
  ParallelEvaluator evaluator(1);
  run_ga(state, problem, state.range(0), generations, evaluator);
}
void ga_overhead(benchmark::State& state) { own(state, 100); }
BENCHMARK(ga_overhead)->Name("ga_overhead/population")->Arg(20)->Arg(1000)->Unit(benchmark::kMicrosecond);
void own_population(benchmark::State& state) { own(state, 10); }
BENCHMARK(own_population)
    ->Name("scaling/own_population")
    ->RangeMultiplier(10)
    ->Range(10, 100000)
    ->Unit(benchmark::kMillisecond);

void own_variables(benchmark::State& state) {
  const Sphere problem(static_cast<std::size_t>(state.range(0)));
  ParallelEvaluator evaluator(1);
  run_ga(state, problem, 100, 20, evaluator);
}
BENCHMARK(own_variables)
    ->Name("scaling/own_variables")
    ->RangeMultiplier(2)
    ->Range(1, 128)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pkm::benchmarks
