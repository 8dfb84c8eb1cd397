// Generic engine (mechanism files): reading files, and workspace analyses compared with hand-written loops over the
// same formulas.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/peers/delta_loop.hpp"
#include "benchmarks/peers/voxel_loop.hpp"
#include "benchmarks/timing.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/core/team.hpp"
#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

/// A file of the catalogue, of experiments/mechanisms or of the tests.
std::string read_text(const std::string& name) {
  if (std::ranges::any_of(all_mechanisms(), [&](const MechanismEntry& entry) { return entry.name() == name; }))
    return mechanism_file_text(name);
  std::ostringstream text;
  for (const std::string folder : {"/mechanisms/", "/../tests/data/generic/"})
    if (std::ifstream file(PKM_EXPERIMENTS + folder + name + ".toml"); file && text.str().empty()) text << file.rdbuf();
  return text.str();
}
const Mechanism& mechanism_file(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const Mechanism>> known;
  auto& mechanism = known[name];
  if (!mechanism) mechanism = read_mechanism_toml(read_text(name), name + ".toml");
  return *mechanism;
}
void read(benchmark::State& state, const std::string& name) {
  const std::string text = read_text(name);
  for (auto _ : state) benchmark::DoNotOptimize(read_mechanism_toml(text, name + ".toml"));
}
BENCHMARK_CAPTURE(read, four_ppa, "4ppa-2par")->Name("mechanism_file/read/4ppa-2par")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(read, delta, "rotary-delta")->Name("mechanism_file/read/rotary-delta")->Unit(benchmark::kMicrosecond);

/// Voxel plan of the mechanism file with limit values of the built-in mechanism.
WorkspacePlan plan_of(const Mechanism& mechanism, const LimitSpec& own, const VoxelOptions& voxels) {
  WorkspacePlan plan{.method = voxels, .fixed = {}, .limits = no_limits(mechanism.info())};
  for (std::size_t i = 0; i < plan.limits.given.size(); ++i) {
    const auto& known = four_ppa().info().limits;
    const auto at = std::ranges::find(known, mechanism.info().limits[i].name, &LimitInfo::name);
    plan.limits.given[i] = own.given[static_cast<std::size_t>(at - known.begin())];
  }
  return plan;
}

/// Times the workspace analysis and a hand-written loop alternately.
/// @param loop  returns the number of feasible voxels of the same grid
template <class Loop>
void compare_with_loop(benchmark::State& state, const Mechanism& mechanism, const WorkspacePlan& plan,
                       const Loop& loop) {
  const SerialScope alone;
  const auto evaluator = prepare_workspace(mechanism, plan, {});
  const std::vector<double> design = nominal(mechanism);
  std::int64_t cells = 0;
  Scratch scratch;
  WorkspaceResult<double> result;
  const PairedTimes times = time_alternately(
      state, "loop_s", [&] { benchmark::DoNotOptimize(cells = loop()); }, "analysis_s",
      [&] { evaluator->evaluate(design, scratch, result); });
  state.counters["share"] = times.second / times.first;  // of the time of the loop
  state.counters["cells_found"] = static_cast<double>(result.feasible_cells);
  if (cells != result.feasible_cells) state.SkipWithError("the loop and the workspace analysis count different voxels");
}

void four_ppa_2par(benchmark::State& state, bool limited) {
  const LimitSpec own = limited ? with_limits() : without_limits();
  const Mechanism& mechanism = mechanism_file("4ppa-2par");
  const auto limit = [&](const std::string& name, double inactive) {
    const auto& known = four_ppa().info().limits;
    const auto at = std::ranges::find(known, name, &LimitInfo::name);
    return own.given[static_cast<std::size_t>(at - known.begin())].value_or(inactive);
  };
  const auto design = original_design();
  const auto g = four_ppa_two_par::geometry(std::span<const double>(design));
  const peers::Voxels voxels{g.d,
                             g.L0,
                             {32, 34, 60},
                             limit("alpha_min", 0),
                             limit("beta_min", 0),
                             limit("beta_max", kPi / 2),
                             limit("h_min", 0),
                             limit("sin_par_min", 0),
                             limit("cos_theta_min", 0)};
  const peers::Design lengths{g.a, g.b, g.l_u, g.l_d};
  compare_with_loop(state, mechanism, plan_of(mechanism, own, kPaperGrid),
                    [&] { return peers::feasible_cells(voxels, lengths); });
}
BENCHMARK_CAPTURE(four_ppa_2par, free, false)
    ->Name("mechanism_file/compared_with_loop/4ppa-2par")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(four_ppa_2par, limited, true)
    ->Name("mechanism_file/compared_with_loop/4ppa-2par_with_limits")
    ->Unit(benchmark::kMicrosecond);

void rotary_delta(benchmark::State& state) {
  const Mechanism& mechanism = mechanism_file("rotary-delta");
  const std::vector<double> p = nominal(mechanism);
  const peers::Delta delta{p[0], p[1], p[2], p[3], p[4], p[5]};
  const WorkspacePlan plan{
      .method = VoxelOptions{.cells = {64, 64, 64}}, .fixed = {}, .limits = no_limits(mechanism.info())};
  compare_with_loop(state, mechanism, plan, [&] { return peers::feasible_cells(delta, 64); });
}
BENCHMARK(rotary_delta)->Name("mechanism_file/compared_with_loop/rotary-delta_64_cubed")->Unit(benchmark::kMicrosecond);

// Grids of n^3 voxels: the cost is proportional to the n^2 columns if the constraints are quadratic along one
// coordinate.
void grid(benchmark::State& state, const std::string& name) {
  const SerialScope alone;
  const Mechanism& mechanism = mechanism_file(name);
  const std::int64_t n = state.range(0);
  const WorkspacePlan plan{
      .method = VoxelOptions{.cells = {n, n, n}}, .fixed = {}, .limits = no_limits(mechanism.info())};
  const auto evaluator = prepare_workspace(mechanism, plan, {});
  const std::vector<double> design = nominal(mechanism);
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(design, scratch, result);
    benchmark::DoNotOptimize(result.feasible_cells);
  }
  const auto columns = static_cast<double>(n * n);
  state.counters["columns"] = benchmark::Counter(columns, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(grid, four_ppa, "4ppa-2par")
    ->Name("mechanism_file/grid/4ppa-2par")
    ->RangeMultiplier(2)
    ->Range(32, 256)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(grid, delta, "rotary-delta")
    ->Name("mechanism_file/grid/rotary-delta")
    ->RangeMultiplier(2)
    ->Range(32, 256)
    ->Unit(benchmark::kMicrosecond);

/// A mechanism file, or the built-in mechanism for "built-in NAME".
const Mechanism& find_mechanism(const std::string& name) {
  const std::string built_in = "built-in ";
  if (!name.starts_with(built_in)) return mechanism_file(name);
  return **std::ranges::find_if(all_mechanisms(),
                                [&](const auto& m) { return m.name() == name.substr(built_in.size()); });
}
WorkspacePlan plan_of_60_cubed(const Mechanism& mechanism) {
  WorkspacePlan plan{.method = VoxelOptions{.cells = {60, 60, 60}}, .fixed = {}, .limits = no_limits(mechanism.info())};
  for (std::size_t i = 0; i < mechanism.info().limits.size(); ++i)
    if (mechanism.info().limits[i].name == "s_min") plan.limits.given[i] = 0.2;
  return plan;
}

// The component of the home pose on 40^3 voxels, relative to the analysis of all components with the same samples: the
// count alone (the flood fill evaluates more poses than the count, whose columns are bounded in closed form), or the
// conditioning of every feasible voxel.
void home_component(benchmark::State& state, const std::string& name, const std::array<double, 3>& home,
                    bool conditioning) {
  const SerialScope alone;
  const Mechanism& mechanism = find_mechanism(name);
  WorkspacePlan plan{.method = VoxelOptions{.cells = {40, 40, 40}}, .fixed = {}, .limits = no_limits(mechanism.info())};
  FieldRequest request;
  if (conditioning) request.add(kConditioning);
  const auto all = prepare_workspace(mechanism, plan, request);
  plan.home = home;
  const auto component = prepare_workspace(mechanism, plan, request);
  const std::vector<double> design = nominal(mechanism);
  Scratch scratch;
  WorkspaceResult<double> result;
  const PairedTimes times = time_alternately(
      state, "all_s", [&] { all->evaluate(design, scratch, result); }, "component_s",
      [&] { component->evaluate(design, scratch, result); });
  state.counters["flood_fill_in_surveys"] = times.second / times.first - 1;
}
BENCHMARK_CAPTURE(home_component, delta, "rotary-delta", {0, 0, -0.5}, false)
    ->Name("mechanism_file/home_component/rotary-delta_count");
BENCHMARK_CAPTURE(home_component, delta_conditioning, "rotary-delta", {0, 0, -0.5}, true)
    ->Name("mechanism_file/home_component/rotary-delta_conditioning");
BENCHMARK_CAPTURE(home_component, rpr, "3-rpr", {0.5, 0.3, 0}, false)
    ->Name("mechanism_file/home_component/3-rpr_count");
BENCHMARK_CAPTURE(home_component, rpr_conditioning, "3-rpr", {0.5, 0.3, 0}, true)
    ->Name("mechanism_file/home_component/3-rpr_conditioning");

// Joint-space inertia matrix and coupling indices of every feasible voxel of 60^3; `per_pose` is the time per voxel.
void coupling(benchmark::State& state, const std::string& name) {
  const SerialScope alone;
  const Mechanism& mechanism = find_mechanism(name);
  const auto evaluator = prepare_workspace(mechanism, plan_of_60_cubed(mechanism), {.fields = {&kCouplingIndex}});
  const std::vector<double> design = nominal(mechanism);
  Scratch scratch;
  WorkspaceResult<double> result;
  for (auto _ : state) {
    evaluator->evaluate(design, scratch, result);
    benchmark::DoNotOptimize(result.weight.data());
  }
  state.counters["per_pose"] =
      benchmark::Counter(static_cast<double>(result.feasible_cells),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(coupling, built_in, "built-in 3crr-r-cru")->Name("mechanism_file/coupling/built-in_3crr-r-cru");
BENCHMARK_CAPTURE(coupling, crr, "3crr-r-cru")->Name("mechanism_file/coupling/3crr-r-cru");
BENCHMARK_CAPTURE(coupling, delta, "rotary-delta")->Name("mechanism_file/coupling/rotary-delta");

// Exact volumes of (3CRR/R)&CRU by closed forms and by the generic engine, which evaluates the mechanism file, with one
// coordinate fixed, without and with values of the conditioning.
void closed_forms(benchmark::State& state, bool conditioning) {
  const SerialScope alone;
  const Mechanism &built_in = find_mechanism("built-in 3crr-r-cru"), &file = mechanism_file("3crr-r-cru");
  const WorkspacePlan plan{.method = ColumnOptions{},
                           .fixed = {fixed_at(static_cast<int>(state.range(0)), state.range(0) == 3 ? 0.3 : 0.1)},
                           .limits = no_limits(file.info())};
  FieldRequest request;
  if (conditioning) request.add(kConditioning);
  const auto by_closed_forms = prepare_workspace(built_in, plan, request),
             by_file = prepare_workspace(file, plan, request);
  const std::vector<double> design = nominal(file);
  Scratch scratch, scratch_of_file;
  WorkspaceResult<double> result, of_file;
  const PairedTimes times = time_alternately(
      state, "closed_forms_s", [&] { by_closed_forms->evaluate(design, scratch, result); }, "file_s",
      [&] { by_file->evaluate(design, scratch_of_file, of_file); });
  if (!(std::fabs(result.volume / of_file.volume - 1) < 1e-7)) state.SkipWithError("different volumes");
  state.counters["of_file"] = times.ratio();
}
BENCHMARK_CAPTURE(closed_forms, volume, false)->Name("crr_cru/columns_of_file/fixed")->DenseRange(0, 3);
BENCHMARK_CAPTURE(closed_forms, conditioning, true)->Name("crr_cru/conditioning_of_file/fixed")->DenseRange(0, 3);

// Drive forces of states along a motion; `per_pose` is the time per state.
void inverse_dynamics(benchmark::State& state, const std::string& name) {
  const Mechanism& mechanism = find_mechanism(name);
  const std::vector<double> design = nominal(mechanism);
  WorkspaceResult<double> found;
  evaluate_once<double>(
      *prepare_workspace(mechanism, plan_of_60_cubed(mechanism), {.fields = {&kCouplingIndex}, .poses = true}), design,
      found);
  std::vector<MotionSample> samples(1024);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].pose = found.pose[k * 7919 % found.pose.size()];
    samples[k].velocity = samples[k].pose * 0.5;
    samples[k].acceleration = samples[k].pose * 3.0;
  }
  InverseDynamicsScratch<double> scratch;
  for (auto _ : state) {
    double sum = 0;
    inverse_dynamics_along<double>(*mechanism.dynamics(), design, mechanism.info().modes.front(), samples, {}, scratch,
                                   [&](std::size_t, const ActuatorState<double>& drive) { sum += drive.forces[0]; });
    benchmark::DoNotOptimize(sum);
  }
  state.counters["per_pose"] = benchmark::Counter(
      static_cast<double>(samples.size()), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(inverse_dynamics, crr, "3crr-r-cru")->Name("mechanism_file/inverse_dynamics/3crr-r-cru");
BENCHMARK_CAPTURE(inverse_dynamics, delta, "rotary-delta")->Name("mechanism_file/inverse_dynamics/rotary-delta");

// Exact volumes of mechanism files to 1e-8 and to 1e-3, relative to the loop that counts the paper's voxels (two
// correct digits), and their gradients by all parameters (forward-mode automatic differentiation in blocks of 4),
// relative to the value.
void columns(benchmark::State& state, const std::string& name, bool limited,
             const std::vector<FixedCoordinate>& fixed = {}) {
  const SerialScope alone;
  const Mechanism& mechanism = mechanism_file(name);
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = fixed, .limits = no_limits(mechanism.info())};
  if (limited) plan.limits = plan_of(mechanism, with_limits(), kPaperGrid).limits;
  const auto evaluator = prepare_workspace(mechanism, plan, {});
  plan.method = ColumnOptions{.tolerance = 1e-3};
  const auto coarse = prepare_workspace(mechanism, plan, {});
  const std::vector<double> design = nominal(mechanism);
  Scratch scratch, coarse_scratch;
  WorkspaceResult<double> result, coarse_result;
  WorkspaceResult<Dual4> with_gradient;
  std::vector<Dual4> duals(design.begin(), design.end());
  const auto original = original_design();
  const auto g = four_ppa_two_par::geometry(std::span<const double>(original));
  const peers::Voxels voxels{g.d, g.L0, {32, 34, 60}, 0, 0, kPi / 2, 0, 0, 0};
  const peers::Design lengths{g.a, g.b, g.l_u, g.l_d};
  double loop_s = 0, value_s = 0, coarse_s = 0, gradient_s = 0;
  for (auto _ : state) {
    loop_s += seconds_of([&] { benchmark::DoNotOptimize(peers::feasible_cells(voxels, lengths)); });
    value_s += seconds_of([&] { evaluator->evaluate(design, scratch, result); });
    coarse_s += seconds_of([&] { coarse->evaluate(design, coarse_scratch, coarse_result); });
    // The analysis without derivatives has dropped the derivatives of the design that it caches.
    gradient_s += seconds_of([&] {
      for (std::size_t first = 0; first < duals.size(); first += 4) {
        for (std::size_t i = 0; i < duals.size(); ++i) duals[i] = Dual4(design[i]);
        for (std::size_t i = first; i < std::min(first + 4, duals.size()); ++i)
          duals[i] = Dual4::variable(design[i], static_cast<int>(i - first));
        evaluator->gradients()->evaluate(duals, scratch, with_gradient);
      }
    });
  }
  state.counters["analysis_s"] = value_s / static_cast<double>(state.iterations());
  state.counters["loops"] = value_s / loop_s;  // time of the analysis, in multiples of the loop's
  state.counters["loops_1e-3"] = coarse_s / loop_s;
  state.counters["gradient"] = gradient_s / value_s;
  state.counters["slices"] = static_cast<double>(result.columns);
  state.counters["error"] = result.error;
}
BENCHMARK_CAPTURE(columns, planar, "3-rrr", false)->Name("mechanism_file/columns/3-rrr")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, telescopes, "3-rpr", false)
    ->Name("mechanism_file/columns/3-rpr")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, upright_telescopes, "3-rpr", false, std::vector{FixedCoordinate{2}})
    ->Name("mechanism_file/columns/3-rpr_at_phi_0")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, cylinders, "three-cylinders", false)
    ->Name("mechanism_file/columns/three-cylinders")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, slides, "orthoglide", false)
    ->Name("mechanism_file/columns/orthoglide")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, upright, "linear-delta", false)
    ->Name("mechanism_file/columns/linear-delta")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, gough, "gough", false)->Name("mechanism_file/columns/gough")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, cranks, "rotary-delta", false)
    ->Name("mechanism_file/columns/rotary-delta")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, jointed, "par4", false)->Name("mechanism_file/columns/par4")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, over_four, "par4", false, std::vector{FixedCoordinate{3, FixedCoordinate::Kind::integrated}})
    ->Name("mechanism_file/columns/par4_over_four_coordinates")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, crr, "3crr-r-cru", false)
    ->Name("mechanism_file/columns/3crr-r-cru")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, hybrid, "2t1r-p-hybrid", false)
    ->Name("mechanism_file/columns/2t1r-p-hybrid")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, free, "4ppa-2par", false)
    ->Name("mechanism_file/columns/4ppa-2par")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(columns, limited, "4ppa-2par", true)
    ->Name("mechanism_file/columns/4ppa-2par_with_limits")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
