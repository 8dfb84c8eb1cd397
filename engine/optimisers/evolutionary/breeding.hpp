// Reproduction in evolutionary algorithms: parent selection, crossover, mutation and elimination of duplicate designs.
// One and several objectives are handled alike, because only the rank of the parents is used.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/parameter.hpp"
#include "engine/optimisers/evolutionary/breeding_plan.hpp"
#include "engine/optimisers/evolutionary/design_hash_set.hpp"
#include "engine/optimisers/optimiser.hpp"

namespace pkm {

/// Creates designs and appends them to the evaluation table of one stage, as rows that are not yet evaluated.
class Breeder {
 public:
  Breeder(const BreedingPlan& plan, const DesignSpace& space, std::uint64_t seed)
      : plan_(plan), space_(space), seed_(seed) {}

  /// Creates the initial population: the given designs, projected onto the design space, then space-filling samples.
  /// @param max_new_rows  maximum number of rows added to the evaluation table: 0, or at least the size of the
  ///   population
  /// @param members  receives the row numbers of the population
  void create_initial_population(const std::vector<StartDesign>& given_designs, EvaluationTable& table,
                                 std::size_t max_new_rows, std::vector<std::int64_t>& members);

  /// Creates `count` children of `parents`. A child equal to an evaluated design is not added again: it is represented
  /// by the row of that design or, if the plan requires unique children, changed until it is new. There are fewer
  /// children if a bounded number of tries finds no new design, or once `max_new_rows` rows have been added; the
  /// children created before that do not depend on `max_new_rows`.
  /// @param parents  row numbers of the parents, best first
  /// @param children  receives the row numbers of the children
  void create_children(std::uint32_t generation, std::span<const std::int64_t> parents, std::size_t count,
                       EvaluationTable& table, std::size_t max_new_rows, std::vector<std::int64_t>& children);

 private:
  bool add_child(std::uint32_t generation, std::uint32_t individual, std::span<double> child, EvaluationTable& table,
                 std::size_t max_new_rows, std::vector<std::int64_t>& members);
  bool make_unique(std::uint32_t generation, std::uint32_t individual, std::span<double> child,
                   const EvaluationTable& table);
  void make_child(const ParentPool& pool, std::size_t first, std::size_t second, Stream& stream,
                  std::span<double> child) const;
  void snap_to_space(std::span<double> child) const;

  const BreedingPlan& plan_;
  const DesignSpace& space_;
  std::uint64_t seed_;
  DesignHashSet evaluated_;
  std::vector<double> parent_designs_;  // values of the variables of all parents, one parent after another, best first
  // Values of the variables of all children, duplicates included, one child after another.
  std::vector<double> child_designs_;
  std::vector<std::uint32_t> parent_indices_;
};

}  // namespace pkm
