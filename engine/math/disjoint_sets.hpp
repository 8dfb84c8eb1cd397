// Disjoint sets of the integers below a count (union-find with path halving). The root of a set is its smallest
// element.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace pkm {

class DisjointSets {
 public:
  /// Sets of one element each. @param count  at most 2^32
  explicit DisjointSets(std::size_t count = 0) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::size_t root(std::size_t element) {
    while (parent_[element] != element) {
      parent_[element] = parent_[parent_[element]];
      element = parent_[element];
    }
    return element;
  }
  void unite(std::size_t a, std::size_t b) {
    const auto [lower, upper] = std::minmax({root(a), root(b)});
    parent_[upper] = static_cast<std::uint32_t>(lower);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace pkm
