// How far from the processor's limit: surveys against the time that their operations take at half of the peak.
//
// The operations are those of the kernel as it is written, counted by running it on a scalar that counts: additions,
// multiplications, divisions and roots, each as one. The peak is measured in the same run (peak.hpp). It is that of
// fused multiply-adds, which we do not use, because they would change bits from one processor to another; a kernel of
// additions alone reaches half of it at best, and a vector root takes as long as some 30 of them.
#include <benchmark/benchmark.h>

#include "benchmarks/counted.hpp"
#include "benchmarks/inputs.hpp"
#include "benchmarks/peak.hpp"
#include "benchmarks/timing.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/four_ppa_two_par_columns.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

/// Runs the survey, and says how it compares with `count` operations for each of what it counts.
template <class Count>
void against_bound(benchmark::State& state, const SurveyPlan& plan, const Demand& demand, const Count& operations_of) {
  const auto all = optimal_design();
  const auto surveyor = four_ppa().prepare(plan, demand);
  Survey<double> result;
  double seconds = 0;
  for (auto _ : state) {
    const double once = seconds_of([&] { surveyor->survey(all, result); });
    state.SetIterationTime(once);
    seconds += once;
  }
  const double operations = operations_of(result), bound = operations / (peak_flops() / 2);
  state.counters["operations"] = operations;
  state.counters["bound_us"] = 1e6 * bound;
  state.counters["times_the_bound"] = seconds / static_cast<double>(state.iterations()) / bound;
  state.counters["percent_of_peak"] = 50 * bound * static_cast<double>(state.iterations()) / seconds;
}

std::array<Counted, kParameters> counted_design() {
  std::array<Counted, kParameters> counted;
  const auto all = optimal_design();
  for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = all[i];
  return counted;
}

void columns(benchmark::State& state) {
  const auto counted = counted_design();
  const auto g = geometry(std::span<const Counted>(counted));
  const auto f = frame(g, limits(g, without_limits()), Counted(g.L0 * 0.5));
  Counted sum(0.0);
  constexpr int kSections = 50;
  const Operations sections = count([&] {
    for (int i = 0; i < kSections; ++i) {
      const auto [s, c] = sincos(Counted(1.5 * (i + 0.5) / kSections));
      sum += area(f, section(f, s, c));
    }
  });
  benchmark::DoNotOptimize(sum);
  against_bound(state, column_plan(without_limits()), {}, [&](const Survey<double>& survey) {
    return static_cast<double>(survey.columns * sections.all()) / kSections;
  });
}
BENCHMARK(columns)->Name("operations/columns")->Unit(benchmark::kMicrosecond)->UseManualTime();

void conditioning_of_voxels(benchmark::State& state) {
  const Operations pose = count([&] {
    const ColumnPoses<Counted> column{0.7, 1.0, 0.1, 0.99, {0.3, 0.4}, {0.6, 0.5}};
    benchmark::DoNotOptimize(conditioning<Counted, Counted>(column, {-0.3, -0.4}));
  });
  Demand demand;
  demand.conditioning = true;
  SurveyPlan plan = voxel_plan(without_limits());
  against_bound(state, plan, demand, [&](const Survey<double>& survey) {
    return static_cast<double>(survey.weight.size()) * static_cast<double>(pose.all());
  });
}
BENCHMARK(conditioning_of_voxels)
    ->Name("operations/conditioning_of_voxels")
    ->Unit(benchmark::kMicrosecond)
    ->UseManualTime();

// By hand from four_ppa_two_par_cells_kernel.cpp: a column takes 25 additions and multiplications (3 each in the two
// rounding steps) and 2 roots; symmetry leaves 16 x 32 columns of the grid, in whole blocks of eight thetas.
void voxels(benchmark::State& state) {
  constexpr double kColumn = 27, kColumns = 16 * 32;
  against_bound(state, voxel_plan(without_limits()), {}, [&](const Survey<double>&) { return kColumn * kColumns; });
}
BENCHMARK(voxels)->Name("operations/voxels")->Unit(benchmark::kMicrosecond)->UseManualTime();

}  // namespace
}  // namespace pkm::benchmarks
