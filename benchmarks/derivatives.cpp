// Cost of derivatives: a design evaluated with derivatives, compared with the same design without.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/core/catalogue.hpp"
#include "objectives/all.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

/// A problem with one objective of 4PPa-2PaR, by exact volumes with limits.
/// @param variable_indices  indices of the parameters that are variables
DesignProblem problem_of(const std::string& objective, const std::vector<std::size_t>& variable_indices) {
  const ObjectiveEntry& entry = *find_named(all_objectives(), objective);
  ProblemParts parts;
  parts.mechanism = wide_study().problem->parts().mechanism;
  parts.parameters = original_design();
  parts.plan = column_plan(with_limits());
  parts.varies = variable_indices;
  std::vector<Variable> variables;
  for (const std::size_t i : variable_indices) {
    const Parameter& p = four_ppa().info().parameters[i];
    variables.push_back({p.name, p.unit, p.lower, p.upper});
  }
  parts.space = DesignSpace(variables);
  const Options options = default_options(entry.options);
  const EntryContext context{*parts.mechanism, parts.plan, options};
  entry.request(context, parts.request);
  parts.objectives.push_back({entry.name, entry.unit(context), entry.meaning, entry.direction, entry.make(context)});
  return DesignProblem(parts);
}

void evaluations(benchmark::State& state, const std::string& objective,
                 const std::vector<std::size_t>& variable_indices, std::size_t designs) {
  const DesignProblem problem = problem_of(objective, variable_indices);
  EvaluationTable without_derivatives(problem.shape(Detail::complete)),
      with_derivatives(problem.shape(Detail::derivatives));
  const auto inputs = designs_with_active_limits(designs);
  for (EvaluationTable* table : {&without_derivatives, &with_derivatives}) {
    table->extend(designs);
    for (std::size_t row = 0; row < designs; ++row)
      for (std::size_t i = 0; i < variable_indices.size(); ++i)
        table->design(row)[i] = inputs[row][variable_indices[i]];
  }
  Scratch scratch;
  const auto evaluate = [&](EvaluationTable& table) {
    for (std::size_t row = 0; row < table.size(); ++row)
      problem.evaluate(static_cast<const EvaluationTable&>(table).design(row), scratch, table.slot(row));
  };
  const PairedTimes times = time_alternately(
      state, "with_derivatives_s", [&] { evaluate(with_derivatives); }, "without_s",
      [&] { evaluate(without_derivatives); });
  for (const char* name : {"with_derivatives_s", "without_s"})
    state.counters[name] = state.counters[name] / static_cast<double>(designs);
  state.counters["ratio"] = times.ratio();
  if (without_derivatives.objectives != with_derivatives.objectives)
    state.SkipWithError("values with and without derivatives differ");
}

const std::vector<std::size_t> kFour = {kA, kB, kLu, kLd}, kSix = {kA, kB, kLu, kLd, kD, kL0};

BENCHMARK_CAPTURE(evaluations, ratio, "workspace-ratio", kFour, 200)
    ->Name("derivatives/workspace_ratio/4_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, ratio, "workspace-ratio", kSix, 200)
    ->Name("derivatives/workspace_ratio/6_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, conditioning, "conditioning", kFour, 10)
    ->Name("derivatives/mean_conditioning/4_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, conditioning, "conditioning", kSix, 10)
    ->Name("derivatives/mean_conditioning/6_variables")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
