#include "engine/optimisers/evolutionary/evolution.hpp"

#include <algorithm>
#include <utility>

#include "engine/optimisers/evolutionary/breeding.hpp"
#include "engine/optimisers/option_specs.hpp"

namespace pkm {
namespace {

// One run: the state that a stage carries from generation to generation.
class Run {
 public:
  Run(const EvolutionPlan& plan, const StageInput& input, EvaluationTable& table, Survivors& survivors)
      : plan_(plan),
        input_(input),
        table_(table),
        survivors_(survivors),
        breeder_(plan.breeding, input.problem.space(), input.seed) {}

  StageResult operator()() {
    breeder_.start(input_.starts, table_, room(), newcomers_);
    while (true) {
      const std::size_t first = evaluated_;
      if (evaluated_ < table_.size()) input_.evaluate(table_, evaluated_);
      evaluated_ = table_.size();
      if (survivors_.take(newcomers_)) last_advance_ = generation_;
      const bool goes_on = report(first);
      if (const auto reason = stop()) return ended(*reason);
      if (!goes_on) return ended(StopReason::interrupted);
      ++generation_;
      breeder_.offspring(static_cast<std::uint32_t>(generation_), survivors_.population(), plan_.children, table_,
                         room(), newcomers_);
      if (newcomers_.empty()) return ended(StopReason::exhausted);
    }
  }

 private:
  std::size_t room() const {
    return static_cast<std::size_t>(plan_.evaluations - static_cast<std::int64_t>(table_.size()));
  }

  bool report(std::size_t first) {
    return input_.monitor.generation({.number = generation_,
                                      .first_row = first,
                                      .table = &table_,
                                      .population = &survivors_.population(),
                                      .best_row = survivors_.best_row(),
                                      .front = survivors_.front()});
  }

  std::optional<StopReason> stop() const {
    if (survivors_.satisfied()) return StopReason::target;
    if (plan_.stall && generation_ - last_advance_ >= *plan_.stall) return StopReason::stall;
    if (room() == 0) return StopReason::evaluations;
    if (generation_ >= plan_.generations) return StopReason::generations;
    return {};
  }

  StageResult ended(StopReason reason) const {
    StageResult result{reason, survivors_.best_row()};
    if (survivors_.front()) result.front = *survivors_.front();
    return result;
  }

  const EvolutionPlan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  Survivors& survivors_;
  Breeder breeder_;
  std::int64_t generation_ = 0;
  std::size_t evaluated_ = 0;            // rows of the table that are evaluated
  std::vector<std::int64_t> newcomers_;  // rows of this generation's children
  std::int64_t last_advance_ = 0;
};

class Evolution final : public Optimiser {
 public:
  Evolution(const EvolutionPlan& plan, SurvivorsMaker survivors) : plan_(plan), survivors_(std::move(survivors)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    return Run(plan_, input, table, *survivors_(input.problem, table))();
  }
  std::int64_t evaluation_limit(const Problem&) const override {
    return std::min(plan_.evaluations, static_cast<std::int64_t>(plan_.breeding.population) +
                                           plan_.generations * static_cast<std::int64_t>(plan_.children));
  }

 private:
  EvolutionPlan plan_;
  SurvivorsMaker survivors_;
};

}  // namespace

std::unique_ptr<Optimiser> make_evolution(const EvolutionPlan& plan, SurvivorsMaker survivors) {
  return std::make_unique<Evolution>(plan, std::move(survivors));
}

std::vector<OptionSpec> evolution_options(const std::string& progress) {
  constexpr double kMany = 1e12;
  std::vector<OptionSpec> specs = breeding_options();
  specs.insert(specs.begin() + 1,
               {integer_option("generations", std::int64_t{100}, 0, 4e9, "generations after the start population"),
                integer_option("evaluations", {}, 1, kMany, "most designs to evaluate (default: no limit)")});
  specs.push_back(
      integer_option("stall", {}, 1, kMany, "stop after so many generations without improvement (default: never)"));
  specs.push_back(
      number_option("tolerance", 1e-8, 0, 1, "relative improvement of " + progress + " that counts for stall"));
  return specs;
}

EvolutionPlan evolution_plan(const Options& options, const DesignSpace& space) {
  EvolutionPlan plan;
  plan.breeding = breeding_plan(options, space);
  plan.children = plan.breeding.population;
  plan.generations = options.integer("generations");
  if (options.has("evaluations")) plan.evaluations = options.integer("evaluations");
  if (options.has("stall")) plan.stall = options.integer("stall");
  plan.tolerance = options.number("tolerance");
  return plan;
}

}  // namespace pkm
