#include "engine/optimisers/evolutionary/breeding.hpp"

#include <algorithm>

#include "engine/core/team.hpp"

namespace pkm {

void Breeder::start(const std::vector<StartDesign>& given, EvaluationTable& table, std::size_t most_new,
                    std::vector<std::int64_t>& members) {
  members.clear();
  const std::size_t count = plan_.population, n = space_.dimension();
  const std::vector<double> points = start_points(plan_.start, count, n, seed_);
  std::vector<double> child(n);
  for (std::size_t k = 0; k < count; ++k) {
    if (k < given.size()) {
      std::ranges::copy(given[k].design, child.begin());
    } else {
      for (std::size_t i = 0; i < n; ++i) child[i] = space_.from_unit(i, points[k * n + i]);
    }
    move_into_space(child);
    if (!add(0, static_cast<std::uint32_t>(k), child, table, most_new, members)) break;
  }
}

void Breeder::offspring(std::uint32_t generation, std::span<const std::int64_t> parents, std::size_t count,
                        EvaluationTable& table, std::size_t most_new, std::vector<std::int64_t>& children) {
  children.clear();
  parents_.resize(2 * count);
  Stream choices(seed_, generation, 0, Stream::Use::selection);
  select_parents(plan_.selection, parents.size(), choices, parents_);
  pool_.clear();  // a copy side by side: the table's rows lie far apart
  for (const std::int64_t row : parents) {
    const auto design = table.design(static_cast<std::size_t>(row));
    pool_.insert(pool_.end(), design.begin(), design.end());
  }
  const std::size_t n = space_.dimension();
  const Pool pool{pool_, n};
  children_.resize(count * n);
  const auto child = [&](std::size_t k) { return std::span(children_).subspan(k * n, n); };
  const auto breed_some = [&](std::size_t begin, std::size_t stop) {
    for (std::size_t k = begin; k < stop; ++k) {
      Stream stream(seed_, generation, static_cast<std::uint32_t>(k), Stream::Use::variation);
      breed(pool, parents_[2 * k], parents_[2 * k + 1], stream, child(k));
    }
  };
  constexpr std::size_t kWorthSharing = 1000;  // children, some 0.2 us each
  if (count < kWorthSharing)
    breed_some(0, count);
  else
    share_pieces(count, breed_some);
  const std::size_t end = table.size() + most_new;
  constexpr std::size_t kAhead = 8;
  for (std::size_t k = 0; k < count; ++k) {
    if (k + kAhead < count) known_.prefetch(child(k + kAhead));
    if (!add(generation, static_cast<std::uint32_t>(k), child(k), table, end - table.size(), children)) break;
  }
}

void Breeder::breed(const Pool& pool, std::size_t first, std::size_t second, Stream& stream,
                    std::span<double> child) const {
  if (stream.chance(plan_.crossover_probability)) {
    cross(plan_.crossover, pool, first, second, stream, child);
  } else {
    const auto parent = pool.design(first);
    std::copy(parent.begin(), parent.end(), child.begin());
  }
  for (std::size_t i = 0; i < child.size(); ++i)
    if (stream.chance(plan_.mutation_probability)) child[i] = mutated(plan_.mutation, space_[i], child[i], stream);
  move_into_space(child);
}

// Appends the child or finds that it is known. False: no room for it, and none for what comes after it.
bool Breeder::add(std::uint32_t generation, std::uint32_t individual, std::span<double> child, EvaluationTable& table,
                  std::size_t most_new, std::vector<std::int64_t>& members) {
  const std::int64_t known = known_.find(table, child);
  if (known >= 0 && !plan_.unique) {
    members.push_back(known);
    return true;
  }
  if (known >= 0 && !renew(generation, individual, child, table)) return true;
  if (most_new == 0) return false;
  const std::size_t row = table.extend(1);
  std::copy(child.begin(), child.end(), table.design(row).begin());
  known_.insert(table, row);
  members.push_back(static_cast<std::int64_t>(row));
  return true;
}

// Changes the child until it is new: one variable at a time first, then any design of the space.
bool Breeder::renew(std::uint32_t generation, std::uint32_t individual, std::span<double> child,
                    const EvaluationTable& table) {
  constexpr int kMutations = 10, kAnywhere = 10;
  Stream stream(seed_, generation, individual, Stream::Use::retry);
  for (int attempt = 0; attempt < kMutations + kAnywhere; ++attempt) {
    if (attempt < kMutations) {
      const std::size_t i = stream.below(child.size());
      child[i] = mutated(plan_.mutation, space_[i], child[i], stream);
    } else {
      for (std::size_t i = 0; i < child.size(); ++i) child[i] = space_.from_unit(i, stream.u01());
    }
    move_into_space(child);
    if (known_.find(table, child) < 0) return true;
  }
  return false;
}

void Breeder::move_into_space(std::span<double> child) const {
  // Adding zero turns -0 into +0, so that equal designs have equal bits.
  for (std::size_t i = 0; i < child.size(); ++i) child[i] = space_.nearest(i, child[i]) + 0.0;
}

}  // namespace pkm
