// The largest box and cylinder in the workspace of a design, in units of a voxel analysis of 40 x 40 x 40 cells of the
// same design (counter "surveys").
#include <fstream>
#include <sstream>

#include <benchmark/benchmark.h>

#include "benchmarks/timing.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/workspace/largest_solid.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm::benchmarks {
namespace {

void find_largest(benchmark::State& state, const std::string& name, SolidKind kind) {
  std::ostringstream text;
  text << std::ifstream(PKM_EXPERIMENTS "/mechanisms/" + name + ".toml").rdbuf();
  const auto mechanism = read_mechanism_toml(text.str(), name + ".toml");
  const MechanismInfo& info = mechanism->info();
  std::vector<double> design;
  for (const Parameter& parameter : info.parameters) design.push_back(parameter.nominal);
  const WorkspacePlan plan{.method = VoxelOptions{.cells = {40, 40, 40}}, .limits = no_limits(info)};
  const LargestSolidFinder finder(*mechanism, plan, {SolidShape(kind, 3), {}}, true);
  const auto voxels = prepare_voxel_map(*mechanism, plan);
  const auto [solid, survey] = time_alternately(
      state, "solid", [&] { benchmark::DoNotOptimize(finder.find(design)); }, "survey",
      [&] { benchmark::DoNotOptimize(voxels->map(design)); });
  state.counters["surveys"] = solid / survey;
}

BENCHMARK_CAPTURE(find_largest, box_of_rotary_delta, "rotary-delta", SolidKind::box)
    ->Name("largest_solid/box/rotary-delta")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find_largest, box_of_linear_delta, "linear-delta", SolidKind::box)
    ->Name("largest_solid/box/linear-delta")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find_largest, box_of_orthoglide, "orthoglide", SolidKind::box)
    ->Name("largest_solid/box/orthoglide")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(find_largest, cylinder_of_rotary_delta, "rotary-delta", SolidKind::cylinder)
    ->Name("largest_solid/cylinder/rotary-delta")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pkm::benchmarks
