// Joint-space inertia, coupling indices and drive forces of (3CRR/R)&CRU and the Quadrupteron, nominal.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "engine/math/statistics.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/crr_cru/dynamics.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm::benchmarks {
namespace {

std::vector<double> nominal(const Mechanism& m) {
  std::vector<double> parameters;
  for (const Parameter& p : m.info().parameters) parameters.push_back(p.nominal);
  return parameters;
}

SurveyPlan plan_of(const std::variant<ColumnOptions, VoxelOptions>& method) {
  SurveyPlan plan{.method = method, .held = {held_at(3, 0.3)}};
  plan.limits = no_limits(mechanism_named("quadrupteron").info());
  plan.limits.given[0] = 0.2;
  plan.limits.given[1] = 0.1;
  return plan;
}

constexpr std::array<std::int64_t, 3> kCells = {40, 40, 40};
constexpr Box kInside = {{{0.12, 0.2}, {0.12, 0.2}, {0.17, 0.24}}};

Demand coupling() {
  Demand demand;
  demand.add(kCouplingIndex);
  return demand;
}

/// A survey of 40 x 40 x 40 voxels that cover all that is reached; time per feasible pose besides.
void voxels(benchmark::State& state, const char* name) {
  const Mechanism& m = mechanism_named(name);
  const auto parameters = nominal(m);
  const auto surveyor = prepare_survey(m, plan_of(VoxelOptions{.cells = kCells}), coupling());
  Scratch scratch;
  Survey<double> survey;
  for (auto _ : state) {
    surveyor->survey(parameters, scratch, survey);
    benchmark::DoNotOptimize(survey.of(kCouplingIndex, 0).data());
  }
  state.counters["feasible"] = static_cast<double>(survey.weight.size());
  state.counters["per_pose"] =
      benchmark::Counter(static_cast<double>(survey.weight.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The same number of cells in a box that is feasible as a whole: 64000 poses.
void full_box(benchmark::State& state, const char* name) {
  const Mechanism& m = mechanism_named(name);
  const auto parameters = nominal(m);
  const auto surveyor = prepare_survey(m, plan_of(VoxelOptions{.cells = kCells, .box = kInside}), coupling());
  Scratch scratch;
  Survey<double> survey;
  for (auto _ : state) {
    surveyor->survey(parameters, scratch, survey);
    benchmark::DoNotOptimize(survey.of(kCouplingIndex, 0).data());
  }
  state.counters["feasible"] = static_cast<double>(survey.weight.size());
  state.counters["per_pose"] =
      benchmark::Counter(static_cast<double>(survey.weight.size()),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Mean worst index over a task box at five angles, by column nodes.
template <class S>
void task_box(benchmark::State& state) {
  const Mechanism& m = mechanism_named("3crr-r-cru");
  const auto values = nominal(m);
  const std::vector<S> parameters(values.begin(), values.end());
  SurveyPlan plan = plan_of(ColumnOptions{.nodes = {4, 4}, .box = kInside});
  plan.held = {{.coordinate = 3, .kind = HeldCoordinate::Kind::listed, .values = {-1, -0.5, 0, 0.5, 1}}};
  const auto surveyor = prepare_survey(m, plan, coupling());
  Scratch scratch;
  Survey<S> survey;
  for (auto _ : state) {
    run_survey<S>(*surveyor, parameters, scratch, survey);
    benchmark::DoNotOptimize(weighted_mean(survey.weight, survey.of(kCouplingIndex, 3)));
  }
  state.counters["poses"] = static_cast<double>(survey.weight.size());
}

/// Inverse dynamics by virtual work at one pose and motion.
void inverse_dynamics(benchmark::State& state, const char* name) {
  const Mechanism& m = mechanism_named(name);
  const auto p = nominal(m);
  const auto platform = std::string(name) == "quadrupteron" ? crr_cru::Platform::rigid : crr_cru::Platform::jointed;
  const auto g = crr_cru::geometry(platform, std::span<const double>(p));
  const auto b = crr_cru::masses(crr_cru::MassModel::table, std::span<const double>(p));
  MotionState<double, 4> at{{0.2, 0.17, 0.22, 0.3}, {{0.3, -0.2, 0.1, 1}}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(at);
    const auto d = crr_cru::pose_dynamics(g, b, at, {-1, -1, 1, -1});
    benchmark::DoNotOptimize(drive_forces(d, {{5, -4, 3, 20}}, {}));
  }
}

void jointed_voxels(benchmark::State& state) { voxels(state, "3crr-r-cru"); }
void rigid_voxels(benchmark::State& state) { voxels(state, "quadrupteron"); }
void jointed_box(benchmark::State& state) { full_box(state, "3crr-r-cru"); }
void rigid_box(benchmark::State& state) { full_box(state, "quadrupteron"); }
void jointed_forces(benchmark::State& state) { inverse_dynamics(state, "3crr-r-cru"); }
void rigid_forces(benchmark::State& state) { inverse_dynamics(state, "quadrupteron"); }

BENCHMARK(jointed_voxels)->Name("coupling/voxels_40/3crr-r-cru")->Unit(benchmark::kMillisecond);
BENCHMARK(rigid_voxels)->Name("coupling/voxels_40/quadrupteron")->Unit(benchmark::kMillisecond);
BENCHMARK(jointed_box)->Name("coupling/feasible_box_40/3crr-r-cru")->Unit(benchmark::kMillisecond);
BENCHMARK(rigid_box)->Name("coupling/feasible_box_40/quadrupteron")->Unit(benchmark::kMillisecond);
BENCHMARK(task_box<double>)->Name("coupling/task_box")->Unit(benchmark::kMicrosecond);
BENCHMARK(task_box<Dual4>)->Name("coupling/task_box_gradient")->Unit(benchmark::kMicrosecond);
BENCHMARK(jointed_forces)->Name("coupling/inverse_dynamics/3crr-r-cru")->Unit(benchmark::kNanosecond);
BENCHMARK(rigid_forces)->Name("coupling/inverse_dynamics/quadrupteron")->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace pkm::benchmarks
