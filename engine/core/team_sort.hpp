// Parallel merge sort on a thread team.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <vector>

#include "engine/core/team.hpp"

namespace pkm {

/// Sorts the elements from index `first` to the end. The result does not depend on the number of threads, provided that
/// no two elements are equivalent under `less`.
template <class T, class Less = std::less<>>
void parallel_sort(std::vector<T>& all, std::size_t first = 0, const Less& less = {}) {
  constexpr std::size_t kMinRunSize = 5000;  // minimum number of elements that a thread sorts
  const std::size_t count = all.size() - first;
  const std::size_t runs = has_team() ? std::bit_floor(std::min(workers(), count / kMinRunSize)) : 0;
  const auto begin_of = [&](std::size_t run) {
    return all.begin() + static_cast<std::ptrdiff_t>(first + run * count / std::max<std::size_t>(runs, 1));
  };
  if (runs < 2) return std::sort(begin_of(0), all.end(), less);
  parallel_for(runs, [&](std::size_t begin, std::size_t end) {
    for (std::size_t run = begin; run < end; ++run) std::sort(begin_of(run), begin_of(run + 1), less);
  });
  for (std::size_t half = 1; half < runs; half *= 2)
    parallel_for(runs / (2 * half), [&](std::size_t begin, std::size_t end) {
      for (std::size_t run = 2 * half * begin; run < 2 * half * end; run += 2 * half)
        std::inplace_merge(begin_of(run), begin_of(run + half), begin_of(run + 2 * half), less);
    });
}

}  // namespace pkm
