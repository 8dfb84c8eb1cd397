// Options common to the stages of all solver libraries.
#include <stdexcept>

#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {

Capabilities solver_capabilities(const Options& options, bool constraints, bool gradient) {
  const bool fronts = options.word("start") == "pareto";
  return {.min_objectives = fronts ? std::size_t{2} : 1,
          .max_objectives = fronts ? kUnlimitedObjectives : 1,
          .too_many_objectives_hint = "set start = \"pareto\" for several",
          .constraints = constraints,
          .discrete = false,
          .needs_gradient = gradient,
          .starts = true,
          .needs_front = fronts};
}

OptionSpec tighten_option() {
  return number_option(
      "tighten", 1e-10, 0, 1e-3,
      "minimum constraint value required from the solver, in the constraint's unit: a reserve for rounding");
}

std::vector<OptionSpec> solver_options() {
  OptionSpec time = number_option("time", {}, 0, 1e9, "maximum wall time per start (default: no limit)");
  time.unit = "s";
  return {
      word_option("start", {"best", "best-of-basins", "pareto", "none"},
                  "start designs: the best so far (otherwise the baseline), the best of distinct basins, points of the "
                  "Pareto front so far (several objectives), or none but `designs` and `multistart`"),
      integer_option("starts", std::int64_t{5}, 1, 1e4, "best-of-basins and pareto: maximum number of starts"),
      word_option("scalarisation", {"achievement", "epsilon-constraint"},
                  "pareto: improve all objectives together, or one without worsening the others"),
      {.name = "objective",
       .kind = OptionKind::word,
       .meaning = "epsilon-constraint: the objective to improve (default: the first)",
       .field_names = FieldNames::objectives},
      number_option("basin_radius", 0.1, 1e-6, 1,
                    "best-of-basins: no better design is within this distance of a start, in units of the ranges"),
      {.name = "designs",
       .kind = OptionKind::list_of_numbers,
       .meaning = "additional start designs, such as [{ a = 0.3, b = 1.0 }]; omitted variables are the baseline's",
       .field_names = FieldNames::variables},
      integer_option("multistart", std::int64_t{0}, 0, 1e6, "number of additional starts from scrambled Sobol points"),
      integer_option("evaluations", std::int64_t{1000}, 1, 1e9, "maximum number of evaluations per start"),
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
        "\" is not used; it needs start = \"pareto\" with scalarisation = \"epsilon-constraint\"");
  if (options.has("designs")) plan.starts += static_cast<std::int64_t>(options.list("designs").size());
  if (plan.starts + plan.multistart == 0)
    throw std::invalid_argument("no start designs; start = \"none\" needs designs or multistart");
  return plan;
}

}  // namespace pkm
