// Joint-space inertia, coupling indices and drive forces of the nominal (3CRR/R)&CRU and Quadrupteron.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/math/statistics.hpp"
#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

WorkspacePlan plan_of(const std::variant<ColumnOptions, VoxelOptions>& method) {
  WorkspacePlan plan{.method = method, .fixed = {fixed_at(3, 0.3)}};
  plan.limits = no_limits(mechanism_named("quadrupteron").info());
  plan.limits.given[0] = 0.2;
  plan.limits.given[1] = 0.1;
  return plan;
}

constexpr std::array<std::int64_t, 3> kCells = {40, 40, 40};
constexpr Box kInside = {{{0.12, 0.2}, {0.12, 0.2}, {0.17, 0.24}}};  // completely feasible

FieldRequest coupling() {
  FieldRequest request;
  request.add(kCouplingIndex);
  return request;
}

/// Workspace analysis on voxels. The counter per_pose is the time per feasible pose.
void voxels(benchmark::State& state, const char* name, const VoxelOptions& options) {
  const Mechanism& m = mechanism_named(name);
  const auto parameters = nominal(m);
  const auto evaluator = prepare_workspace(m, plan_of(options), coupling());
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(parameters, scratch, result);
    benchmark::DoNotOptimize(result.field(kCouplingIndex, 0).data());
  }
  state.counters["feasible"] = static_cast<double>(result.weight.size());
  state.counters["per_pose"] =
      benchmark::Counter(static_cast<double>(result.weight.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Mean of the largest index over a task box at five angles, by quadrature nodes of columns.
template <class S>
void task_box(benchmark::State& state) {
  const Mechanism& m = mechanism_named("3crr-r-cru");
  const auto values = nominal(m);
  const std::vector<S> parameters(values.begin(), values.end());
  WorkspacePlan plan = plan_of(ColumnOptions{.nodes = {4, 4}, .box = kInside});
  plan.fixed = {{.coordinate = 3, .kind = FixedCoordinate::Kind::listed, .values = {-1, -0.5, 0, 0.5, 1}}};
  const auto evaluator = prepare_workspace(m, plan, coupling());
  Scratch scratch;
  WorkspaceResult<S> result;
  for (auto _ : state) {
    evaluate_workspace<S>(*evaluator, parameters, scratch, result);
    benchmark::DoNotOptimize(weighted_mean(result.weight, result.field(kCouplingIndex, 3)));
  }
  state.counters["poses"] = static_cast<double>(result.weight.size());
}

/// Inverse dynamics by the principle of virtual work, at 1024 motion states of one design. The counter per_state is the
/// time per state.
void drive_forces(benchmark::State& state, const char* name) {
  const Mechanism& m = mechanism_named(name);
  const auto parameters = nominal(m);
  std::vector<MotionSample> samples(1024);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double shift = 0.02 * static_cast<double>(k) / static_cast<double>(samples.size());
    samples[k].pose = {0.2 - shift, 0.17 + shift, 0.22 - shift, 0.3 + shift};
    samples[k].velocity = {0.3, -0.2, 0.1, 1};
    samples[k].acceleration = {5, -4, 3, 20};
  }
  InverseDynamicsScratch<double> scratch;
  std::size_t states = 0;
  for (auto _ : state) {
    double sum = 0;
    states = inverse_dynamics_along<double>(
        *m.dynamics(), parameters, m.info().modes.front(), samples, {}, scratch,
        [&](std::size_t, const ActuatorState<double>& drive) { sum += drive.forces[0]; });
    benchmark::DoNotOptimize(sum);
  }
  if (states < samples.size()) state.SkipWithError("a pose does not assemble");
  state.counters["per_state"] = benchmark::Counter(
      static_cast<double>(states), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void jointed_voxels(benchmark::State& state) { voxels(state, "3crr-r-cru", {.cells = kCells}); }
void rigid_voxels(benchmark::State& state) { voxels(state, "quadrupteron", {.cells = kCells}); }
void jointed_box(benchmark::State& state) { voxels(state, "3crr-r-cru", {.cells = kCells, .box = kInside}); }
void rigid_box(benchmark::State& state) { voxels(state, "quadrupteron", {.cells = kCells, .box = kInside}); }
void jointed_forces(benchmark::State& state) { drive_forces(state, "3crr-r-cru"); }
void rigid_forces(benchmark::State& state) { drive_forces(state, "quadrupteron"); }

BENCHMARK(jointed_voxels)->Name("coupling/voxels_40/3crr-r-cru")->Unit(benchmark::kMillisecond);
BENCHMARK(rigid_voxels)->Name("coupling/voxels_40/quadrupteron")->Unit(benchmark::kMillisecond);
BENCHMARK(jointed_box)->Name("coupling/feasible_box_40/3crr-r-cru")->Unit(benchmark::kMillisecond);
BENCHMARK(rigid_box)->Name("coupling/feasible_box_40/quadrupteron")->Unit(benchmark::kMillisecond);
BENCHMARK(task_box<double>)->Name("coupling/task_box")->Unit(benchmark::kMicrosecond);
BENCHMARK(task_box<Dual4>)->Name("coupling/task_box_gradient")->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_forces)->Name("coupling/inverse_dynamics/3crr-r-cru")->Unit(benchmark::kMicrosecond);
BENCHMARK(rigid_forces)->Name("coupling/inverse_dynamics/quadrupteron")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
