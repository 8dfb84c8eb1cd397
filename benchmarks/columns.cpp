// Exact volumes by cylindrical decomposition (method `columns`) to a tolerance of 1e-8, in cases of different cost, and
// their gradients.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/math/dual.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;
using Designs = std::vector<std::vector<double>>;

// Analyses the designs one after the other; times and rates are per design.
void analyse(benchmark::State& state, const Designs& designs, const WorkspacePlan& plan) {
  const auto evaluator = prepare_workspace(four_ppa(), plan, {});
  Scratch scratch;
  WorkspaceResult<double> result;
  std::int64_t columns = 0;
  std::size_t next = 0;
  for (auto _ : state) {
    evaluator->evaluate(designs[next], scratch, result);
    benchmark::DoNotOptimize(result.volume);
    columns += result.columns;
    next = next + 1 < designs.size() ? next + 1 : 0;
  }
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["columns"] = benchmark::Counter(static_cast<double>(columns), benchmark::Counter::kIsRate);
  state.counters["columns_each"] = static_cast<double>(columns) / static_cast<double>(state.iterations());
}

const std::vector<FixedCoordinate> kFixedOffMidplane = {fixed_at(1, 0.4)};  // the stroke limits are active there
const std::vector<FixedCoordinate> kIntegratedOverY = {{.coordinate = 1, .kind = FixedCoordinate::Kind::integrated}};

void without_limits_original(benchmark::State& state) {
  analyse(state, {original_design()}, column_plan(without_limits()));
}
void without_limits_optimal(benchmark::State& state) {
  analyse(state, {optimal_design()}, column_plan(without_limits()));
}
void limits_original(benchmark::State& state) { analyse(state, {original_design()}, column_plan(with_limits())); }
void limits_optimal(benchmark::State& state) { analyse(state, {optimal_design()}, column_plan(with_limits())); }
void limits_random(benchmark::State& state) {
  analyse(state, designs_with_active_limits(200), column_plan(with_limits()));
}
void limits_off_plane(benchmark::State& state) {
  analyse(state, {original_design()}, column_plan(with_limits(), kFixedOffMidplane));
}
void integrated_over_y(benchmark::State& state) {
  analyse(state, {original_design()}, column_plan(without_limits(), kIntegratedOverY));
}
void limits_integrated_over_y(benchmark::State& state) {
  analyse(state, {original_design()}, column_plan(with_limits(), kIntegratedOverY));
}

BENCHMARK(without_limits_original)->Name("columns/original")->Unit(benchmark::kMicrosecond);
BENCHMARK(without_limits_optimal)->Name("columns/optimal")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_original)->Name("columns/original_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_optimal)->Name("columns/optimal_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_random)->Name("columns/200_random_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_off_plane)->Name("columns/original_with_limits_off_plane")->Unit(benchmark::kMicrosecond);
BENCHMARK(integrated_over_y)->Name("columns/original_over_y")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_integrated_over_y)->Name("columns/original_with_limits_over_y")->Unit(benchmark::kMicrosecond);

// Volume of a design on the symmetry plane; with dual numbers also its derivatives by a, b, l_u and l_d.
template <class S>
S volume(std::span<const S> parameters, const LimitSpec& spec, ColumnScratch<S>& scratch) {
  const Geometry<S> g = geometry(parameters);
  return plane_volume(sliced_design(g, limits(g, spec), S(g.L0 * 0.5)), 1e-8, scratch).value;
}

void value_and_gradient(benchmark::State& state, const Designs& designs, const LimitSpec& spec) {
  std::vector<std::vector<Dual4>> duals;
  for (const auto& all : designs) {
    auto& variables = duals.emplace_back(all.begin(), all.end());
    for (int i = 0; i < 4; ++i) variables[static_cast<std::size_t>(i)].v[i] = 1;
  }
  ColumnScratch<double> value_scratch;
  ColumnScratch<Dual4> gradient_scratch;
  const PairedTimes times = time_alternately(
      state, "value_and_gradient_s",
      [&] {
        for (const auto& variables : duals)
          benchmark::DoNotOptimize(volume(std::span<const Dual4>(variables), spec, gradient_scratch));
      },
      "value_s",
      [&] {
        for (const auto& all : designs)
          benchmark::DoNotOptimize(volume(std::span<const double>(all), spec, value_scratch));
      });
  const auto count = static_cast<double>(designs.size());
  for (const char* name : {"value_and_gradient_s", "value_s"}) state.counters[name] = state.counters[name] / count;
  state.counters["ratio"] = times.ratio();
}
void gradient(benchmark::State& state) {
  value_and_gradient(state, {original_design(), optimal_design()}, without_limits());
}
void gradient_with_limits(benchmark::State& state) {
  value_and_gradient(state, designs_with_active_limits(200), with_limits());
}
BENCHMARK(gradient)->Name("column_gradient/without_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(gradient_with_limits)->Name("column_gradient/200_random_with_limits")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
