// Hashes that tell structures apart; nothing that is stored depends on them.
#pragma once

#include <cstdint>

namespace pkm {

/// FNV-1a, a word at a time. What it ends with is mixed as MurmurHash3 does: sums of it tell apart what was added
/// together from what was added crosswise.
class Fnv1a {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 1099511628211u; }
  std::uint64_t value() const {
    std::uint64_t mixed = (value_ ^ value_ >> 33U) * 0xff51afd7ed558ccdu;
    mixed = (mixed ^ mixed >> 33U) * 0xc4ceb9fe1a85ec53u;
    return mixed ^ mixed >> 33U;
  }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace pkm
