// Space-filling samples of the unit cube for initial designs: scrambled Sobol sequence, Latin hypercube, random.
#pragma once

#include <cstdint>
#include <vector>

namespace pkm {

enum class Start {
  sobol,            ///< Sobol sequence with random linear scrambling and digital shift (Matousek 1998); variables
                    ///< beyond the 21st are sampled by a Latin hypercube
  latin_hypercube,  ///< the range of each variable is divided into `count` equal strata, each of which contains one
                    ///< point
  random            ///< independent random designs, uniformly distributed in the ranges of the variables
};

/// Samples the unit cube. A larger Sobol sample begins with the points of a smaller one of the same seed.
/// @return count x dimension coordinates in [0, 1), row by row
std::vector<double> unit_cube_samples(Start start, std::size_t count, std::size_t dimension, std::uint64_t seed);

}  // namespace pkm
