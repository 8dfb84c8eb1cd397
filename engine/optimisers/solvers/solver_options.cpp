// What a study tells a solver stage, whatever the library.
#include <stdexcept>

#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

Capabilities solver_capabilities(const Options& options, bool constraints, bool gradient) {
  const bool fronts = options.word("start") == "pareto";
  return {.min_objectives = fronts ? std::size_t{2} : 1,
          .max_objectives = fronts ? kManyObjectives : 1,
          .objectives_hint = "start = \"pareto\" works on several",
          .constraints = constraints,
          .discrete = false,
          .needs_gradient = gradient,
          .starts = true,
          .needs_front = fronts};
}

OptionSpec tighten_option() {
  return number_option("tighten", 1e-10, 0, 1e-3,
                       "what margins must keep, in their unit, so that a solution's rounding stays feasible");
}

std::vector<OptionSpec> solver_options() {
  OptionSpec time = number_option("time", {}, 0, 1e9, "most wall time of one start (default: no limit)");
  time.unit = "s";
  return {
      word_option("start", {"best", "best-of-basins", "pareto", "none"},
                  "best design so far (else the baseline), best designs of distinct basins, points of the front found "
                  "so far (several objectives), or only those below"),
      integer_option("starts", std::int64_t{5}, 1, 1e4, "best-of-basins and pareto: most starts"),
      word_option("scalarisation", {"achievement", "epsilon-constraint"},
                  "pareto: gain in all objectives alike, or in one while the others keep what they have"),
      {.name = "objective",
       .kind = OptionKind::word,
       .meaning = "epsilon-constraint: the one that is to gain (default: the first)",
       .field_names = FieldNames::objectives},
      number_option("basin_radius", 0.1, 1e-6, 1,
                    "best-of-basins: a start is a design with no better one nearer than this, in units of the ranges"),
      {.name = "designs",
       .kind = OptionKind::list_of_numbers,
       .meaning =
           "designs to start from besides, such as [{ a = 0.3, b = 1.0 }]; variables left out are the baseline's",
       .field_names = FieldNames::variables},
      integer_option("multistart", std::int64_t{0}, 0, 1e6, "starts at scrambled Sobol points besides"),
      integer_option("evaluations", std::int64_t{1000}, 1, 1e9, "most evaluations of one start"),
      time,
  };
}

SolverPlan solver_plan(const Options& options) {
  SolverPlan plan;
  plan.limits.evaluations = options.integer("evaluations");
  if (options.has("time")) plan.limits.seconds = options.number("time");
  plan.multistart = options.integer("multistart");
  const std::string& start = options.word("start");
  plan.starts = start == "best" ? 1 : start == "none" ? 0 : options.integer("starts");
  if (start == "pareto")
    plan.scalarisation.kind = options.word("scalarisation") == "achievement" ? Scalarisation::Kind::achievement
                                                                             : Scalarisation::Kind::epsilon;
  if (options.has("objective")) plan.objective = options.word("objective");
  if (options.has("objective") && plan.scalarisation.kind != Scalarisation::Kind::epsilon)
    throw std::invalid_argument(
        "objective = \"" + plan.objective +
        "\" is for start = \"pareto\" with scalarisation = \"epsilon-constraint\", which this stage does not have");
  if (options.has("designs")) plan.starts += static_cast<std::int64_t>(options.list("designs").size());
  if (plan.starts + plan.multistart == 0)
    throw std::invalid_argument("no start: start = \"none\" needs designs or multistart");
  return plan;
}

}  // namespace pkm
