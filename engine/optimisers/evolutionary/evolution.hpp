// Generational evolutionary algorithm, the main loop of the population-based optimisers: reproduction, evaluation and
// survivor selection, until a stopping criterion is met. The optimisers differ in their survivor selection.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/optimisers/evolutionary/breeding_plan.hpp"
#include "engine/optimisers/optimiser.hpp"

namespace pkm {

struct EvolutionPlan {
  BreedingPlan breeding;
  std::size_t children = 20;  ///< number of children per generation
  std::int64_t generations = 100;
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  /// Number of generations without progress after which the run stops; std::nullopt: it does not stop.
  std::optional<std::int64_t> stall;
  double tolerance = 1e-8;  ///< relative improvement that counts as progress

  bool is_progress(double gain, double reference) const { return gain > tolerance * std::fabs(reference); }
};

/// Survivor selection: decides which designs form the next population.
class SurvivorSelection {
 public:
  virtual ~SurvivorSelection() = default;
  /// Selects the next population from the current one and the evaluated `children`, which are given by their row
  /// numbers in the evaluation table of the stage.
  /// @return true if the generation made progress, for the stall criterion
  virtual bool update(const std::vector<std::int64_t>& children) = 0;
  /// Row numbers of the population in the evaluation table, best first.
  virtual const std::vector<std::int64_t>& population() const = 0;
  /// Row number, in the evaluation table, of the best design so far (with several objectives, of the compromise
  /// solution); -1 while there is none.
  virtual std::int64_t best_row() const = 0;
  /// Returns true if the run has reached the target that the study sets; the run then stops.
  virtual bool target_reached() const { return false; }
  /// The Pareto front so far, in runs with several objectives; null with one objective.
  virtual const Front* front() const { return nullptr; }
};

/// Creates the survivor selection of one run.
using SurvivorSelectionFactory =
    std::function<std::unique_ptr<SurvivorSelection>(const Problem&, const EvaluationTable&)>;

std::unique_ptr<Optimiser> make_evolution(const EvolutionPlan& plan, SurvivorSelectionFactory survivors);

/// Specifications of the options that `evolution_plan` reads, for catalogue entries.
/// @param measure  the quantity whose improvement counts as progress, for the help text of `tolerance`
std::vector<OptionSpec> evolution_options(const std::string& measure);
/// Reads the options of an evolutionary algorithm. The number of children per generation is set to the population size.
EvolutionPlan evolution_plan(const Options& options, const DesignSpace& space);

}  // namespace pkm
