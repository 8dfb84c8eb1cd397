// Where a search begins: designs that cover the space evenly.
#pragma once

#include <cstdint>
#include <vector>

namespace pkm {

enum class Start {
  sobol,            ///< Sobol points with a random linear scramble and shift (Matousek 1998); variables beyond the
                    ///< 21st take Latin hypercube values
  latin_hypercube,  ///< every one of `count` equal slices of every variable holds one point
  random            ///< independent and uniform
};

/// `count` x `dimension` unit coordinates in [0, 1), row by row. The first Sobol points of a larger count are those
/// of a smaller one.
std::vector<double> start_points(Start start, std::size_t count, std::size_t dimension, std::uint64_t seed);

}  // namespace pkm
