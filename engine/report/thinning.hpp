// Which of many entries are shown.
#pragma once

#include <cstddef>
#include <vector>

namespace pkm {

/// Every k-th of `count` indices, k the least with which there are at most `most` (>= 2), and always the first and the
/// last.
struct Thinning {
  std::size_t every = 1;
  std::vector<std::size_t> indices;

  Thinning(std::size_t count, std::size_t most) {
    if (count == 0) return;
    if (count > most) every = (count - 1 + most - 2) / (most - 1);
    for (std::size_t i = 0; i + 1 < count; i += every) indices.push_back(i);
    indices.push_back(count - 1);
  }
};

}  // namespace pkm
