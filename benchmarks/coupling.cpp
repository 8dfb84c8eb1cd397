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

SurveyPlan plan_of(Method method) {
  SurveyPlan plan;
  plan.method = method;
  plan.cells = {40, 40, 40};
  plan.held = {HeldCoordinate::Kind::value, 0.3, 3};
  plan.limits = no_limits(mechanism_named("quadrupteron").info());
  plan.limits.given[0] = 0.2;
  plan.limits.given[1] = 0.1;
  return plan;
}

Demand coupling() {
  Demand demand;
  demand.dci = true;
  return demand;
}

/// A survey of 40 x 40 x 40 voxels that cover all that is reached; time per feasible pose besides.
void voxels(benchmark::State& state, const char* name) {
  const Mechanism& m = mechanism_named(name);
  const auto parameters = nominal(m);
  const auto surveyor = m.prepare(plan_of(Method::voxels), coupling());
  Survey<double> survey;
  for (auto _ : state) {
    surveyor->survey(std::span<const double>(parameters), survey);
    benchmark::DoNotOptimize(survey.dci[0].data());
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
  SurveyPlan plan = plan_of(Method::voxels);
  plan.box = {{{0.12, 0.2}, {0.12, 0.2}, {0.17, 0.24}}};
  const auto surveyor = m.prepare(plan, coupling());
  Survey<double> survey;
  for (auto _ : state) {
    surveyor->survey(std::span<const double>(parameters), survey);
    benchmark::DoNotOptimize(survey.dci[0].data());
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
  SurveyPlan plan = plan_of(Method::columns);
  plan.box = {{{0.12, 0.2}, {0.12, 0.2}, {0.17, 0.24}}};
  plan.nodes = {4, 4};
  plan.held_values = {-1, -0.5, 0, 0.5, 1};
  const auto surveyor = prepare_survey(m, plan, coupling());
  Survey<S> survey;
  for (auto _ : state) {
    surveyor->survey(std::span<const S>(parameters), survey);
    benchmark::DoNotOptimize(weighted_mean(survey.weight, survey.dci[3]));
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
  MotionState<double> at{{0.2, 0.17, 0.22, 0.3}, {{0.3, -0.2, 0.1, 1}}};
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
