// The genetic algorithm for one objective with constraints.
//
// Each generation: parents are selected by rank, children are bred (breeding.hpp), the new ones are evaluated as one
// batch, and the survivors form the next population: either the best of parents and children together (`best`), or
// the children and the `elite` best parents (`generational`). Designs are ranked by the feasibility rules (order.hpp).
// Nothing depends on the number of generations, so a finished run can be extended.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/evolutionary/evolution.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/problem/order.hpp"

namespace pkm {
namespace {

struct Plan {
  EvolutionPlan evolution;
  std::size_t parents = 0;  ///< best ones that compete with the children
  std::optional<double> target;
};

/// The best by feasibility and the one objective.
class Best final : public Survivors {
 public:
  Best(const Plan& plan, const Problem& problem, const EvaluationTable& table)
      : plan_(plan), problem_(problem), table_(table) {}

  bool take(const std::vector<std::int64_t>& newcomers) override {
    population_.resize(std::min(population_.size(), plan_.parents));
    const auto parents = static_cast<std::ptrdiff_t>(population_.size());
    for (const std::int64_t row : newcomers)
      population_.push_back(ranked(problem_.objectives(), table_, static_cast<std::size_t>(row)));
    sort_with_team(population_, static_cast<std::size_t>(parents));
    const auto children = population_.begin() + parents;
    if (children != population_.end() && (best_.row < 0 || *children < best_)) best_ = *children;
    std::inplace_merge(population_.begin(), children, population_.end());
    population_.resize(std::min(population_.size(), plan_.evolution.breeding.population));
    rows_.clear();
    for (const Ranked& member : population_) rows_.push_back(member.row);
    if (!advanced()) return false;
    reference_ = best_;
    return true;
  }

  const std::vector<std::int64_t>& population() const override { return rows_; }
  std::int64_t best_row() const override { return best_.row; }

  bool satisfied() const override {
    if (!plan_.target || best_.status != Status::feasible) return false;
    const bool maximise = problem_.objectives()[0].direction == Direction::maximise;
    return best_.value <= (maximise ? -*plan_.target : *plan_.target);
  }

 private:
  bool advanced() const {
    return reference_.row < 0 || best_.status != reference_.status ||
           plan_.evolution.progress(reference_.value - best_.value, reference_.value);
  }

  const Plan& plan_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::vector<Ranked> population_;  // best first
  std::vector<std::int64_t> rows_;  // of the population, best first
  Ranked best_;                     // of all generations
  Ranked reference_;                // best at the last improvement that counted
};

std::unique_ptr<Optimiser> make(const Options& options, const DesignSpace& space) {
  Plan plan;
  plan.evolution = evolution_plan(options, space);
  const std::size_t population = plan.evolution.breeding.population;
  const auto elite = static_cast<std::size_t>(options.integer("elite"));
  if (elite >= population)
    throw std::invalid_argument("elite = " + std::to_string(elite) +
                                " must be less than population = " + std::to_string(population) + ".");
  const bool generational = options.word("replacement") == "generational";
  plan.parents = generational ? elite : population;
  plan.evolution.children = generational ? population - elite : population;
  if (options.has("target")) plan.target = options.number("target");
  return make_evolution(plan.evolution, [plan](const Problem& problem, const EvaluationTable& table) {
    return std::make_unique<Best>(plan, problem, table);
  });
}

std::vector<OptionSpec> options() {
  std::vector<OptionSpec> specs = evolution_options("the best");
  specs.insert(specs.end() - 2,
               {word_option("replacement", {"best", "generational"},
                            "survivors: the best of parents and children, or the children and the elite"),
                integer_option("elite", std::int64_t{1}, 0, 1e6, "generational: best parents that survive")});
  specs.push_back(number_option("target", {}, -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity(),
                                "stop when a feasible design reaches this objective, in its unit (default: never)"));
  specs.back().unit = kUnitOfEntry;
  return specs;
}

}  // namespace

OptimiserEntry genetic_algorithm() {
  return {.name = "ga",
          .meaning = "genetic algorithm for one objective with constraints",
          .capabilities = [](const Options&) { return Capabilities{.objectives_hint = "nsga2 works on several"}; },
          .options = options(),
          .make = make,
          .resolve = resolve_breeding};
}

}  // namespace pkm
