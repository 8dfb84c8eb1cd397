// Quantities of the poses: voxel analyses with limits of them, and the time per pose of each quantity.
#include <fstream>
#include <sstream>

#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/team.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "objectives/all.hpp"

namespace pkm::benchmarks {
namespace {

/// Studies of mechanism files with errors of the joints, and stiffness and peak force of the drives.
Study study_of(const std::string& mechanism, const std::string& parameter, const std::string& joint_error,
               const std::string& limits) {
  std::ostringstream text;
  text << std::ifstream(PKM_EXPERIMENTS "/mechanisms/" + mechanism + ".toml").rdbuf();
  const std::string study = "[mechanism]\nfile = \"" + mechanism + ".toml\"\n[variables]\n" + parameter +
                            "[workspace]\nmethod = \"voxels\"\nexact = false\ncells = { x = 40, y = 40, z = 40 }\n" +
                            limits + "[accuracy]\njoint_error = \"" + joint_error +
                            "\"\n[[drive_train]]\njoint = \"all\"\nstiffness = 1e6\npeak_force = 1000\n"
                            "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n";
  return read_study_toml(study, "study.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()},
                         SourceText{text.str(), mechanism + ".toml"});
}
Study rotary_delta(const std::string& limits) {
  return study_of("rotary-delta", "l_b = { min = 0.4, max = 0.6 }\n", "0.01 deg", limits);
}
Study gough() { return study_of("gough", "R = { min = 0.8, max = 1.2 }\n", "10 um", ""); }

/// Times voxel analyses of the rotary Delta with two sets of limits alternately; `ratio` compares them.
void compare_limits(benchmark::State& state, const std::string& more, const std::string& less) {
  const SerialScope alone;
  const Study with_more = rotary_delta(more), with_less = rotary_delta(less);
  const auto evaluator_of = [](const Study& study) {
    const auto& parts = study.problem->parts();
    return prepare_workspace(*parts.mechanism, parts.plan, {});
  };
  const auto by_more = evaluator_of(with_more), by_less = evaluator_of(with_less);
  const std::vector<double> design = nominal(*with_more.problem->parts().mechanism);
  WorkspaceResult<double> of_more, of_less;
  Scratch scratch_of_more, scratch_of_less;
  const PairedTimes times = time_alternately(
      state, "with_more_s", [&] { by_more->evaluate(design, scratch_of_more, of_more); }, "with_less_s",
      [&] { by_less->evaluate(design, scratch_of_less, of_less); });
  state.counters["ratio"] = times.ratio();
  state.counters["cells_of_more"] = static_cast<double>(of_more.feasible_cells);
  state.counters["cells_of_less"] = static_cast<double>(of_less.feasible_cells);
}
const std::string kFormulas = "lti = { min = 0.5 }, accuracy = { max = \"0.2 mm\" }, stiffness = { min = \"10 N/um\" }";
void four_limits(benchmark::State& state) {
  compare_limits(state, "limits = { conditioning = { min = 0.3 }, " + kFormulas + " }\n",
                 "limits = { conditioning = { min = 0.3 } }\n");
}
void three_limits(benchmark::State& state) { compare_limits(state, "limits = { " + kFormulas + " }\n", ""); }
BENCHMARK(four_limits)->Name("quantities/limits/with_conditioning_40_cubed")->Unit(benchmark::kMicrosecond);
BENCHMARK(three_limits)->Name("quantities/limits/formulas_40_cubed")->Unit(benchmark::kMicrosecond);

// The time that a quantity adds to a voxel analysis, per feasible pose; `of_poses` is that of the analysis without it.
void time_of_quantity(benchmark::State& state, Study (*study_of_mechanism)(), const std::string& name) {
  const SerialScope alone;
  const Study study = study_of_mechanism();
  const auto& parts = study.problem->parts();
  FieldRequest request;
  request.add(pose_quantity_called(parts.mechanism->info(), name));
  const auto without = prepare_workspace(*parts.mechanism, parts.plan, {}),
             with = prepare_workspace(*parts.mechanism, parts.plan, request);
  const std::vector<double> design = nominal(*parts.mechanism);
  Scratch scratch_without, scratch_with;
  WorkspaceResult<double> result_without, result_with;
  const PairedTimes times = time_alternately(
      state, "with_s", [&] { with->evaluate(design, scratch_with, result_with); }, "without_s",
      [&] { without->evaluate(design, scratch_without, result_without); });
  const double evaluations = static_cast<double>(state.iterations()) * static_cast<double>(result_with.feasible_cells);
  state.counters["per_pose_us"] = 1e6 * (times.first - times.second) / evaluations;
}
Study delta() { return rotary_delta(""); }

const int kQuantitiesRegistered = [] {
  for (const bool of_gough : {false, true})
    for (const char* const name :
         {"conditioning", "lti", "velocity_transmission", "force_transmission", "accuracy", "accuracy_rms", "stiffness",
          "natural_frequency", "effective_mass", "effective_mass_ratio", "acceleration"}) {
      const auto run = [of_gough, name](benchmark::State& state) {
        time_of_quantity(state, of_gough ? gough : delta, name);
      };
      const std::string mechanism = of_gough ? "gough" : "rotary-delta";
      benchmark::RegisterBenchmark(("quantities/" + mechanism + "/" + name).c_str(), run)
          ->Unit(benchmark::kMicrosecond);
    }
  return 0;
}();

}  // namespace
}  // namespace pkm::benchmarks
