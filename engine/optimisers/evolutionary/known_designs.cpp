#include "engine/optimisers/evolutionary/known_designs.hpp"

#include <bit>
#include <cstring>

#include "engine/core/error.hpp"

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

std::int64_t KnownDesigns::find(const EvaluationTable& table, std::span<const double> design) const {
  if (slots_.empty()) return -1;
  const std::uint32_t hash = hash_of(design);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = hash & mask; slots_[i].row != kEmpty; i = (i + 1) & mask) {
    if (slots_[i].hash != hash) continue;
    const auto known = table.design(slots_[i].row);
    if (std::memcmp(known.data(), design.data(), design.size_bytes()) == 0) return slots_[i].row;
  }
  return -1;
}

void KnownDesigns::insert(const EvaluationTable& table, std::size_t row) {
  PKM_EXPECTS(row < kEmpty);
  if (2 * (count_ + 1) > slots_.size()) grow();
  place({hash_of(table.design(row)), static_cast<std::uint32_t>(row)});
  ++count_;
}

void KnownDesigns::place(Slot slot) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = slot.hash & mask;
  while (slots_[i].row != kEmpty) i = (i + 1) & mask;
  slots_[i] = slot;
}

void KnownDesigns::grow() {
  std::vector<Slot> old(slots_.empty() ? 64 : 2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old)
    if (slot.row != kEmpty) place(slot);
}

}  // namespace pkm
