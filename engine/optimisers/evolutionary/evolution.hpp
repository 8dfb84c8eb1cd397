// What population-based optimisers share: generation after generation of breeding and evaluation, until a limit or
// the survivors say that it is enough. Who survives is what they differ in.
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
  std::size_t children = 20;  ///< per generation
  std::int64_t generations = 100;
  std::int64_t evaluations = std::numeric_limits<std::int64_t>::max();
  std::optional<std::int64_t> stall;  ///< generations without progress after which to stop
  double tolerance = 1e-8;            ///< relative improvement that is progress

  bool progress(double gain, double before) const { return gain > tolerance * std::fabs(before); }
};

/// Who lives on after a generation.
class Survivors {
 public:
  virtual ~Survivors() = default;
  /// Joins evaluated children (rows of the stage's table) with the population. Returns whether that was progress, as
  /// far as stalling is concerned.
  virtual bool take(const std::vector<std::int64_t>& children) = 0;
  /// Rows of the population in the order of preference, best first.
  virtual const std::vector<std::int64_t>& population() const = 0;
  /// The row to be shown for all; -1 while there is none.
  virtual std::int64_t best_row() const = 0;
  /// Whether nothing more is asked for.
  virtual bool satisfied() const { return false; }
  /// Several objectives: the trade-off so far.
  virtual const Front* front() const { return nullptr; }
};

/// Makes the survivors of one run.
using SurvivorsMaker = std::function<std::unique_ptr<Survivors>(const Problem&, const EvaluationTable&)>;

std::unique_ptr<Optimiser> make_evolution(const EvolutionPlan& plan, SurvivorsMaker survivors);

/// The options that `evolution_plan` reads, for catalogue entries; `progress` says what stalls.
std::vector<OptionSpec> evolution_options(const std::string& progress);
/// All but `children`, which is the population.
EvolutionPlan evolution_plan(const Options& options, const DesignSpace& space);

}  // namespace pkm
