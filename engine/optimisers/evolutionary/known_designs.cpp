#include "engine/optimisers/evolutionary/known_designs.hpp"

#include <bit>
#include <cstring>
#include <utility>

namespace pkm {
namespace {

std::uint64_t hash_of(std::span<const double> design) {
  std::uint64_t h = design.size();
  for (const double x : design) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  h *= 0x9e3779b97f4a7c15u;
  return h ^ h >> 32;
}

}  // namespace

std::size_t KnownDesigns::slot_of(const EvaluationTable& table, std::span<const double> design,
                                  std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash & mask;
  const auto is_other = [&](const Slot& slot) {
    if (slot.hash != hash) return true;
    const auto known = table.design(static_cast<std::size_t>(slot.row));
    return std::memcmp(known.data(), design.data(), design.size_bytes()) != 0;
  };
  while (slots_[i].row != kEmpty && is_other(slots_[i])) i = (i + 1) & mask;
  return i;
}

std::int64_t KnownDesigns::find(const EvaluationTable& table, std::span<const double> design) const {
  return slots_[slot_of(table, design, hash_of(design))].row;
}

void KnownDesigns::prefetch(std::span<const double> design) const {
  __builtin_prefetch(&slots_[hash_of(design) & (slots_.size() - 1)]);
}

void KnownDesigns::insert(const EvaluationTable& table, std::size_t row) {
  if (2 * ++count_ > slots_.size()) {
    const auto old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    const std::size_t mask = slots_.size() - 1;
    for (const Slot& known : old) {
      if (known.row == kEmpty) continue;
      std::size_t i = known.hash & mask;
      while (slots_[i].row != kEmpty) i = (i + 1) & mask;
      slots_[i] = known;
    }
  }
  const auto design = table.design(row);
  const std::uint64_t hash = hash_of(design);
  slots_[slot_of(table, design, hash)] = {hash, static_cast<std::int64_t>(row)};
}

}  // namespace pkm
