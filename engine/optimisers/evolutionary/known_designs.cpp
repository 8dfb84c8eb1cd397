#include "engine/optimisers/evolutionary/known_designs.hpp"

#include <bit>
#include <cstring>
#include <utility>

namespace pkm {
namespace {

std::uint32_t hash_of(std::span<const double> design) {
  std::uint64_t h = design.size();
  for (const double x : design) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return static_cast<std::uint32_t>(h * 0x9e3779b97f4a7c15u >> 32);
}

}  // namespace

std::size_t KnownDesigns::slot_of(const EvaluationTable& table, std::span<const double> design) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash_of(design) & mask;
  const auto is_other = [&](std::int64_t row) {
    const auto known = table.design(static_cast<std::size_t>(row));
    return std::memcmp(known.data(), design.data(), design.size_bytes()) != 0;
  };
  while (slots_[i] != kEmpty && is_other(slots_[i])) i = (i + 1) & mask;
  return i;
}

std::int64_t KnownDesigns::find(const EvaluationTable& table, std::span<const double> design) const {
  return slots_[slot_of(table, design)];
}

void KnownDesigns::insert(const EvaluationTable& table, std::size_t row) {
  if (2 * ++count_ > slots_.size()) {
    const auto old = std::exchange(slots_, std::vector(2 * slots_.size(), kEmpty));
    for (const std::int64_t known : old)
      if (known != kEmpty) slots_[slot_of(table, table.design(static_cast<std::size_t>(known)))] = known;
  }
  slots_[slot_of(table, table.design(row))] = static_cast<std::int64_t>(row);
}

}  // namespace pkm
