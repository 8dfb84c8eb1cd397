// Regular subsampling (thinning) of a sequence that is too long to show.
#pragma once

#include <cstddef>
#include <vector>

namespace pkm {

/// Selects from the indices [0, count) every stride-th one, and in addition the first and the last one. The stride is
/// the smallest one that leaves at most `max_count` (>= 2) indices.
struct Thinning {
  std::size_t stride = 1;
  std::vector<std::size_t> indices;

  Thinning(std::size_t count, std::size_t max_count) {
    if (count == 0) return;
    if (count > max_count) stride = (count - 1 + max_count - 2) / (max_count - 1);
    for (std::size_t i = 0; i + 1 < count; i += stride) indices.push_back(i);
    indices.push_back(count - 1);
  }
};

}  // namespace pkm
