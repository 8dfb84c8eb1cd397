// Hash set of the designs of an evaluation table, compared bit by bit, so that no design is evaluated twice.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/problem/evaluation.hpp"

namespace pkm {

class DesignHashSet {
 public:
  /// Number of the row whose design equals `design` bit for bit; -1: none. `table` is the table passed to `insert`.
  std::int64_t find(const EvaluationTable& table, std::span<const double> design) const;
  /// Prefetches the hash slot that find(design) will read, which is rarely in the processor's cache.
  void prefetch(std::span<const double> design) const;
  /// Inserts a row of the evaluation table, whose design must not be in the set yet.
  void insert(const EvaluationTable& table, std::size_t row);

 private:
  /// A row of the evaluation table and the hash of its design. Comparing hashes first avoids most comparisons of
  /// designs, which are far apart in memory.
  struct Slot {
    std::uint32_t hash = 0, row = kEmpty;
  };
  static constexpr std::uint32_t kEmpty = 0xffffffff;

  /// Index of the first slot that is empty or satisfies matches(slot), found by linear probing from the slot of `hash`.
  template <class Predicate>
  std::size_t find_slot(std::uint32_t hash, const Predicate& matches) const;

  // Open addressing; the number of slots is a power of two, and at most half of them are in use.
  std::vector<Slot> slots_ = std::vector<Slot>(64);
  std::size_t count_ = 0;
};

}  // namespace pkm
