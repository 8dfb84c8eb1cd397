// Clearance: distance of two capsules, minimum over all pairs of links at a pose, and workspace analyses with a minimum
// clearance. `thick` is a design whose platform and upper links are so thick that each pose must be tested.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/accelerators/four_ppa_two_par/clearance.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

void capsule_pair(benchmark::State& state) {
  Stream stream(1, 0, 0, Stream::Use::start);
  const auto point = [&] { return Point3<double>{stream.u01(), stream.u01(), stream.u01()}; };
  std::vector<Capsule<double>> capsules(1025);
  for (auto& capsule : capsules) capsule = {{point(), point()}, 0.1 * stream.u01()};
  for (auto _ : state) {
    double sum = 0;
    for (std::size_t i = 1; i < capsules.size(); ++i) sum += capsule_distance(capsules[i - 1], capsules[i]);
    benchmark::DoNotOptimize(sum);
  }
  state.counters["pairs"] = benchmark::Counter(1024, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(capsule_pair)->Unit(benchmark::kMicrosecond);

void pose_clearance(benchmark::State& state) {
  const auto all = original_design();
  const auto g = geometry(std::span<const double>(all));
  const auto place = lower_placement(g, 0.37, -0.9, sincos(0.4).sin, sincos(0.4).cos);
  for (auto _ : state) benchmark::DoNotOptimize(testing::nearest_links(links(g, place)).clearance);
  state.counters["poses"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(pose_clearance)->Unit(benchmark::kMicrosecond);

std::vector<double> thick_design() {
  auto all = design(0.25, 0.55, 0.6, 0.3);
  all[kD] = 0.6;
  all[kDd] = 0.01;
  all[kRp] = 0.35;
  all[kRu] = 0.15;
  return all;
}

void analyse(benchmark::State& state, const std::vector<double>& all, double clearance_min, WorkspacePlan plan) {
  plan.limits.given[kClearanceMin] = clearance_min;
  const auto evaluator = prepare_workspace(four_ppa(), plan, {});
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.volume);
  }
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["error"] = result.error;
}
void voxels_original(benchmark::State& state) { analyse(state, original_design(), 0.02, voxel_plan(without_limits())); }
void columns_original(benchmark::State& state) {
  analyse(state, original_design(), 0.02, column_plan(without_limits()));
}
void voxels_thick(benchmark::State& state) { analyse(state, thick_design(), 0.2, voxel_plan(without_limits())); }
void columns_thick(benchmark::State& state) { analyse(state, thick_design(), 0.2, column_plan(without_limits())); }
void columns_thick_coarse(benchmark::State& state) {
  analyse(state, thick_design(), 0.2, column_plan(without_limits(), {}, 1e-2));
}
BENCHMARK(voxels_original)->Name("clearance/voxels_original")->Unit(benchmark::kMicrosecond);
BENCHMARK(columns_original)->Name("clearance/columns_original")->Unit(benchmark::kMicrosecond);
BENCHMARK(voxels_thick)->Name("clearance/voxels_thick")->Unit(benchmark::kMillisecond);
BENCHMARK(columns_thick)->Name("clearance/columns_thick")->Unit(benchmark::kMillisecond);
BENCHMARK(columns_thick_coarse)->Name("clearance/columns_thick_to_1e-2")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pkm::benchmarks
