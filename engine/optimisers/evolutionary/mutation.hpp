// Small and large accidents of one variable. Steps are fractions of the variable's range [lower, upper]; what leaves
// it is moved to the nearest bound by the caller.
#pragma once

#include "engine/core/parameter.hpp"
#include "engine/math/random.hpp"

namespace pkm {

struct Mutation {
  enum class Kind {
    multiscale,  ///< normal, its deviation sigma 10^(-4 u), u uniform in [0, 1): coarse and fine steps equally often
    gaussian,    ///< normal with deviation sigma
    polynomial,  ///< Deb & Goyal 1996, index `eta`
    uniform      ///< any value of the range
  };
  Kind kind = Kind::multiscale;
  double sigma = 0.3;
  double eta = 20;
};

double mutated(const Mutation& mutation, const Variable& variable, double value, Stream& stream);

}  // namespace pkm
