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
  /// The hash is beside the row: to tell designs apart, and to move rows when there are more slots, takes no look at
  /// the table, most of which is not in the processor's cache.
  struct Slot {
    std::uint64_t hash = 0;
    std::int64_t row = kEmpty;
  };
  static constexpr std::int64_t kEmpty = -1;

  /// Where the design's row is, or will be.
  std::size_t slot_of(const EvaluationTable& table, std::span<const double> design, std::uint64_t hash) const;

  std::vector<Slot> slots_ = std::vector<Slot>(64);  // open addressing, a power of two, at most half full
  std::size_t count_ = 0;
};

}  // namespace pkm
