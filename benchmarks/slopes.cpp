// What slopes cost an optimiser: a design evaluated with its derivatives against the same design without.
#include <benchmark/benchmark.h>

#include "benchmarks/inputs.hpp"
#include "benchmarks/timing.hpp"
#include "engine/core/catalogue.hpp"
#include "objectives/all.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

/// One objective of 4PPa-2PaR by its first `variables` parameters, surveyed on columns with limits.
DesignProblem problem_of(const std::string& objective, const std::vector<std::size_t>& varies) {
  const ObjectiveEntry& entry = *find_named(all_objectives(), objective);
  ProblemParts parts;
  parts.mechanism = wide_study().problem->parts().mechanism;
  parts.parameters = original_design();
  parts.plan = column_plan(with_limits());
  parts.varies = varies;
  std::vector<Variable> variables;
  for (const std::size_t i : varies) {
    const Parameter& p = four_ppa().info().parameters[i];
    variables.push_back({p.name, p.unit, p.lower, p.upper});
  }
  parts.space = DesignSpace(variables);
  const Options options = default_options(entry.options);
  const EntryContext context{*parts.mechanism, parts.plan, options};
  entry.demand(context, parts.demand);
  parts.objectives.push_back({entry.name, entry.unit(context), entry.meaning, entry.direction, entry.make(context)});
  return DesignProblem(parts);
}

void evaluations(benchmark::State& state, const std::string& objective, const std::vector<std::size_t>& varies,
                 std::size_t designs) {
  const DesignProblem problem = problem_of(objective, varies);
  EvaluationTable plain(problem.shape(Detail::complete)), sloped(problem.shape(Detail::derivatives));
  const auto inputs = designs_with_active_limits(designs);
  for (EvaluationTable* table : {&plain, &sloped}) {
    table->extend(designs);
    for (std::size_t row = 0; row < designs; ++row)
      for (std::size_t i = 0; i < varies.size(); ++i) table->design(row)[i] = inputs[row][varies[i]];
  }
  Scratch scratch;
  const auto evaluate = [&](EvaluationTable& table) {
    for (std::size_t row = 0; row < table.size(); ++row)
      problem.evaluate(static_cast<const EvaluationTable&>(table).design(row), scratch, table.slot(row));
  };
  const Duel duel = take_turns(
      state, "with_slopes_s", [&] { evaluate(sloped); }, "without_s", [&] { evaluate(plain); });
  for (const char* name : {"with_slopes_s", "without_s"})
    state.counters[name] = state.counters[name] / static_cast<double>(designs);
  state.counters["ratio"] = duel.ratio();
  if (plain.objectives != sloped.objectives) state.SkipWithError("values with slopes differ from those without");
}

const std::vector<std::size_t> kFour = {kA, kB, kLu, kLd}, kSix = {kA, kB, kLu, kLd, kD, kL0};

BENCHMARK_CAPTURE(evaluations, ratio, "workspace-ratio", kFour, 200)
    ->Name("slopes/workspace_ratio/4_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, ratio, "workspace-ratio", kSix, 200)
    ->Name("slopes/workspace_ratio/6_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, conditioning, "conditioning", kFour, 10)
    ->Name("slopes/mean_conditioning/4_variables")
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(evaluations, conditioning, "conditioning", kSix, 10)
    ->Name("slopes/mean_conditioning/6_variables")
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pkm::benchmarks
