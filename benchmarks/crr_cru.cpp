// Workspace volumes of the nominal (3CRR/R)&CRU and Quadrupteron with singularity limits, for each coordinate that can
// be fixed.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

/// @param fixed_index  index of the fixed coordinate, 0 to 3; its value is off the centre, where the ranges of the
/// slides coincide
template <class Method>
WorkspacePlan plan_of(const MechanismInfo& info, const Method& method, int fixed_index) {
  WorkspacePlan plan{
      .method = method, .fixed = {fixed_at(fixed_index, fixed_index == 3 ? 0.3 : 0.21)}, .limits = no_limits(info)};
  plan.limits.given[0] = 0.2;  // s_min
  plan.limits.given[1] = 0.1;  // c_min
  return plan;
}

template <class S, class Method>
void analyse(benchmark::State& state, const char* name, const Method& method) {
  const Mechanism& mechanism = mechanism_named(name);
  std::vector<S> parameters;
  for (const Parameter& p : mechanism.info().parameters) parameters.push_back(p.nominal);
  const auto evaluator =
      prepare_workspace(mechanism, plan_of(mechanism.info(), method, static_cast<int>(state.range(0))), {});
  Scratch scratch;
  WorkspaceResult<S> result;
  for (auto _ : state) {
    evaluate_workspace<S>(*evaluator, parameters, scratch, result);
    benchmark::DoNotOptimize(result.volume);
  }
}

void jointed_columns(benchmark::State& state) { analyse<double>(state, "3crr-r-cru", ColumnOptions()); }
void jointed_gradient(benchmark::State& state) { analyse<Dual4>(state, "3crr-r-cru", ColumnOptions()); }
void jointed_voxels(benchmark::State& state) { analyse<double>(state, "3crr-r-cru", kPaperGrid); }
void rigid_columns(benchmark::State& state) { analyse<double>(state, "quadrupteron", ColumnOptions()); }
void rigid_voxels(benchmark::State& state) { analyse<double>(state, "quadrupteron", kPaperGrid); }

BENCHMARK(jointed_columns)->Name("crr_cru/columns/fixed")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_gradient)->Name("crr_cru/columns_gradient/fixed")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_voxels)->Name("crr_cru/voxels/fixed")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(rigid_columns)->Name("quadrupteron/columns/fixed")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(rigid_voxels)->Name("quadrupteron/voxels/fixed")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
