#include "engine/optimisers/evolutionary/design_hash_set.hpp"

#include <bit>
#include <cstring>
#include <utility>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

std::uint32_t hash_of(std::span<const double> design) {
  std::uint64_t h = design.size();
  for (const double x : design) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  h *= 0x9e3779b97f4a7c15u;
  return static_cast<std::uint32_t>(h ^ h >> 32);
}

}  // namespace

template <class Predicate>
std::size_t DesignHashSet::find_slot(std::uint32_t hash, const Predicate& matches) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = hash & mask;
  while (slots_[i].row != kEmpty && !matches(slots_[i])) i = (i + 1) & mask;
  return i;
}

std::int64_t DesignHashSet::find(const EvaluationTable& table, std::span<const double> design) const {
  const std::uint32_t hash = hash_of(design);
  const Slot& slot = slots_[find_slot(hash, [&](const Slot& known) {
    return known.hash == hash && std::memcmp(table.design(known.row).data(), design.data(), design.size_bytes()) == 0;
  })];
  return slot.row == kEmpty ? -1 : std::int64_t{slot.row};
}

void DesignHashSet::prefetch(std::span<const double> design) const {
  __builtin_prefetch(&slots_[hash_of(design) & (slots_.size() - 1)]);
}

void DesignHashSet::insert(const EvaluationTable& table, std::size_t row) {
  PKM_EXPECTS(row < kEmpty);
  const auto place = [this](const Slot& slot) {
    slots_[find_slot(slot.hash, [](const Slot&) { return false; })] = slot;
  };
  if (2 * ++count_ > slots_.size()) {
    const auto old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& known : old)
      if (known.row != kEmpty) place(known);
  }
  place({hash_of(table.design(row)), static_cast<std::uint32_t>(row)});
}

}  // namespace pkm
