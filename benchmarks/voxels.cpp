// Voxels: the test of one pose, a hand-written loop over the voxels, and the voxel counts of the workspace evaluator.
#include <cmath>

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/peers/voxel_loop.hpp"
#include "benchmarks/timing.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/core/team.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;
using Design = std::vector<double> (*)();

void pose_test(benchmark::State& state) {
  const auto all = original_design();
  const auto g = geometry(std::span<const double>(all));
  const auto l = limits(g, with_limits());
  const Box box = default_box(g);
  struct Sample {
    double x, z, sin, cos;
  };
  std::vector<Sample> samples(4096);
  Stream stream(1, 0, 0, Stream::Use::start);
  const auto within = [&](std::size_t axis) { return box[axis][0] + (box[axis][1] - box[axis][0]) * stream.u01(); };
  for (Sample& sample : samples) {
    sample.x = within(0);
    sample.z = within(1);
    const auto [s, c] = sincos(within(2));
    sample.sin = s;
    sample.cos = c;
  }
  for (auto _ : state) {
    std::int64_t count = 0;
    for (const Sample& p : samples) count += testing::feasible(g, l, p.x, g.L0 / 2, p.z, p.sin, p.cos);
    benchmark::DoNotOptimize(count);
  }
  const auto poses = static_cast<double>(samples.size());
  state.counters["poses"] = benchmark::Counter(poses, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(pose_test)->Unit(benchmark::kMicrosecond);

void analyse(benchmark::State& state, Design design, LimitSpec (*limits_of)()) {
  const auto all = design();
  const auto evaluator = prepare_workspace(four_ppa(), voxel_plan(limits_of()), {});
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.feasible_cells);
  }
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["cells_found"] = static_cast<double>(result.feasible_cells);
}
BENCHMARK_CAPTURE(analyse, original, original_design, without_limits)
    ->Name("voxels/original")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyse, optimal, optimal_design, without_limits)
    ->Name("voxels/optimal")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyse, limits, original_design, with_limits)
    ->Name("voxels/original_with_limits")
    ->Unit(benchmark::kMicrosecond);

// Off the symmetry plane all columns must be computed.
void off_plane(benchmark::State& state) {
  const auto all = optimal_design();
  WorkspacePlan plan = voxel_plan(without_limits());
  plan.fixed = {fixed_at(1, 1.2)};
  const auto evaluator = prepare_workspace(four_ppa(), plan, {});
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.feasible_cells);
  }
}
BENCHMARK(off_plane)->Name("voxels/off_plane")->Unit(benchmark::kMicrosecond);

// Effect of wider vectors; `set` is 0 for the baseline instruction set, 1 for AVX2, 2 for AVX-512.
void with_instruction_set(benchmark::State& state, bool conditioning) {
  const auto all = optimal_design();
  FieldRequest request;
  if (conditioning) request.add(kConditioning);
  const auto evaluator = prepare_workspace(four_ppa(), voxel_plan(without_limits()), request);
  Scratch scratch;
  WorkspaceResult<double> result;
  use_instruction_set(static_cast<InstructionSet>(state.range(0)));
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.volume);
  }
  use_instruction_set(widest_instruction_set());
}
const int kWidestSet = static_cast<int>(widest_instruction_set());
BENCHMARK_CAPTURE(with_instruction_set, count, false)
    ->Name("instruction_set/voxels")
    ->ArgName("set")
    ->DenseRange(0, kWidestSet)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(with_instruction_set, conditioning, true)
    ->Name("instruction_set/conditioning")
    ->ArgName("set")
    ->DenseRange(0, kWidestSet)
    ->Unit(benchmark::kMicrosecond);

// Grids of n^3 voxels: the cost is proportional to the n^2 columns.
void grid(benchmark::State& state) {
  const auto all = optimal_design();
  WorkspacePlan plan = voxel_plan(without_limits());
  plan.method = VoxelOptions{.cells = {state.range(0), state.range(0), state.range(0)}};
  const auto evaluator = prepare_workspace(four_ppa(), plan, {});
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.feasible_cells);
  }
  const auto n = static_cast<double>(state.range(0));
  state.counters["columns"] = benchmark::Counter(n * n, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["cells"] = benchmark::Counter(n * n * n, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(grid)->Name("voxels/grid")->RangeMultiplier(2)->Range(16, 1024)->Unit(benchmark::kMicrosecond);

// One design on a fine grid of n^3 voxels, on one and on two threads.
void fine_grid(benchmark::State& state, const Mechanism& mechanism, std::vector<double> parameters, std::int64_t n,
               const FieldRequest& request = {}) {
  const WorkspacePlan plan{.method = VoxelOptions{.cells = {n, n, n}}, .limits = no_limits(mechanism.info())};
  const auto evaluator = prepare_workspace(mechanism, plan, request);
  if (parameters.empty())
    for (const Parameter& p : mechanism.info().parameters) parameters.push_back(p.nominal);
  Scratch scratch;
  WorkspaceResult<double> result;
  const auto by_one = [&] {
    const SerialScope alone;
    evaluator->evaluate(parameters, scratch, result);
  };
  const auto by_two = [&] { evaluator->evaluate(parameters, scratch, result); };
  PairedTimes times;
  with_team(2, [&] {
    times = time_alternately(state, "ten_by_one_thread_s", repeat_10_times(by_one), "ten_by_two_threads_s",
                             repeat_10_times(by_two));
  });
  state.counters["efficiency_percent"] = 100 * times.ratio() / 2;
}
void fine_four_ppa(benchmark::State& state) { fine_grid(state, four_ppa(), optimal_design(), 512); }
void fine_conditioning(benchmark::State& state) {
  FieldRequest request;
  request.add(kConditioning);
  fine_grid(state, four_ppa(), optimal_design(), 128, request);
}
void fine_hybrid(benchmark::State& state) { fine_grid(state, mechanism_named("2t1r-p-hybrid"), {}, 512); }
void fine_jointed(benchmark::State& state) { fine_grid(state, mechanism_named("3crr-r-cru"), {}, 512); }
BENCHMARK(fine_four_ppa)->Name("fine_grid/512_cubed")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(fine_conditioning)->Name("fine_grid/conditioning_128_cubed")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(fine_hybrid)->Name("fine_grid/2t1r-p-hybrid_512_cubed")->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(fine_jointed)->Name("fine_grid/3crr-r-cru_512_cubed")->Unit(benchmark::kMicrosecond)->UseRealTime();

void compare_with_loop(benchmark::State& state, Design design) {
  const auto all = design();
  const auto g = geometry(std::span<const double>(all));
  const auto evaluator = prepare_workspace(four_ppa(), voxel_plan(without_limits()), {});
  const peers::Voxels voxels{g.d, g.L0, {32, 34, 60}, 0, 0, kPi / 2, 0, 0, 0};  // the paper's grid, no limits
  const peers::Design lengths{g.a, g.b, g.l_u, g.l_d};
  std::int64_t loop_count = 0;
  Scratch scratch;
  WorkspaceResult<double> result;
  const PairedTimes times = time_alternately(
      state, "loop_s", [&] { benchmark::DoNotOptimize(loop_count = peers::feasible_cells(voxels, lengths)); },
      "analysis_s", [&] { evaluator->evaluate(all, scratch, result); });
  state.counters["speedup"] = times.ratio();
  if (loop_count != result.feasible_cells)
    state.SkipWithError("the loop and the workspace analysis count different voxels");
}
BENCHMARK_CAPTURE(compare_with_loop, original, original_design)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(compare_with_loop, optimal, optimal_design)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
