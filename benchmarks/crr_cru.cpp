// Surveys of (3CRR/R)&CRU and the Quadrupteron, nominal, with margins: for each coordinate that may be held.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm::benchmarks {
namespace {

/// @param held  0 to 3; off the middle, where slides' ranges would coincide
template <class Method>
SurveyPlan plan_of(const MechanismInfo& info, const Method& method, int held) {
  SurveyPlan plan{.method = method, .held = {held_at(held, held == 3 ? 0.3 : 0.21)}, .limits = no_limits(info)};
  plan.limits.given[0] = 0.2;  // s_min
  plan.limits.given[1] = 0.1;  // c_min
  return plan;
}

template <class S, class Method>
void survey(benchmark::State& state, const char* name, const Method& method) {
  const Mechanism& mechanism = mechanism_named(name);
  std::vector<S> parameters;
  for (const Parameter& p : mechanism.info().parameters) parameters.push_back(p.nominal);
  const auto surveyor =
      prepare_survey(mechanism, plan_of(mechanism.info(), method, static_cast<int>(state.range(0))), {});
  Scratch scratch;
  Survey<S> result;
  for (auto _ : state) {
    run_survey<S>(*surveyor, parameters, scratch, result);
    benchmark::DoNotOptimize(result.volume);
  }
}

void jointed_columns(benchmark::State& state) { survey<double>(state, "3crr-r-cru", ColumnOptions()); }
void jointed_slopes(benchmark::State& state) { survey<Dual4>(state, "3crr-r-cru", ColumnOptions()); }
void jointed_voxels(benchmark::State& state) { survey<double>(state, "3crr-r-cru", kPaperGrid); }
void rigid_columns(benchmark::State& state) { survey<double>(state, "quadrupteron", ColumnOptions()); }
void rigid_voxels(benchmark::State& state) { survey<double>(state, "quadrupteron", kPaperGrid); }

BENCHMARK(jointed_columns)->Name("crr_cru/columns/held")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_slopes)->Name("crr_cru/columns_gradient/held")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_voxels)->Name("crr_cru/voxels/held")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(rigid_columns)->Name("quadrupteron/columns/held")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);
BENCHMARK(rigid_voxels)->Name("quadrupteron/voxels/held")->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
