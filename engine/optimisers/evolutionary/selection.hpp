// Who becomes a parent. Selection sees only the order of preference in a population (index 0 is the best), so it
// serves one objective and several alike.
#pragma once

#include <cstdint>
#include <span>

#include "engine/math/random.hpp"

namespace pkm {

struct Selection {
  enum class Kind {
    tournament,     ///< the best of `tournament_size` members drawn at random
    linear_ranking  ///< fitness falls linearly with the rank; drawn by stochastic universal sampling (Baker 1987)
  };
  Kind kind = Kind::tournament;
  std::int64_t tournament_size = 2;
  double pressure = 2;  ///< linear ranking: expected share of the best relative to the average, in [1, 2]
};

/// Fills `parents` with indices in [0, population).
void select_parents(const Selection& selection, std::size_t population, Stream& stream,
                    std::span<std::uint32_t> parents);

}  // namespace pkm
