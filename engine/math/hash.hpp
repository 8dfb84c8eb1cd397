// 64-bit hash for comparing data structures within one run, such as combinatorial types. Stored data do not depend on
// the hash.
#pragma once

#include <cstdint>

namespace pkm {

/// FNV-1a hash of a sequence of 64-bit words (instead of bytes), with the finaliser of MurmurHash3. Because of the
/// finaliser, sums of hashes can represent unordered sets: those of {(1, a), (2, b)} and {(1, b), (2, a)} differ.
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
