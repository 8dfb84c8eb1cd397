#include "engine/problem/start_outcome.hpp"

#include <array>

namespace pkm {

std::string_view words(StopReason reason) {
  static constexpr std::array<std::string_view, 10> kWords = {
      // The words are in the order of the enumerators of StopReason.
      "generation limit", "evaluation limit",       "target reached", "no further improvement",
      "converged",        "every design evaluated", "interrupted",    "time limit",
      "failed",           "every start has ended"};
  return kWords[static_cast<std::size_t>(reason)];
}

}  // namespace pkm
