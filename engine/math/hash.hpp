// Hashes that tell structures apart; nothing that is stored depends on them.
#pragma once

#include <cstdint>

namespace pkm {

/// FNV-1a, a word at a time.
class Fnv1a {
 public:
  void add(std::uint64_t word) { value_ = (value_ ^ word) * 1099511628211u; }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace pkm
