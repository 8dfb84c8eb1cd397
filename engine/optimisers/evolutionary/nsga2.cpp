#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/diversity.hpp"
#include "engine/optimisers/evolutionary/evolution.hpp"
#include "engine/optimisers/front_keeper.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/problem/order.hpp"

namespace pkm {
namespace {

struct Plan {
  EvolutionPlan evolution;
  FrontPlan front;
};

/// Feasible designs by the number of their front, within a front those first that tell most of it; then the others by
/// the feasibility rules.
class TradeOff final : public Survivors {
 public:
  TradeOff(const Plan& plan, const Problem& problem, const EvaluationTable& table)
      : plan_(plan),
        problem_(problem),
        table_(table),
        keeper_(plan.front, problem, table),
        scores_{problem.objectives().size()} {}

  bool take(const std::vector<std::int64_t>& children) override {
    join(children);
    const bool gained = keeper_.add(children);
    std::vector<Ranked> others;
    candidates_.clear();
    scores_.clear();
    for (const std::int64_t row : rows_) {
      const auto r = static_cast<std::size_t>(row);
      if (table_.status[r] == Status::feasible) {
        candidates_.push_back(row);
        add_scores(problem_.objectives(), table_, r, scores_);
      } else {
        others.push_back(ranked(problem_.objectives(), table_, r));
      }
    }
    rows_.clear();
    survive_by_fronts();
    sort_with_team(others);
    for (const Ranked& other : others)
      if (rows_.size() < most()) rows_.push_back(other.row);
    const bool less_broken = !others.empty() && (best_infeasible_.row < 0 || others.front() < best_infeasible_);
    if (less_broken) best_infeasible_ = others.front();
    return progress(gained, less_broken);
  }

  const std::vector<std::int64_t>& population() const override { return rows_; }
  std::int64_t best_row() const override {
    return keeper_.compromise_row() >= 0 ? keeper_.compromise_row() : best_infeasible_.row;
  }
  const Front* front() const override { return &keeper_.front(); }

 private:
  std::size_t most() const { return plan_.evolution.breeding.population; }

  /// A child that is a design known already has its row: no row counts twice.
  void join(const std::vector<std::int64_t>& children) {
    rows_.insert(rows_.end(), children.begin(), children.end());
    sort_with_team(rows_);
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
  }

  void survive_by_fronts() {
    sort_fronts(scores_, front_of_);
    std::vector<std::vector<std::size_t>> members;  // of each front
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (front_of_[i] >= members.size()) members.resize(front_of_[i] + 1);
      members[front_of_[i]].push_back(i);
    }
    Scores front{scores_.objectives};
    for (std::size_t number = 0; number < members.size() && rows_.size() < most(); ++number) {
      front.clear();
      for (const std::size_t i : members[number]) front.add({scores_[i], scores_.objectives});
      const std::vector<std::uint32_t> order = most_diverse(front, most() - rows_.size());
      if (number == 0) keeper_.set_spread(spread_of(front, order));
      for (std::size_t i = 0; i < order.size() && rows_.size() < most(); ++i)
        rows_.push_back(candidates_[members[number][order[i]]]);
    }
  }

  /// Of those that survive.
  double spread_of(const Scores& front, const std::vector<std::uint32_t>& order) const {
    Scores survivors{front.objectives};
    for (std::size_t i = 0; i < std::min(order.size(), most()); ++i) survivors.add({front[order[i]], front.objectives});
    return spread(survivors);
  }

  /// A larger hypervolume; while there is none, any change of the front, or, while nothing is feasible, less violation.
  bool progress(bool gained, bool less_broken) {
    const double now = keeper_.front().hypervolume;
    if (std::isnan(now)) return gained || (less_broken && keeper_.compromise_row() < 0);
    if (!plan_.evolution.progress(now - last_hypervolume_, last_hypervolume_)) return false;
    last_hypervolume_ = now;
    return true;
  }

  const Plan& plan_;
  const Problem& problem_;
  const EvaluationTable& table_;
  FrontKeeper keeper_;
  std::vector<std::int64_t> rows_;        // of the population
  std::vector<std::int64_t> candidates_;  // feasible rows that compete
  Scores scores_;                         // theirs
  std::vector<std::uint32_t> front_of_;   // theirs
  Ranked best_infeasible_;
  double last_hypervolume_ = -1;
};

Capabilities capabilities(const Options& options) {
  return {.min_objectives = 2,
          .max_objectives = options.has("stall") || options.has("reference") ? 3 : kManyObjectives,
          .objectives_hint =
              "stall and reference are for the hypervolume of two and three objectives, and it handles more without"};
}

std::unique_ptr<Optimiser> make(const Options& options, const DesignSpace& space) {
  Plan plan;
  plan.evolution = evolution_plan(options, space);
  if (options.has("archive")) plan.front.limit = static_cast<std::size_t>(options.integer("archive"));
  if (options.has("reference")) plan.front.reference = options.numbers("reference");
  plan.front.settled = plan.evolution.breeding.population;
  if (options.has("reference_front")) plan.front.front = options.list("reference_front");
  if (options.has("reference_front") && plan.front.front.empty())
    throw std::invalid_argument("reference_front has no points");
  return make_evolution(plan.evolution, [plan](const Problem& problem, const EvaluationTable& table) {
    return std::make_unique<TradeOff>(plan, problem, table);
  });
}

std::vector<OptionSpec> options() {
  std::vector<OptionSpec> specs = evolution_options("the hypervolume");
  for (OptionSpec& spec : specs) {
    if (spec.name == "crossover") spec.initial = "sbx";  // differences of members far apart on a front lead nowhere
    if (spec.name == "tolerance") spec.initial = 1e-4;   // a front goes on growing a little
    if (spec.name != "population") continue;
    spec.initial = std::int64_t{100};
    spec.meaning = "designs per generation";
  }
  specs.push_back(integer_option("archive", {}, 4, 1e9,
                                 "most designs of the front that is kept; more are thinned out (default: no limit)"));
  specs.push_back({.name = "reference",
                   .kind = OptionKind::named_numbers,
                   .meaning = "corner of the hypervolume, a value per objective (default: a tenth beyond the worst of "
                              "the first feasible designs, as many as the population)",
                   .field_names = FieldNames::objectives});
  specs.push_back({.name = "reference_front",
                   .kind = OptionKind::list_of_numbers,
                   .meaning = "known front, a value per objective and point, to which the distance (IGD+) is reported",
                   .field_names = FieldNames::objectives});
  return specs;
}

}  // namespace

OptimiserEntry nsga2() {
  return {.name = "nsga2",
          .meaning = "genetic algorithm for the trade-off between several objectives, with constraints",
          .capabilities = capabilities,
          .options = options(),
          .make = make,
          .resolve = resolve_breeding};
}

}  // namespace pkm
