// Genetic algorithm for one objective with constraints, which are handled by the feasibility rules (Deb 2000,
// ranking.hpp).
//
// Each generation selects parents by rank, creates children (breeding.hpp) and evaluates them as one batch. The next
// population consists of the best of parents and children together (`best`, a (mu + lambda) selection), or of the
// children and the `elite` best parents (`generational`). No parameter depends on the total number of generations, so
// that a finished run can be extended.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/evolutionary/evolution.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

struct GeneticPlan {
  EvolutionPlan evolution;
  std::size_t competing_parents = 0;  ///< number of best parents that compete with the children for survival
  std::optional<double> target;
};

/// Survivor selection by rank: feasibility, then the objective or the constraint violation.
class RankSelection final : public SurvivorSelection {
 public:
  RankSelection(const GeneticPlan& plan, const Problem& problem, const EvaluationTable& table)
      : plan_(plan), problem_(problem), table_(table) {}

  bool update(const std::vector<std::int64_t>& children) override {
    population_.resize(std::min(population_.size(), plan_.competing_parents));
    const auto parents = static_cast<std::ptrdiff_t>(population_.size());
    for (const std::int64_t row : children)
      population_.push_back(ranked(problem_.objectives(), table_, static_cast<std::size_t>(row)));
    parallel_sort(population_, static_cast<std::size_t>(parents));
    const auto first_child = population_.begin() + parents;
    if (first_child != population_.end() && (best_.row < 0 || *first_child < best_)) best_ = *first_child;
    std::inplace_merge(population_.begin(), first_child, population_.end());
    population_.resize(std::min(population_.size(), plan_.evolution.breeding.population));
    rows_.clear();
    for (const RankKey& member : population_) rows_.push_back(member.row);
    if (!has_progressed()) return false;
    progress_reference_ = best_;
    return true;
  }

  const std::vector<std::int64_t>& population() const override { return rows_; }
  std::int64_t best_row() const override { return best_.row; }

  bool target_reached() const override {
    if (!plan_.target || best_.status != Status::feasible) return false;
    const bool maximise = problem_.objectives()[0].direction == Direction::maximise;
    return best_.value <= (maximise ? -*plan_.target : *plan_.target);
  }

 private:
  bool has_progressed() const {
    return progress_reference_.row < 0 || best_.status != progress_reference_.status ||
           plan_.evolution.is_progress(progress_reference_.value - best_.value, progress_reference_.value);
  }

  const GeneticPlan& plan_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::vector<RankKey> population_;  // rank keys of the population, best first
  std::vector<std::int64_t> rows_;   // row numbers of the population, in the same order
  RankKey best_;                     // rank key of the best design of all generations
  RankKey progress_reference_;       // rank key of the best design at the end of the last generation that made progress
};

std::unique_ptr<Optimiser> make_genetic_algorithm(const Options& options, const DesignSpace& space) {
  GeneticPlan plan;
  plan.evolution = evolution_plan(options, space);
  const std::size_t population = plan.evolution.breeding.population;
  const auto elite = static_cast<std::size_t>(options.integer("elite"));
  if (elite >= population)
    throw std::invalid_argument("elite = " + std::to_string(elite) +
                                " is too large; expected less than population = " + std::to_string(population));
  const bool generational = options.word("replacement") == "generational";
  plan.competing_parents = generational ? elite : population;
  plan.evolution.children = generational ? population - elite : population;
  if (options.has("target")) plan.target = options.number("target");
  return make_evolution(plan.evolution, [plan](const Problem& problem, const EvaluationTable& table) {
    return std::make_unique<RankSelection>(plan, problem, table);
  });
}

std::vector<OptionSpec> genetic_options() {
  std::vector<OptionSpec> specs = evolution_options("the best objective value");
  specs.insert(specs.end() - 2,
               {word_option("replacement", {"best", "generational"},
                            "survivors: the best of parents and children, or the children and the elite"),
                integer_option("elite", std::int64_t{1}, 0, 1e6, "generational: number of best parents that survive")});
  specs.push_back(
      number_option("target", {}, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                    "stop when a feasible design reaches this value, in the objective's unit (default: never)"));
  specs.back().unit = kUnitOfEntry;
  return specs;
}

}  // namespace

OptimiserEntry genetic_algorithm() {
  return {
      .name = "ga",
      .meaning = "genetic algorithm for one objective with constraints",
      .capabilities = [](const Options&) { return Capabilities{.too_many_objectives_hint = "use nsga2 for several"}; },
      .options = genetic_options(),
      .make = make_genetic_algorithm,
      .resolve = resolve_breeding};
}

}  // namespace pkm
