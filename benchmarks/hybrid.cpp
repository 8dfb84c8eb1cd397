// Workspace analyses and pose tests of the hybrid robot: the nominal design and random designs near it.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/accelerators/hybrid/voxels.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/hybrid/plain_pose.hpp"
#include "tests/unit/generic/plain_loop.hpp"

namespace pkm::benchmarks {
namespace {

const Mechanism& hybrid_robot() { return mechanism_named("2t1r-p-hybrid"); }

template <class Method>
WorkspacePlan plan_of(const Method& method) {
  return {.method = method, .limits = no_limits(hybrid_robot().info())};
}

/// The nominal design, followed by designs whose parameters deviate from it by up to 10 %.
std::vector<std::vector<double>> designs(std::size_t count) {
  Stream random(1, 0, 0, Stream::Use::start);
  std::vector<std::vector<double>> all(count);
  for (std::size_t i = 0; i < count; ++i)
    for (const Parameter& p : hybrid_robot().info().parameters)
      all[i].push_back(p.nominal * (i == 0 ? 1 : 0.9 + 0.2 * random.u01()));
  return all;
}

/// Times are per design. @tparam S  with Dual4: with derivatives by four variables
template <class S, class Method>
void analyse(benchmark::State& state, const Method& method, std::size_t count, const FieldRequest& request = {}) {
  std::vector<std::vector<S>> all;
  for (const auto& design : designs(count)) all.emplace_back(design.begin(), design.end());
  const auto evaluator = prepare_workspace(hybrid_robot(), plan_of(method), request);
  Scratch scratch;
  WorkspaceResult<S> result;
  std::size_t next = 0;
  for (auto _ : state) {
    evaluate_workspace<S>(*evaluator, all[next], scratch, result);
    benchmark::DoNotOptimize(result.volume);
    next = next + 1 < count ? next + 1 : 0;
  }
}

FieldRequest with_conditioning() {
  FieldRequest request;
  request.add(kConditioning);
  return request;
}

void columns(benchmark::State& state) { analyse<double>(state, ColumnOptions(), 1); }
void columns_random(benchmark::State& state) { analyse<double>(state, ColumnOptions(), 100); }
void gradient(benchmark::State& state) { analyse<Dual4>(state, ColumnOptions(), 1); }
void columns_conditioning(benchmark::State& state) { analyse<double>(state, ColumnOptions(), 1, with_conditioning()); }
void voxels(benchmark::State& state) { analyse<double>(state, kPaperGrid, 1); }
void voxels_conditioning(benchmark::State& state) { analyse<double>(state, kPaperGrid, 1, with_conditioning()); }

hybrid::SlicedDesign<double> nominal_design() {
  const std::vector<double> p = designs(1)[0];
  const std::span<const double> all(p);
  return hybrid::sliced_design(hybrid::geometry(all), hybrid::limits(all, no_limits(hybrid_robot().info())),
                               {1, -1, -1}, 1);
}

/// A loop over the same voxels; fails if the workspace analysis counts a different number.
void loop(benchmark::State& state) {
  const hybrid::SlicedDesign<double> design = nominal_design();
  const VoxelGrid grid(kPaperGrid.cells, hybrid::default_box(design));
  WorkspaceResult<double> loop_result, result;
  for (auto _ : state) {
    summarise(grid,
              testing::test_every_cell(
                  grid, [&](double x, double z, double beta) { return testing::hybrid::feasible(design, x, z, beta); }),
              loop_result);
    benchmark::DoNotOptimize(loop_result.volume);
  }
  evaluate_once<double>(*prepare_workspace(hybrid_robot(), plan_of(kPaperGrid), {}), designs(1)[0], result);
  if (result.feasible_cells != loop_result.feasible_cells)
    state.SkipWithError("the workspace analysis counts different voxels");
  state.counters["poses"] =
      benchmark::Counter(static_cast<double>(grid.count()), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(columns)->Name("hybrid/columns")->Unit(benchmark::kMicrosecond);
BENCHMARK(columns_random)->Name("hybrid/columns_100_random")->Unit(benchmark::kMicrosecond);
BENCHMARK(gradient)->Name("hybrid/columns_gradient")->Unit(benchmark::kMicrosecond);
BENCHMARK(columns_conditioning)->Name("hybrid/columns_conditioning")->Unit(benchmark::kMicrosecond);
BENCHMARK(voxels)->Name("hybrid/voxels")->Unit(benchmark::kMicrosecond);
BENCHMARK(voxels_conditioning)->Name("hybrid/voxels_conditioning")->Unit(benchmark::kMicrosecond);
BENCHMARK(loop)->Name("hybrid/loop")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
