#include "engine/optimisers/evolutionary/genetic_algorithm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "engine/optimisers/evolutionary/evolution.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/order.hpp"

namespace pkm {
namespace {

struct Plan {
  EvolutionPlan evolution;
  std::size_t parents = 0;  ///< best ones that compete with the children
  double tolerance = 1e-8;
  std::optional<double> target;
};

/// The best by feasibility and the one objective.
class Best final : public Survivors {
 public:
  Best(const Plan& plan, const Problem& problem, const EvaluationTable& table)
      : plan_(plan), problem_(problem), table_(table) {}

  // Both lists are sorted; so is their merge.
  bool take(const std::vector<std::int64_t>& newcomers) override {
    children_.clear();
    for (const std::int64_t row : newcomers)
      children_.push_back(ranked(problem_, table_, static_cast<std::size_t>(row)));
    std::sort(children_.begin(), children_.end());
    population_.resize(std::min(population_.size(), plan_.parents));
    merged_.resize(population_.size() + children_.size());
    std::merge(population_.begin(), population_.end(), children_.begin(), children_.end(), merged_.begin());
    merged_.resize(std::min(merged_.size(), plan_.evolution.breeding.population));
    population_.swap(merged_);
    rows_.clear();
    for (const Ranked& member : population_) rows_.push_back(member.row);
    if (!children_.empty() && (best_.row < 0 || children_.front() < best_)) best_ = children_.front();
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
    if (reference_.row < 0 || best_.status != reference_.status) return true;
    return reference_.value - best_.value > plan_.tolerance * std::fabs(reference_.value);
  }

  const Plan& plan_;
  const Problem& problem_;
  const EvaluationTable& table_;
  std::vector<Ranked> children_, population_, merged_;
  std::vector<std::int64_t> rows_;  // of the population, best first
  Ranked best_;                     // of all generations
  Ranked reference_;                // best at the last improvement that counted
};

class GeneticAlgorithm final : public Optimiser {
 public:
  explicit GeneticAlgorithm(Plan plan) : plan_(std::move(plan)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    Best best(plan_, input.problem, table);
    return evolve(plan_.evolution, input, table, best);
  }
  std::int64_t evaluation_limit(const Problem&) const override { return pkm::evaluation_limit(plan_.evolution); }

 private:
  Plan plan_;
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
  plan.tolerance = options.number("tolerance");
  if (options.has("target")) plan.target = options.number("target");
  return std::make_unique<GeneticAlgorithm>(plan);
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
  return {"ga",
          "genetic algorithm for one objective with constraints",
          [](const Options&) { return Capabilities{.objectives_hint = "nsga2 works on several"}; },
          options(),
          make,
          resolve_breeding};
}

}  // namespace pkm
