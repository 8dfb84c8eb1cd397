// Conditioning: one pose, and its mean over the workspace.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/accelerators/four_ppa_two_par/conditioning.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

void pose(benchmark::State& state) {
  const auto all = original_design();
  const auto g = geometry(std::span<const double>(all));
  struct Sample {
    double sin, cos;
    std::array<double, 2> x, sigma, z_c;
  };
  std::vector<Sample> samples(4096);
  Stream stream(1, 0, 0, Stream::Use::start);
  for (Sample& sample : samples) {
    const auto [s, c] = sincos(kPi * (stream.u01() - 0.5));
    sample.sin = s;
    sample.cos = c;
    for (std::size_t j = 0; j < 2; ++j) {
      sample.x[j] = g.l_d * (0.02 + 0.96 * stream.u01());
      sample.sigma[j] = std::sqrt((g.l_d - sample.x[j]) * (g.l_d + sample.x[j]));
      sample.z_c[j] = -g.l_u * (0.02 + 0.96 * stream.u01());
    }
  }
  for (auto _ : state) {
    double sum = 0;
    for (const Sample& p : samples)
      sum += conditioning<double, double>({g.l_u, 1.0, p.sin, p.cos, p.x, p.sigma}, p.z_c);
    benchmark::DoNotOptimize(sum);
  }
  const auto poses = static_cast<double>(samples.size());
  state.counters["poses"] = benchmark::Counter(poses, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(pose)->Name("conditioning/pose")->Unit(benchmark::kMicrosecond);

void analyse(benchmark::State& state, WorkspacePlan plan) {
  FieldRequest request;
  request.add(kConditioning);
  const auto evaluator = prepare_workspace(four_ppa(), plan, request);
  const auto all = original_design();
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(all, scratch, result);
    benchmark::DoNotOptimize(result.field(kConditioning).data());
  }
  const auto poses = static_cast<double>(result.field(kConditioning).size());
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["poses"] = benchmark::Counter(poses, benchmark::Counter::kIsIterationInvariantRate);
}
void analyse_voxels(benchmark::State& state) { analyse(state, voxel_plan(without_limits())); }
void analyse_columns(benchmark::State& state) { analyse(state, column_plan(without_limits())); }
BENCHMARK(analyse_voxels)->Name("conditioning/voxels")->Unit(benchmark::kMicrosecond);
BENCHMARK(analyse_columns)->Name("conditioning/columns")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
