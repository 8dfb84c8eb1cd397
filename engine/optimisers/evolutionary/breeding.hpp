// From one population to the designs of the next: selection, crossover, mutation and the check that nothing is
// evaluated twice. Knows the order of preference of the parents, not where it comes from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/optimisers/evolutionary/breeding_plan.hpp"
#include "engine/optimisers/evolutionary/known_designs.hpp"
#include "engine/optimisers/optimiser.hpp"

namespace pkm {

/// Makes designs and appends them, unevaluated, to one stage's table.
class Breeder {
 public:
  Breeder(const BreedingPlan& plan, const DesignSpace& space, std::uint64_t seed)
      : plan_(plan), space_(space), seed_(seed) {}

  /// The start population: the given designs first (moved into the space), then an even cover. At most `most_new` rows
  /// are added. `members` receives the rows.
  void start(const std::vector<StartDesign>& given, EvaluationTable& table, std::size_t most_new,
             std::vector<std::int64_t>& members);

  /// `count` children of `parents` (best first). A child that equals a known design is not added again: its row is
  /// that design's (unless the plan says unique). Where no new design is found within a bounded number of tries, or
  /// `most_new` rows are added, there are fewer children; those that there are do not depend on `most_new`.
  void offspring(std::uint32_t generation, std::span<const std::int64_t> parents, std::size_t count,
                 EvaluationTable& table, std::size_t most_new, std::vector<std::int64_t>& children);

 private:
  bool add(std::uint32_t generation, std::uint32_t individual, std::span<double> child, EvaluationTable& table,
           std::size_t most_new, std::vector<std::int64_t>& members);
  bool renew(std::uint32_t generation, std::uint32_t individual, std::span<double> child, const EvaluationTable& table);
  void breed(const Pool& pool, std::size_t first, std::size_t second, Stream& stream, std::span<double> child) const;
  void move_into_space(std::span<double> child) const;

  const BreedingPlan& plan_;
  const DesignSpace& space_;
  std::uint64_t seed_;
  KnownDesigns known_;
  std::vector<double> pool_;      // designs of the parents, best first
  std::vector<double> children_;  // designs as bred, known or not
  std::vector<std::uint32_t> parents_;
};

}  // namespace pkm
