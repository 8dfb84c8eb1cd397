// How far from the processor's limit: surveys against the time that their operations take at half of the peak.
//
// The operations are those of the kernel as it is written, counted by running it on a scalar that counts, or by hand
// where it says so: additions, multiplications, divisions and roots, each as one. The peak is measured in the same run
// (peak.hpp). It is that of fused multiply-adds, which we do not use, because they would change bits from one processor
// to another; a kernel of additions alone reaches half of it at best. Divisions and roots take 20 to 40 times as long
// on this processor as that bound gives them: the second bound counts them with their own measured time.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "benchmarks/counted.hpp"
#include "benchmarks/inputs.hpp"
#include "benchmarks/peak.hpp"
#include "benchmarks/timing.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/crr_cru/coupling.hpp"
#include "engine/mechanisms/four_ppa_two_par/columns.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm::benchmarks {
namespace {

/// A survey to be measured.
struct Work {
  const Mechanism& mechanism;
  std::vector<double> parameters;
  SurveyPlan plan;
  Demand demand = {};
};

/// Runs the survey, and says how it compares with the operations that it takes.
template <class Count>
void against_bound(benchmark::State& state, const Work& work, const Count& operations_of) {
  const auto surveyor = prepare_survey(work.mechanism, work.plan, work.demand);
  Scratch scratch;
  Survey<double> result;
  double seconds = 0;
  for (auto _ : state) {
    const double once = seconds_of([&] { surveyor->survey(work.parameters, scratch, result); });
    state.SetIterationTime(once);
    seconds += once;
  }
  const Operations n = operations_of(result);
  const double half = peak_flops() / 2, each = seconds / static_cast<double>(state.iterations());
  const double bound = static_cast<double>(n.all()) / half;
  const double of_roots = static_cast<double>(n.sums + n.products) / half +
                          static_cast<double>(n.quotients) * slow_operations().division +
                          static_cast<double>(n.roots) * slow_operations().root;
  state.counters["operations"] = static_cast<double>(n.all());
  state.counters["divisions_and_roots"] = static_cast<double>(n.quotients + n.roots);
  state.counters["bound_us"] = 1e6 * bound;
  state.counters["bound_with_roots_us"] = 1e6 * of_roots;
  state.counters["times_the_bound"] = each / bound;
  state.counters["times_the_bound_with_roots"] = each / of_roots;
  state.counters["percent_of_peak"] = 50 * bound / each;
}

Demand conditioning_too() {
  Demand demand;
  demand.add(kConditioning);
  return demand;
}

// 4PPa-2PaR, optimal, middle plane.

Work four_ppa_on(const SurveyPlan& plan, const Demand& demand = {}) {
  return {four_ppa(), optimal_design(), plan, demand};
}

// By hand from four_ppa_two_par_cells_kernel.cpp: a column takes 25 additions and multiplications (3 each in the two
// rounding steps) and 2 roots; symmetry leaves 16 x 32 columns of the grid, in whole blocks of eight thetas.
void voxels(benchmark::State& state) {
  constexpr Operations kColumn{15, 10, 0, 2};
  against_bound(state, four_ppa_on(voxel_plan(without_limits())),
                [&](const Survey<double>&) { return 16 * 32 * kColumn; });
}

void conditioning_of_voxels(benchmark::State& state) {
  using namespace four_ppa_two_par;
  const Operations pose = count([&] {
    const ColumnPoses<Counted> column{0.7, 1.0, 0.1, 0.99, {0.3, 0.4}, {0.6, 0.5}};
    benchmark::DoNotOptimize(conditioning<Counted, Counted>(column, {-0.3, -0.4}));
  });
  against_bound(state, four_ppa_on(voxel_plan(without_limits()), conditioning_too()),
                [&](const Survey<double>& s) { return static_cast<std::int64_t>(s.weight.size()) * pose; });
}

void columns(benchmark::State& state) {
  using namespace four_ppa_two_par;
  std::array<Counted, kParameters> counted;
  std::ranges::copy(optimal_design(), counted.begin());
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
  const Operations section{sections.sums / kSections, sections.products / kSections, sections.quotients / kSections,
                           sections.roots / kSections};
  against_bound(state, four_ppa_on(column_plan(without_limits())),
                [&](const Survey<double>& survey) { return survey.columns * section; });
}

// The others, nominal.

Work nominal(const std::string& name, const std::vector<HeldCoordinate>& held, const Demand& demand = {}) {
  const Mechanism& m = mechanism_named(name);
  Work work{m, {}, {}, demand};
  for (const Parameter& p : m.info().parameters) work.parameters.push_back(p.nominal);
  work.plan = {.method = kPaperGrid, .held = held, .limits = no_limits(m.info())};
  return work;
}

// By hand from hybrid_cells_kernel.cpp: four squares of 5, two roots, 11 for the ends of a column and 4 for its cells,
// at 34 x 60 columns. Not counted: twelve more, and another root, where a column has a hole.
void hybrid_voxels(benchmark::State& state) {
  constexpr Operations kColumn{21, 14, 0, 2};
  against_bound(state, nominal("2t1r-p-hybrid", {}), [&](const Survey<double>&) { return 34 * 60 * kColumn; });
}

void hybrid_conditioning(benchmark::State& state) {
  const Operations pose = count([] {
                            const Counted z(0.4), n1(0.2), n2(-0.2), n3(0.1), N1(0.3), N2(0.1);
                            const Rows3<Counted> J = {{{Counted(1.0), z / n1, Counted(0.0)},
                                                       {Counted(1.0), z / n2, Counted(0.0)},
                                                       {Counted(1.0), N1 / n3, N2 / n3 / Counted(0.1)}}};
                            const ExtremeSingularValues<Counted> s = extreme_singular_values(J);
                            benchmark::DoNotOptimize(inverse_condition_of(s.least_2(), s.greatest_2));
                          }) +
                          Operations{11, 17, 0, 3};  // by hand: k, N1, N2, and the three n with their roots
  constexpr Operations kColumn{21, 14, 0, 2};
  against_bound(state, nominal("2t1r-p-hybrid", {}, conditioning_too()), [&](const Survey<double>& s) {
    return 34 * 60 * kColumn + static_cast<std::int64_t>(s.weight.size()) * pose;
  });
}

// By hand from crr_cru_rings_kernel.cpp: 82 for each line of cells and ring, of which 2 are roots. What bits take,
// which are no numbers, is not in the bound.
constexpr Operations kLine{56, 24, 0, 2};

// phi held: one table for each pair of x, y, z, with one ring for x, y (32 lines) and y, z (34, in whole lanes) and two
// for x, z (32).
void jointed_voxels(benchmark::State& state) {
  Work work = nominal("3crr-r-cru", {held_at(3, 0.3)});
  work.plan.limits.given[0] = 0.2;
  work.plan.limits.given[1] = 0.1;
  against_bound(state, work, [&](const Survey<double>&) { return (32 + 2 * 32 + 40) * kLine; });
}

// x held: at each of 60 phi, 32 lines along z for limb 1, and single ones, in whole lanes, for the other three.
void jointed_voxels_over_phi(benchmark::State& state) {
  Work work = nominal("3crr-r-cru", {held_at(0, 0.21)});
  work.plan.limits.given[0] = 0.2;
  work.plan.limits.given[1] = 0.1;
  against_bound(state, work, [&](const Survey<double>&) { return 60 * (32 + 3 * 8) * kLine; });
}

void coupling_of_voxels(benchmark::State& state) {
  using namespace crr_cru;
  Work work = nominal("3crr-r-cru", {held_at(3, 0.3)});
  work.demand.add(kCouplingIndex);
  work.plan.method = VoxelOptions{.cells = {40, 40, 40}};
  const Operations pose =
      count([] {
        InertiaFrame<Counted> frame{};
        const PlaneInertia<Counted> share{2.0, 0.1, 3.0};
        benchmark::DoNotOptimize(joint_inertia(frame, share, share, share, share));
      }) +
      Operations{8 + 4 * 16, 4 * 17, 4, 0};  // by hand: coupling_indices, four portable exponentials
  against_bound(state, work,
                [&](const Survey<double>& s) { return static_cast<std::int64_t>(s.weight.size()) * pose; });
}

void measure(const char* name, void (*work)(benchmark::State&)) {
  benchmark::RegisterBenchmark(("operations/" + std::string(name)).c_str(), work)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime();
}
const bool kRegistered = [] {
  measure("voxels", voxels);
  measure("conditioning_of_voxels", conditioning_of_voxels);
  measure("columns", columns);
  measure("hybrid_voxels", hybrid_voxels);
  measure("hybrid_conditioning_of_voxels", hybrid_conditioning);
  measure("3crr-r-cru_voxels", jointed_voxels);
  measure("3crr-r-cru_voxels_over_phi", jointed_voxels_over_phi);
  measure("3crr-r-cru_coupling_of_voxels", coupling_of_voxels);
  return true;
}();

}  // namespace
}  // namespace pkm::benchmarks
