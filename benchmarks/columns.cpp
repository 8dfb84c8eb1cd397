// Exact columns: one survey to 1e-8 in every situation that costs differently, and its derivative.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/math/dual.hpp"
#include "engine/mechanisms/four_ppa_two_par/columns.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;
using Designs = std::vector<std::vector<double>>;

// Surveys the designs one after the other; times and rates are per design.
void survey(benchmark::State& state, const Designs& designs, const SurveyPlan& plan) {
  const auto surveyor = prepare_survey(four_ppa(), plan, {});
  Scratch scratch;
  Survey<double> result;
  std::int64_t columns = 0;
  std::size_t next = 0;
  for (auto _ : state) {
    surveyor->survey(designs[next], scratch, result);
    benchmark::DoNotOptimize(result.volume);
    columns += result.columns;
    next = next + 1 < designs.size() ? next + 1 : 0;
  }
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["columns"] = benchmark::Counter(static_cast<double>(columns), benchmark::Counter::kIsRate);
  state.counters["columns_each"] = static_cast<double>(columns) / static_cast<double>(state.iterations());
}

const std::vector<HeldCoordinate> kOffPlane = {held_at(1, 0.4)};  // the stroke cuts there
const std::vector<HeldCoordinate> kOverY = {{.coordinate = 1, .kind = HeldCoordinate::Kind::integrated}};

void without_limits_original(benchmark::State& state) {
  survey(state, {original_design()}, column_plan(without_limits()));
}
void without_limits_optimal(benchmark::State& state) {
  survey(state, {optimal_design()}, column_plan(without_limits()));
}
void limits_original(benchmark::State& state) { survey(state, {original_design()}, column_plan(with_limits())); }
void limits_optimal(benchmark::State& state) { survey(state, {optimal_design()}, column_plan(with_limits())); }
void limits_random(benchmark::State& state) {
  survey(state, designs_with_active_limits(200), column_plan(with_limits()));
}
void limits_off_plane(benchmark::State& state) {
  survey(state, {original_design()}, column_plan(with_limits(), kOffPlane));
}
void over_y(benchmark::State& state) { survey(state, {original_design()}, column_plan(without_limits(), kOverY)); }
void limits_over_y(benchmark::State& state) { survey(state, {original_design()}, column_plan(with_limits(), kOverY)); }

BENCHMARK(without_limits_original)->Name("column_survey/original")->Unit(benchmark::kMicrosecond);
BENCHMARK(without_limits_optimal)->Name("column_survey/optimal")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_original)->Name("column_survey/original_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_optimal)->Name("column_survey/optimal_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_random)->Name("column_survey/200_random_with_limits")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_off_plane)->Name("column_survey/original_with_limits_off_plane")->Unit(benchmark::kMicrosecond);
BENCHMARK(over_y)->Name("column_survey/original_over_y")->Unit(benchmark::kMicrosecond);
BENCHMARK(limits_over_y)->Name("column_survey/original_with_limits_over_y")->Unit(benchmark::kMicrosecond);

// Volume of a design on the middle plane; with duals also its derivatives by a, b, l_u and l_d.
template <class S>
S volume(std::span<const S> parameters, const LimitSpec& spec, ColumnScratch<S>& scratch) {
  const Geometry<S> g = geometry(parameters);
  return plane_volume(frame(g, limits(g, spec), S(g.L0 * 0.5)), 1e-8, scratch).value;
}

void value_and_gradient(benchmark::State& state, const Designs& designs, const LimitSpec& spec) {
  std::vector<std::vector<Dual4>> moving;
  for (const auto& all : designs) {
    auto& duals = moving.emplace_back(all.begin(), all.end());
    for (int i = 0; i < 4; ++i) duals[static_cast<std::size_t>(i)].v[i] = 1;
  }
  ColumnScratch<double> plain;
  ColumnScratch<Dual4> derivative;
  const Duel duel = take_turns(
      state, "value_and_gradient_s",
      [&] {
        for (const auto& duals : moving)
          benchmark::DoNotOptimize(volume(std::span<const Dual4>(duals), spec, derivative));
      },
      "value_s",
      [&] {
        for (const auto& all : designs) benchmark::DoNotOptimize(volume(std::span<const double>(all), spec, plain));
      });
  const auto count = static_cast<double>(designs.size());
  for (const char* name : {"value_and_gradient_s", "value_s"}) state.counters[name] = state.counters[name] / count;
  state.counters["ratio"] = duel.ratio();
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
