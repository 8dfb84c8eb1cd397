// Distance from the processor's limit (as in the roofline model): times of workspace analyses, compared with the time
// of their floating-point operations at half of the peak performance.
//
// The operations (additions, multiplications, divisions and square roots, each counted as one) are those of the
// kernel's source code, counted by running it on a counting scalar (counting_scalar.hpp), or by hand where noted. The
// peak is measured in the same run (peak.hpp). It is that of fused multiply-adds, which pkmopt does not use, because
// results would then depend on the processor; without them at most half of the peak is possible. Divisions and square
// roots take 20 to 40 times as long on this processor as the first bound assumes: the second bound uses their measured
// times.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "benchmarks/counting_scalar.hpp"
#include "benchmarks/inputs.hpp"
#include "benchmarks/peak.hpp"
#include "benchmarks/timing.hpp"
#include "engine/accelerators/crr_cru/coupling.hpp"
#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

/// A workspace analysis to be measured.
struct Case {
  const Mechanism& mechanism;
  std::vector<double> parameters;
  WorkspacePlan plan;
  FieldRequest request = {};
};

/// Times the workspace analysis, and reports the ratio to the bounds from its number of operations.
template <class Count>
void compare_with_bound(benchmark::State& state, const Case& benchmark_case, const Count& operations_of) {
  const auto evaluator = prepare_workspace(benchmark_case.mechanism, benchmark_case.plan, benchmark_case.request);
  Scratch scratch;
  WorkspaceResult<double> result;
  double seconds = 0;
  for (auto _ : state) {
    const double elapsed = seconds_of([&] { evaluator->evaluate(benchmark_case.parameters, scratch, result); });
    state.SetIterationTime(elapsed);
    seconds += elapsed;
  }
  const Operations n = operations_of(result);
  const double half_peak = peak_flops() / 2, seconds_each = seconds / static_cast<double>(state.iterations());
  const double bound = static_cast<double>(n.all()) / half_peak;
  const double bound_with_roots = static_cast<double>(n.sums + n.products) / half_peak +
                                  static_cast<double>(n.quotients) * division_and_root_times().division +
                                  static_cast<double>(n.roots) * division_and_root_times().root;
  state.counters["operations"] = static_cast<double>(n.all());
  state.counters["divisions_and_roots"] = static_cast<double>(n.quotients + n.roots);
  state.counters["bound_us"] = 1e6 * bound;
  state.counters["bound_with_roots_us"] = 1e6 * bound_with_roots;
  state.counters["times_the_bound"] = seconds_each / bound;
  state.counters["times_the_bound_with_roots"] = seconds_each / bound_with_roots;
  state.counters["percent_of_peak"] = 50 * bound / seconds_each;
}

FieldRequest conditioning_too() {
  FieldRequest request;
  request.add(kConditioning);
  return request;
}

// 4PPa-2PaR: optimal design on the symmetry plane.

Case four_ppa_on(const WorkspacePlan& plan, const FieldRequest& request = {}) {
  return {four_ppa(), optimal_design(), plan, request};
}

// Counted by hand from four_ppa_two_par_cells_kernel.cpp: a column takes 25 additions and multiplications (3 each in
// the two rounding steps) and 2 square roots; by symmetry only 16 x 32 columns of the grid are computed, in blocks of
// eight thetas.
void voxels(benchmark::State& state) {
  constexpr Operations kColumn{15, 10, 0, 2};
  compare_with_bound(state, four_ppa_on(voxel_plan(without_limits())),
                     [&](const WorkspaceResult<double>&) { return 16 * 32 * kColumn; });
}

void conditioning_of_voxels(benchmark::State& state) {
  using namespace four_ppa_two_par;
  const Operations pose = count([&] {
    const ColumnPoses<Counted> column{0.7, 1.0, 0.1, 0.99, {0.3, 0.4}, {0.6, 0.5}};
    benchmark::DoNotOptimize(conditioning<Counted, Counted>(column, {-0.3, -0.4}));
  });
  compare_with_bound(
      state, four_ppa_on(voxel_plan(without_limits()), conditioning_too()),
      [&](const WorkspaceResult<double>& s) { return static_cast<std::int64_t>(s.weight.size()) * pose; });
}

void columns(benchmark::State& state) {
  using namespace four_ppa_two_par;
  std::array<Counted, kParameters> counted;
  std::ranges::copy(optimal_design(), counted.begin());
  const auto g = geometry(std::span<const Counted>(counted));
  const auto f = sliced_design(g, limits(g, without_limits()), Counted(g.L0 * 0.5));
  Counted sum(0.0);
  constexpr int kSlices = 50;
  const Operations slice_operations = count([&] {
    for (int i = 0; i < kSlices; ++i) {
      const auto [s, c] = sincos(Counted(1.5 * (i + 0.5) / kSlices));
      sum += area(f, slice(f, s, c));
    }
  });
  benchmark::DoNotOptimize(sum);
  const Operations operations_per_slice{slice_operations.sums / kSlices, slice_operations.products / kSlices,
                                        slice_operations.quotients / kSlices, slice_operations.roots / kSlices};
  compare_with_bound(state, four_ppa_on(column_plan(without_limits())),
                     [&](const WorkspaceResult<double>& result) { return result.columns * operations_per_slice; });
}

// The other mechanisms: nominal designs.

Case nominal_case(const std::string& name, const std::vector<FixedCoordinate>& fixed_coordinates,
                  const FieldRequest& request = {}) {
  const Mechanism& m = mechanism_named(name);
  Case benchmark_case{m, {}, {}, request};
  for (const Parameter& p : m.info().parameters) benchmark_case.parameters.push_back(p.nominal);
  benchmark_case.plan = {.method = kPaperGrid, .fixed = fixed_coordinates, .limits = no_limits(m.info())};
  return benchmark_case;
}

// Counted by hand from hybrid_cells_kernel.cpp: four squares of 5 operations each, two square roots, 11 operations for
// the endpoints of a column and 4 for its voxels, for 34 x 60 columns. Not counted: twelve more operations and another
// square root if a column has a hole.
void hybrid_voxels(benchmark::State& state) {
  constexpr Operations kColumn{21, 14, 0, 2};
  compare_with_bound(state, nominal_case("2t1r-p-hybrid", {}),
                     [&](const WorkspaceResult<double>&) { return 34 * 60 * kColumn; });
}

void hybrid_conditioning(benchmark::State& state) {
  const Operations pose = count([] {
                            const Counted z(0.4), n1(0.2), n2(-0.2), n3(0.1), N1(0.3), N2(0.1);
                            const Rows3<Counted> J = {{{Counted(1.0), z / n1, Counted(0.0)},
                                                       {Counted(1.0), z / n2, Counted(0.0)},
                                                       {Counted(1.0), N1 / n3, N2 / n3 / Counted(0.1)}}};
                            const ExtremeSingularValues<Counted> s = extreme_singular_values(J);
                            benchmark::DoNotOptimize(inverse_condition_of(s.min_squared(), s.max_squared));
                          }) +
                          Operations{11, 17, 0, 3};  // by hand: k, N1, N2, and the three n with their square roots
  constexpr Operations kColumn{21, 14, 0, 2};
  compare_with_bound(state, nominal_case("2t1r-p-hybrid", {}, conditioning_too()),
                     [&](const WorkspaceResult<double>& s) {
                       return 34 * 60 * kColumn + static_cast<std::int64_t>(s.weight.size()) * pose;
                     });
}

// Counted by hand from crr_cru_rings_kernel.cpp: 82 operations for each line of voxels and ring, of which 2 are square
// roots. Operations on bit sets are not floating-point operations and not in the bound.
constexpr Operations kLine{56, 24, 0, 2};

// phi fixed: one table for each pair of x, y, z, with one ring for x, y (32 lines) and for y, z (34 lines, rounded up
// to whole SIMD vectors), and two rings for x, z (32 lines).
void translating_voxels(benchmark::State& state) {
  Case benchmark_case = nominal_case("3crr-r-cru", {fixed_at(3, 0.3)});
  benchmark_case.plan.limits.given[0] = 0.2;
  benchmark_case.plan.limits.given[1] = 0.1;
  compare_with_bound(state, benchmark_case, [&](const WorkspaceResult<double>&) { return (32 + 2 * 32 + 40) * kLine; });
}

// x fixed: at each of 60 phi, 32 lines along z for limb 1, and one line, rounded up to a SIMD vector, for the other
// limbs.
void translating_voxels_over_phi(benchmark::State& state) {
  Case benchmark_case = nominal_case("3crr-r-cru", {fixed_at(0, 0.21)});
  benchmark_case.plan.limits.given[0] = 0.2;
  benchmark_case.plan.limits.given[1] = 0.1;
  compare_with_bound(state, benchmark_case, [&](const WorkspaceResult<double>&) { return 60 * (32 + 3 * 8) * kLine; });
}

void coupling_of_voxels(benchmark::State& state) {
  using namespace crr_cru;
  Case benchmark_case = nominal_case("3crr-r-cru", {fixed_at(3, 0.3)});
  benchmark_case.request.add(kCouplingIndex);
  benchmark_case.plan.method = VoxelOptions{.cells = {40, 40, 40}};
  const Operations pose =
      count([] {
        const PlaneInertia<Counted> limb{2.0, 0.1, 3.0};
        benchmark::DoNotOptimize(joint_inertia(YawInertia<Counted>{}, std::array{limb, limb, limb, limb}));
      }) +
      Operations{8 + 4 * 16, 4 * 17, 4, 0};  // by hand: coupling_indices, with four portable exponential functions
  compare_with_bound(state, benchmark_case, [&](const WorkspaceResult<double>& s) {
    return static_cast<std::int64_t>(s.weight.size()) * pose;
  });
}

void add(const char* name, void (*benchmark_case)(benchmark::State&)) {
  benchmark::RegisterBenchmark(("operations/" + std::string(name)).c_str(), benchmark_case)
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime();
}
const bool kOperationsRegistered = [] {
  add("voxels", voxels);
  add("conditioning_of_voxels", conditioning_of_voxels);
  add("columns", columns);
  add("hybrid_voxels", hybrid_voxels);
  add("hybrid_conditioning_of_voxels", hybrid_conditioning);
  add("3crr-r-cru_voxels", translating_voxels);
  add("3crr-r-cru_voxels_over_phi", translating_voxels_over_phi);
  add("3crr-r-cru_coupling_of_voxels", coupling_of_voxels);
  return true;
}();

}  // namespace
}  // namespace pkm::benchmarks
