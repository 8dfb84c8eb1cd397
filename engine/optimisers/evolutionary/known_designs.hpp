// Which designs a table already holds, so that none is evaluated twice: a hash set over the designs' bits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/problem/evaluation.hpp"

namespace pkm {

class KnownDesigns {
 public:
  /// The row whose design equals `design` bit for bit, or -1. `table` is the one given to `insert`.
  std::int64_t find(const EvaluationTable& table, std::span<const double> design) const;
  /// Begins to fetch what find() will look at, which is seldom in the processor's cache.
  void prefetch(std::span<const double> design) const;
  /// Remembers a row that `find` does not know yet.
  void insert(const EvaluationTable& table, std::size_t row);

 private:
  /// The hash stands beside the row, so that other designs, far apart in memory, are seldom looked at.
  struct Slot {
    std::uint32_t hash = 0, row = kEmpty;
  };
  static constexpr std::uint32_t kEmpty = 0xffffffff;

  /// The first slot from the hash on that is free or for which is_sought(slot).
  template <class Sought>
  std::size_t slot_of(std::uint32_t hash, const Sought& is_sought) const;

  std::vector<Slot> slots_ = std::vector<Slot>(64);  // open addressing, a power of two, at most half full
  std::size_t count_ = 0;
};

}  // namespace pkm
