// Surveys and pose tests of the hybrid robot: nominal, and random designs around it.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/math/random.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/hybrid/voxels.hpp"
#include "engine/survey/survey_set.hpp"
#include "tests/unit/mechanisms/hybrid/plain_pose.hpp"
#include "tests/unit/mechanisms/plain_loop.hpp"

namespace pkm::benchmarks {
namespace {

const Mechanism& hybrid_robot() { return mechanism_named("2t1r-p-hybrid"); }

template <class Method>
SurveyPlan plan_of(const Method& method) {
  return {.method = method, .limits = no_limits(hybrid_robot().info())};
}

/// The nominal design first, then such with every parameter up to a tenth off.
std::vector<std::vector<double>> designs(std::size_t count) {
  Stream random(1, 0, 0, Stream::Use::start);
  std::vector<std::vector<double>> all(count);
  for (std::size_t i = 0; i < count; ++i)
    for (const Parameter& p : hybrid_robot().info().parameters)
      all[i].push_back(p.nominal * (i == 0 ? 1 : 0.9 + 0.2 * random.u01()));
  return all;
}

/// Times per design. @param S  with Dual4, derivatives by four variables
template <class S, class Method>
void survey(benchmark::State& state, const Method& method, std::size_t count, const Demand& demand = {}) {
  std::vector<std::vector<S>> all;
  for (const auto& design : designs(count)) all.emplace_back(design.begin(), design.end());
  const auto surveyor = prepare_survey(hybrid_robot(), plan_of(method), demand);
  Scratch scratch;
  Survey<S> result;
  std::size_t next = 0;
  for (auto _ : state) {
    run_survey<S>(*surveyor, all[next], scratch, result);
    benchmark::DoNotOptimize(result.volume);
    next = next + 1 < count ? next + 1 : 0;
  }
}

Demand with_conditioning() {
  Demand demand;
  demand.add(kConditioning);
  return demand;
}

void columns(benchmark::State& state) { survey<double>(state, ColumnOptions(), 1); }
void columns_random(benchmark::State& state) { survey<double>(state, ColumnOptions(), 100); }
void gradient(benchmark::State& state) { survey<Dual4>(state, ColumnOptions(), 1); }
void columns_conditioning(benchmark::State& state) { survey<double>(state, ColumnOptions(), 1, with_conditioning()); }
void voxels(benchmark::State& state) { survey<double>(state, kPaperGrid, 1); }
void voxels_conditioning(benchmark::State& state) { survey<double>(state, kPaperGrid, 1, with_conditioning()); }

using hybrid::VoxelDesign;

VoxelDesign nominal() {
  const std::vector<double> p = designs(1)[0];
  const std::span<const double> all(p);
  return {hybrid::frame(hybrid::geometry(all), hybrid::limits(all, no_limits(hybrid_robot().info())), {1, -1, -1}, 1)};
}

/// The plain loop over the same cells; fails if the survey counts others.
void plain_loop(benchmark::State& state) {
  const VoxelDesign design = nominal();
  const VoxelGrid grid(kPaperGrid.cells, hybrid::default_box(design));
  Survey<double> plain, fast;
  for (auto _ : state) {
    summarise(grid,
              testing::test_every_cell(
                  grid, [&](double x, double z, double beta) { return testing::hybrid::feasible(design, x, z, beta); }),
              plain);
    benchmark::DoNotOptimize(plain.volume);
  }
  survey_once<double>(*prepare_survey(hybrid_robot(), plan_of(kPaperGrid), {}), designs(1)[0], fast);
  if (fast.feasible_cells != plain.feasible_cells) state.SkipWithError("the survey counts other cells");
  state.counters["poses"] =
      benchmark::Counter(static_cast<double>(grid.count()), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(columns)->Name("hybrid/columns")->Unit(benchmark::kMicrosecond);
BENCHMARK(columns_random)->Name("hybrid/columns_100_random")->Unit(benchmark::kMicrosecond);
BENCHMARK(gradient)->Name("hybrid/columns_gradient")->Unit(benchmark::kMicrosecond);
BENCHMARK(columns_conditioning)->Name("hybrid/columns_conditioning")->Unit(benchmark::kMicrosecond);
BENCHMARK(voxels)->Name("hybrid/voxels")->Unit(benchmark::kMicrosecond);
BENCHMARK(voxels_conditioning)->Name("hybrid/voxels_conditioning")->Unit(benchmark::kMicrosecond);
BENCHMARK(plain_loop)->Name("hybrid/plain_loop")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
