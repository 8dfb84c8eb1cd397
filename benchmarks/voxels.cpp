// Poses and voxels: the test of one pose, the loop that a designer would write, and the survey in use.
#include <cmath>

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/math/random.hpp"
#include "engine/mechanisms/four_ppa_two_par_voxels.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;
using Design = std::vector<double> (*)();

// The first thing one would write: three loops over the paper's grid and the inverse kinematics (eq 13) of each cell's
// centre. What does not depend on z stays out of the inner loop; no limits.
std::int64_t count_plainly(const Geometry<double>& g) {
  constexpr int kX = 32, kZ = 34, kTheta = 60;
  const double y = g.L0 / 2;
  std::int64_t feasible_cells = 0;
  for (int k = 0; k < kTheta; ++k) {
    const double theta = -kPi / 2 + (k + 0.5) * kPi / kTheta;
    const double half = g.a / 2 * std::cos(theta), shift = g.a / 2 * std::sin(theta);
    for (int i = 0; i < kX; ++i) {
      const double x = (i + 0.5) * g.b / kX, x_1 = x - half, x_2 = g.b - x - half;
      if (x_1 < 0 || x_1 > g.l_d || x_2 < 0 || x_2 > g.l_d) continue;
      const double sigma_1 = std::sqrt(g.l_d * g.l_d - x_1 * x_1), sigma_2 = std::sqrt(g.l_d * g.l_d - x_2 * x_2);
      for (int j = 0; j < kZ; ++j) {
        const double z = -(g.l_u + g.l_d + g.d) + (j + 0.5) * (g.l_u + g.l_d) / kZ;
        const double z_1 = z + g.d + sigma_1, z_2 = z + g.d + sigma_2;
        if (z_1 > 0 || z_1 < -g.l_u || z_2 > 0 || z_2 < -g.l_u) continue;
        const double h_1 = std::sqrt(g.l_u * g.l_u - z_1 * z_1), h_2 = std::sqrt(g.l_u * g.l_u - z_2 * z_2);
        const double q_1 = y - shift - h_1, q_2 = y - shift + h_1, q_3 = y + shift - h_2, q_4 = y + shift + h_2;
        if (q_1 >= 0 && q_2 <= g.L0 && q_3 >= 0 && q_4 <= g.L0) ++feasible_cells;
      }
    }
  }
  return feasible_cells;
}

void pose_test(benchmark::State& state) {
  const auto all = original_design();
  const auto g = geometry(std::span<const double>(all));
  const auto l = limits(g, with_limits());
  const Box box = default_box(g);
  struct Sample {
    double x, z, sin, cos;
  };
  std::vector<Sample> samples(4096);
  Stream stream(1, 0, 0, Stream::Use::start);
  const auto within = [&](std::size_t axis) { return box[axis][0] + (box[axis][1] - box[axis][0]) * stream.u01(); };
  for (Sample& sample : samples) {
    sample.x = within(0);
    sample.z = within(1);
    const auto [s, c] = sincos(within(2));
    sample.sin = s;
    sample.cos = c;
  }
  for (auto _ : state) {
    std::int64_t count = 0;
    for (const Sample& p : samples) count += feasible(g, l, p.x, g.L0 / 2, p.z, p.sin, p.cos);
    benchmark::DoNotOptimize(count);
  }
  const auto poses = static_cast<double>(samples.size());
  state.counters["poses"] = benchmark::Counter(poses, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(pose_test)->Unit(benchmark::kMicrosecond);

void survey(benchmark::State& state, Design design, LimitSpec (*limits_of)()) {
  const auto all = design();
  const auto surveyor = four_ppa().prepare(voxel_plan(limits_of()), {});
  Survey<double> result;
  for (auto _ : state) {
    surveyor->survey(all, result);
    benchmark::DoNotOptimize(result.feasible_cells);
  }
  state.counters["designs"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["cells_found"] = static_cast<double>(result.feasible_cells);
}
BENCHMARK_CAPTURE(survey, original, original_design, without_limits)
    ->Name("voxel_survey/original")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(survey, optimal, optimal_design, without_limits)
    ->Name("voxel_survey/optimal")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(survey, limits, original_design, with_limits)
    ->Name("voxel_survey/original_with_limits")
    ->Unit(benchmark::kMicrosecond);

void plain_loop_against_survey(benchmark::State& state, Design design) {
  const auto all = design();
  const auto g = geometry(std::span<const double>(all));
  const auto surveyor = four_ppa().prepare(voxel_plan(without_limits()), {});
  std::int64_t plain = 0;
  Survey<double> result;
  const Duel duel = take_turns(
      state, "plain_loop_s", [&] { benchmark::DoNotOptimize(plain = count_plainly(g)); }, "survey_s",
      [&] { surveyor->survey(all, result); });
  state.counters["speedup"] = duel.ratio();
  if (plain != result.feasible_cells) state.SkipWithError("the plain loop and the survey count different cells");
}
BENCHMARK_CAPTURE(plain_loop_against_survey, original, original_design)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(plain_loop_against_survey, optimal, optimal_design)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
