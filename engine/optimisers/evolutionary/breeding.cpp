#include "engine/optimisers/evolutionary/breeding.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

namespace pkm {

void Breeder::create_initial_population(const std::vector<StartDesign>& given_designs, EvaluationTable& table,
                                        std::size_t max_new_rows, std::vector<std::int64_t>& members) {
  members.clear();
  const std::size_t count = plan_.population, n = space_.dimension(), end = table.size() + max_new_rows;
  const std::vector<double> points = unit_cube_samples(plan_.sampling, count, n, seed_);
  std::vector<double> child(n);
  for (std::size_t k = 0; k < count; ++k) {
    if (k < given_designs.size()) {
      std::ranges::copy(given_designs[k].design, child.begin());
    } else {
      for (std::size_t i = 0; i < n; ++i) child[i] = space_.from_unit(i, points[k * n + i]);
    }
    snap_to_space(child);
    if (!add_child(0, static_cast<std::uint32_t>(k), child, table, end - table.size(), members)) break;
  }
}

void Breeder::create_children(std::uint32_t generation, std::span<const std::int64_t> parents, std::size_t count,
                              EvaluationTable& table, std::size_t max_new_rows, std::vector<std::int64_t>& children) {
  children.clear();
  parent_indices_.resize(2 * count);
  Stream choices(seed_, generation, 0, Stream::Use::selection);
  select_parents(plan_.selection, parents.size(), choices, parent_indices_);
  parent_designs_.clear();  // the designs are copied here because the rows of the table are far apart in memory
  for (const std::int64_t row : parents) {
    const auto design = table.design(static_cast<std::size_t>(row));
    parent_designs_.insert(parent_designs_.end(), design.begin(), design.end());
  }
  const std::size_t n = space_.dimension();
  const ParentPool pool{parent_designs_, n};
  child_designs_.resize(count * n);
  const auto child = [&](std::size_t k) { return std::span(child_designs_).subspan(k * n, n); };
  const auto make_children = [&](std::size_t begin, std::size_t stop) {
    for (std::size_t k = begin; k < stop; ++k) {
      Stream stream(seed_, generation, static_cast<std::uint32_t>(k), Stream::Use::variation);
      make_child(pool, parent_indices_[2 * k], parent_indices_[2 * k + 1], stream, child(k));
    }
  };
  // Minimum number of children for which several threads are used, because creating one child takes only 0.2 us.
  constexpr std::size_t kMinSharedChildren = 1000;
  if (count < kMinSharedChildren)
    make_children(0, count);
  else
    parallel_for(count, make_children);
  const std::size_t end = table.size() + max_new_rows;
  constexpr std::size_t kPrefetchDistance = 8;
  for (std::size_t k = 0; k < count; ++k) {
    if (k + kPrefetchDistance < count) evaluated_.prefetch(child(k + kPrefetchDistance));
    if (!add_child(generation, static_cast<std::uint32_t>(k), child(k), table, end - table.size(), children)) break;
  }
}

void Breeder::make_child(const ParentPool& pool, std::size_t first, std::size_t second, Stream& stream,
                         std::span<double> child) const {
  if (stream.chance(plan_.crossover_probability)) {
    recombine(plan_.crossover, pool, first, second, stream, child);
  } else {
    const auto parent = pool.design(first);
    std::copy(parent.begin(), parent.end(), child.begin());
  }
  for (std::size_t i = 0; i < child.size(); ++i)
    if (stream.chance(plan_.mutation_probability)) child[i] = mutate(plan_.mutation, space_[i], child[i], stream);
  snap_to_space(child);
}

// Appends to `members` the row number that the child has in the evaluation table: a new row or, if an equal design is
// already evaluated, the row of that design. Skips a duplicate that cannot be made unique. Returns false if the child
// needs a new row and `max_new_rows` is 0.
bool Breeder::add_child(std::uint32_t generation, std::uint32_t individual, std::span<double> child,
                        EvaluationTable& table, std::size_t max_new_rows, std::vector<std::int64_t>& members) {
  const std::int64_t known = evaluated_.find(table, child);
  if (known >= 0 && !plan_.unique) {
    members.push_back(known);
    return true;
  }
  if (known >= 0 && !make_unique(generation, individual, child, table)) return true;
  if (max_new_rows == 0) return false;
  const std::size_t row = table.extend(1);
  std::copy(child.begin(), child.end(), table.design(row).begin());
  evaluated_.insert(table, row);
  members.push_back(static_cast<std::int64_t>(row));
  return true;
}

// Changes a child that equals an evaluated design until it is new: mutates one variable at a time and, if this does not
// succeed, draws random designs.
bool Breeder::make_unique(std::uint32_t generation, std::uint32_t individual, std::span<double> child,
                          const EvaluationTable& table) {
  constexpr int kMutationTries = 10, kRandomTries = 10;
  Stream stream(seed_, generation, individual, Stream::Use::retry);
  for (int attempt = 0; attempt < kMutationTries + kRandomTries; ++attempt) {
    if (attempt < kMutationTries) {
      const std::size_t i = stream.below(child.size());
      child[i] = mutate(plan_.mutation, space_[i], child[i], stream);
    } else {
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = space_.from_unit(i, stream.u01());
    }
    snap_to_space(child);
    if (evaluated_.find(table, child) < 0) return true;
  }
  return false;
}

void Breeder::snap_to_space(std::span<double> child) const {
  // Adding zero turns -0 into +0, so that equal designs have equal bits.
  for (std::size_t i = 0; i < child.size(); ++i) child[i] = space_.nearest(i, child[i]) + 0.0;
}

}  // namespace pkm
