#include "engine/optimisers/genetic_algorithm.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "engine/optimisers/breeding.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/order.hpp"

namespace pkm {
namespace {

struct Plan {
  BreedingPlan breeding;
  std::int64_t generations = 100;
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  bool generational = false;
  std::size_t elite = 1;
  std::optional<std::int64_t> stall;
  double tolerance = 1e-8;
  std::optional<double> target;
};

// One run: the state that a stage carries from generation to generation.
class Run {
 public:
  Run(const Plan& plan, const StageInput& input, EvaluationTable& table)
      : plan_(plan), input_(input), table_(table), breeder_(plan.breeding, input.problem.space(), input.seed) {}

  StageResult operator()() {
    breeder_.start(input_.starts, table_, room(), newcomers_);
    while (true) {
      const std::size_t first = evaluated_;
      evaluate();
      survive();
      const bool goes_on = report(first);
      if (const auto reason = stop()) return {*reason, best_.row};
      if (!goes_on) return {StopReason::interrupted, best_.row};
      ++generation_;
      const std::size_t count = plan_.breeding.population - (plan_.generational ? plan_.elite : 0);
      breeder_.offspring(static_cast<std::uint32_t>(generation_), rows_, count, table_, room(), newcomers_);
      if (newcomers_.empty()) return {StopReason::exhausted, best_.row};
    }
  }

 private:
  std::size_t room() const {
    return static_cast<std::size_t>(plan_.evaluations - static_cast<std::int64_t>(table_.size()));
  }

  void evaluate() {
    if (evaluated_ < table_.size()) input_.evaluator.evaluate(input_.problem, table_, evaluated_);
    evaluated_ = table_.size();
    children_.clear();
    for (const std::int64_t row : newcomers_)
      children_.push_back(ranked(input_.problem, table_, static_cast<std::size_t>(row)));
    std::sort(children_.begin(), children_.end());
  }

  // Both lists are sorted; so is their merge.
  void survive() {
    if (plan_.generational) population_.resize(std::min(population_.size(), plan_.elite));
    merged_.resize(population_.size() + children_.size());
    std::merge(population_.begin(), population_.end(), children_.begin(), children_.end(), merged_.begin());
    merged_.resize(std::min(merged_.size(), plan_.breeding.population));
    population_.swap(merged_);
    rows_.clear();
    for (const Ranked& member : population_) rows_.push_back(member.row);
    if (!children_.empty() && (best_.row < 0 || children_.front() < best_)) best_ = children_.front();
    if (advanced()) {
      reference_ = best_;
      last_advance_ = generation_;
    }
  }

  bool advanced() const {
    if (reference_.row < 0 || best_.status != reference_.status) return true;
    return reference_.value - best_.value > plan_.tolerance * std::fabs(reference_.value);
  }

  bool report(std::size_t first) { return input_.monitor.generation({generation_, first, &table_, &rows_, best_.row}); }

  std::optional<StopReason> stop() const {
    if (plan_.target && best_.status == Status::feasible) {
      const bool maximise = input_.problem.objectives()[0].direction == Direction::maximise;
      if (best_.value <= (maximise ? -*plan_.target : *plan_.target)) return StopReason::target;
    }
    if (plan_.stall && generation_ - last_advance_ >= *plan_.stall) return StopReason::stall;
    if (room() == 0) return StopReason::evaluations;
    if (generation_ >= plan_.generations) return StopReason::generations;
    return {};
  }

  const Plan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  Breeder breeder_;
  std::int64_t generation_ = 0;
  std::size_t evaluated_ = 0;            // rows of the table that are evaluated
  std::vector<std::int64_t> newcomers_;  // rows of this generation's children
  std::vector<Ranked> children_, population_, merged_;
  std::vector<std::int64_t> rows_;  // of the population, best first
  Ranked best_;                     // of all generations
  Ranked reference_;                // best at the last improvement that counted
  std::int64_t last_advance_ = 0;
};

class GeneticAlgorithm final : public Optimiser {
 public:
  explicit GeneticAlgorithm(Plan plan) : plan_(std::move(plan)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    return Run(plan_, input, table)();
  }

  std::int64_t evaluation_limit(const Problem&) const override {
    const auto population = static_cast<std::int64_t>(plan_.breeding.population);
    const std::int64_t children = population - (plan_.generational ? static_cast<std::int64_t>(plan_.elite) : 0);
    return std::min(plan_.evaluations, population + plan_.generations * children);
  }

 private:
  Plan plan_;
};

std::unique_ptr<Optimiser> make(const Options& options, const DesignSpace& space) {
  Plan plan;
  plan.breeding = breeding_plan(options, space);
  plan.generations = options.integer("generations");
  if (options.has("evaluations")) plan.evaluations = options.integer("evaluations");
  plan.generational = options.word("replacement") == "generational";
  plan.elite = static_cast<std::size_t>(options.integer("elite"));
  if (options.has("stall")) plan.stall = options.integer("stall");
  plan.tolerance = options.number("tolerance");
  if (options.has("target")) plan.target = options.number("target");
  if (plan.elite >= plan.breeding.population)
    throw std::invalid_argument("elite = " + std::to_string(plan.elite) +
                                " must be less than population = " + std::to_string(plan.breeding.population) + ".");
  return std::make_unique<GeneticAlgorithm>(plan);
}

std::vector<OptionSpec> options() {
  constexpr double kMany = 1e12;
  std::vector<OptionSpec> specs = breeding_options();
  specs.insert(specs.begin() + 1,
               {integer_option("generations", std::int64_t{100}, 0, 4e9, "generations after the start population"),
                integer_option("evaluations", {}, 1, kMany, "most designs to evaluate (default: no limit)")});
  specs.insert(
      specs.end(),
      {
          word_option("replacement", {"best", "generational"},
                      "survivors: the best of parents and children, or the children and the elite"),
          integer_option("elite", std::int64_t{1}, 0, 1e6, "generational: best parents that survive"),
          integer_option("stall", {}, 1, kMany, "stop after so many generations without improvement (default: never)"),
          number_option("tolerance", 1e-8, 0, 1, "relative improvement of the best that counts for stall"),
          number_option("target", {}, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                        "stop when a feasible design reaches this objective, in its unit (default: never)"),
      });
  specs.back().unit = kUnitOfEntry;
  return specs;
}

}  // namespace

OptimiserEntry genetic_algorithm() {
  return {"ga",
          "genetic algorithm for one objective with constraints",
          [](const Options&) { return Capabilities{}; },
          options(),
          make,
          resolve_breeding};
}

}  // namespace pkm
