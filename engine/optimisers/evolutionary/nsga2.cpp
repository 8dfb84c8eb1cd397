// NSGA-II (Deb et al. 2002): genetic algorithm for several objectives with constraints, by non-dominated sorting and
// crowding distance. Fronts are truncated one design at a time (crowding.hpp), and all feasible non-dominated designs
// are archived.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/crowding.hpp"
#include "engine/optimisers/evolutionary/evolution.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/pareto_archive.hpp"
#include "engine/problem/ranking.hpp"

namespace pkm {
namespace {

struct Nsga2Plan {
  EvolutionPlan evolution;
  ParetoArchivePlan archive;
};

/// Survivor selection of NSGA-II: feasible designs by front index, within a front by crowding distance; then the other
/// designs by constraint violation.
class Nsga2Selection final : public SurvivorSelection {
 public:
  Nsga2Selection(const Nsga2Plan& plan, const Problem& problem, const EvaluationTable& table)
      : plan_(plan),
        problem_(problem),
        table_(table),
        archive_(plan.archive, problem, table),
        scores_{problem.objectives().size()} {}

  bool update(const std::vector<std::int64_t>& children) override {
    merge_children(children);
    const bool archive_changed = archive_.add(children);
    std::vector<RankKey> others;
    feasible_rows_.clear();
    scores_.clear();
    for (const std::int64_t row : rows_) {
      const auto r = static_cast<std::size_t>(row);
      if (table_.status[r] == Status::feasible) {
        feasible_rows_.push_back(row);
        add_scores(problem_.objectives(), table_, r, scores_);
      } else {
        others.push_back(ranked(problem_.objectives(), table_, r));
      }
    }
    rows_.clear();
    select_by_fronts();
    parallel_sort(others);
    for (const RankKey& other : others)
      if (rows_.size() < population_size()) rows_.push_back(other.row);
    const bool violation_reduced = !others.empty() && (best_infeasible_.row < 0 || others.front() < best_infeasible_);
    if (violation_reduced) best_infeasible_ = others.front();
    return has_progressed(archive_changed, violation_reduced);
  }

  const std::vector<std::int64_t>& population() const override { return rows_; }
  std::int64_t best_row() const override {
    return archive_.compromise_row() >= 0 ? archive_.compromise_row() : best_infeasible_.row;
  }
  const Front* front() const override { return &archive_.front(); }

 private:
  std::size_t population_size() const { return plan_.evolution.breeding.population; }

  /// Adds the children to the population. A child that equals an evaluated design is represented by the row of that
  /// design; therefore duplicate rows are removed.
  void merge_children(const std::vector<std::int64_t>& children) {
    rows_.insert(rows_.end(), children.begin(), children.end());
    parallel_sort(rows_);
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
  }

  void select_by_fronts() {
    non_dominated_sort(scores_, front_index_);
    // For each front, its members, as indices into feasible_rows_.
    std::vector<std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < feasible_rows_.size(); ++i) {
      if (front_index_[i] >= members.size()) members.resize(front_index_[i] + 1);
      members[front_index_[i]].push_back(i);
    }
    Scores front{scores_.objectives};
    for (std::size_t number = 0; number < members.size() && rows_.size() < population_size(); ++number) {
      front.clear();
      for (const std::size_t i : members[number]) front.add({scores_[i], scores_.objectives});
      const std::vector<std::uint32_t> order = order_by_crowding(front, population_size() - rows_.size());
      if (number == 0) archive_.set_spread(survivor_spread(front, order));
      for (std::size_t i = 0; i < order.size() && rows_.size() < population_size(); ++i)
        rows_.push_back(feasible_rows_[members[number][order[i]]]);
    }
  }

  /// Spacing indicator of those members of the first front that survive.
  double survivor_spread(const Scores& front, const std::vector<std::uint32_t>& order) const {
    Scores survivors{front.objectives};
    for (std::size_t i = 0; i < std::min(order.size(), population_size()); ++i)
      survivors.add({front[order[i]], front.objectives});
    return spread(survivors);
  }

  /// Returns true if the hypervolume has increased. As long as the hypervolume is undefined, any change of the front
  /// counts as progress; as long as no design is feasible, any reduction of the constraint violation does.
  bool has_progressed(bool archive_changed, bool violation_reduced) {
    const double hypervolume = archive_.front().hypervolume;
    if (std::isnan(hypervolume)) return archive_changed || (violation_reduced && archive_.compromise_row() < 0);
    if (!plan_.evolution.is_progress(hypervolume - last_hypervolume_, last_hypervolume_)) return false;
    last_hypervolume_ = hypervolume;
    return true;
  }

  const Nsga2Plan& plan_;
  const Problem& problem_;
  const EvaluationTable& table_;
  ParetoArchive archive_;
  std::vector<std::int64_t> rows_;           // row numbers of the population
  std::vector<std::int64_t> feasible_rows_;  // row numbers of the feasible designs among population and children
  Scores scores_;                            // scores of the designs in feasible_rows_, in the same order
  std::vector<std::uint32_t> front_index_;   // front index of each design in feasible_rows_
  RankKey best_infeasible_;
  double last_hypervolume_ = -1;
};

Capabilities nsga2_capabilities(const Options& options) {
  return {.min_objectives = 2,
          .max_objectives = options.has("stall") || options.has("reference") ? 3 : kUnlimitedObjectives,
          .too_many_objectives_hint =
              "for more objectives omit stall and reference: hypervolumes are computed for two or three only"};
}

std::unique_ptr<Optimiser> make_nsga2(const Options& options, const DesignSpace& space) {
  Nsga2Plan plan;
  plan.evolution = evolution_plan(options, space);
  if (options.has("archive")) plan.archive.max_size = static_cast<std::size_t>(options.integer("archive"));
  if (options.has("reference")) plan.archive.reference = options.numbers("reference");
  plan.archive.min_feasible_designs = plan.evolution.breeding.population;
  if (options.has("reference_front")) plan.archive.reference_front = options.list("reference_front");
  if (options.has("reference_front") && plan.archive.reference_front.empty())
    throw std::invalid_argument("reference_front has no points; expected at least one");
  return make_evolution(plan.evolution, [plan](const Problem& problem, const EvaluationTable& table) {
    return std::make_unique<Nsga2Selection>(plan, problem, table);
  });
}

std::vector<OptionSpec> nsga2_options() {
  std::vector<OptionSpec> specs = evolution_options("the hypervolume");
  for (OptionSpec& spec : specs) {
    // The default is not the differential crossover: differences of members from distant parts of the front rarely
    // improve a design.
    if (spec.name == "crossover") spec.initial = "sbx";
    // With a smaller tolerance, almost every generation would count as progress, because the hypervolume increases
    // slightly.
    if (spec.name == "tolerance") spec.initial = 1e-4;
    if (spec.name != "population") continue;
    spec.initial = std::int64_t{100};
    spec.meaning = "designs per generation";
  }
  specs.push_back(integer_option(
      "archive", {}, 4, 1e9, "maximum size of the archived front, truncated by crowding distance (default: no limit)"));
  specs.push_back({.name = "reference",
                   .kind = OptionKind::named_numbers,
                   .meaning = "reference point of the hypervolume, a value per objective (default: the worst values of "
                              "the first feasible designs, as many as the population, plus a tenth of their range)",
                   .field_names = FieldNames::objectives});
  specs.push_back(
      {.name = "reference_front",
       .kind = OptionKind::list_of_numbers,
       .meaning = "points of a known front, a value per objective, to which the distance (IGD+) is reported",
       .field_names = FieldNames::objectives});
  return specs;
}

}  // namespace

OptimiserEntry nsga2() {
  return {.name = "nsga2",
          .meaning = "NSGA-II: genetic algorithm for the Pareto front of several objectives, with constraints",
          .capabilities = nsga2_capabilities,
          .options = nsga2_options(),
          .make = make_nsga2,
          .resolve = resolve_breeding};
}

}  // namespace pkm
