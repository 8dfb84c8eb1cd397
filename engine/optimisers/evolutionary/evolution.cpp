#include "engine/optimisers/evolutionary/evolution.hpp"

#include <algorithm>
#include <utility>

#include "engine/optimisers/evolutionary/breeding.hpp"
#include "engine/optimisers/option_specs.hpp"

namespace pkm {
namespace {

// State of one run of an evolutionary algorithm.
class EvolutionRun {
 public:
  EvolutionRun(const EvolutionPlan& plan, const StageInput& input, EvaluationTable& table, SurvivorSelection& survivors)
      : plan_(plan),
        input_(input),
        table_(table),
        survivors_(survivors),
        breeder_(plan.breeding, input.problem.space(), input.seed) {}

  StageResult operator()() {
    breeder_.create_initial_population(input_.starts, table_, evaluations_left(), new_members_);
    while (true) {
      const std::size_t first = evaluated_rows_;
      if (evaluated_rows_ < table_.size()) input_.evaluate(table_, evaluated_rows_);
      evaluated_rows_ = table_.size();
      if (survivors_.update(new_members_)) last_progress_ = generation_;
      const bool continues = report(first);
      if (const auto reason = stop_reason()) return make_result(*reason);
      if (!continues) return make_result(StopReason::interrupted);
      ++generation_;
      breeder_.create_children(static_cast<std::uint32_t>(generation_), survivors_.population(), plan_.children, table_,
                               evaluations_left(), new_members_);
      if (new_members_.empty()) return make_result(StopReason::exhausted);
    }
  }

 private:
  std::size_t evaluations_left() const {
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

  std::optional<StopReason> stop_reason() const {
    if (survivors_.target_reached()) return StopReason::target;
    if (plan_.stall && generation_ - last_progress_ >= *plan_.stall) return StopReason::stall;
    if (evaluations_left() == 0) return StopReason::evaluations;
    if (generation_ >= plan_.generations) return StopReason::generations;
    return {};
  }

  StageResult make_result(StopReason reason) const {
    StageResult result{reason, survivors_.best_row()};
    if (survivors_.front()) result.front = *survivors_.front();
    return result;
  }

  const EvolutionPlan& plan_;
  const StageInput& input_;
  EvaluationTable& table_;
  SurvivorSelection& survivors_;
  Breeder breeder_;
  std::int64_t generation_ = 0;
  std::size_t evaluated_rows_ = 0;  // number of evaluated rows of the table
  // Row numbers of the initial population, or of the children of the current generation.
  std::vector<std::int64_t> new_members_;
  std::int64_t last_progress_ = 0;
};

class Evolution final : public Optimiser {
 public:
  Evolution(const EvolutionPlan& plan, SurvivorSelectionFactory survivors)
      : plan_(plan), survivors_(std::move(survivors)) {}

  StageResult minimise(const StageInput& input, EvaluationTable& table) const override {
    return EvolutionRun(plan_, input, table, *survivors_(input.problem, table))();
  }
  std::int64_t evaluation_limit(const Problem&) const override {
    return std::min(plan_.evaluations, static_cast<std::int64_t>(plan_.breeding.population) +
                                           plan_.generations * static_cast<std::int64_t>(plan_.children));
  }

 private:
  EvolutionPlan plan_;
  SurvivorSelectionFactory survivors_;
};

}  // namespace

std::unique_ptr<Optimiser> make_evolution(const EvolutionPlan& plan, SurvivorSelectionFactory survivors) {
  return std::make_unique<Evolution>(plan, std::move(survivors));
}

std::vector<OptionSpec> evolution_options(const std::string& measure) {
  constexpr double kMaxCount = 1e12;
  std::vector<OptionSpec> specs = breeding_options();
  specs.insert(
      specs.begin() + 1,
      {integer_option("generations", std::int64_t{100}, 0, 4e9, "generations after the initial population"),
       integer_option("evaluations", {}, 1, kMaxCount, "maximum number of designs to evaluate (default: no limit)")});
  specs.push_back(
      integer_option("stall", {}, 1, kMaxCount, "stop after this many generations without progress (default: never)"));
  specs.push_back(number_option("tolerance", 1e-8, 0, 1,
                                "relative improvement of " + measure + " that counts as progress for stall"));
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
