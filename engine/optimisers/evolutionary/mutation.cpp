#include "engine/optimisers/evolutionary/mutation.hpp"

#include "engine/math/portable.hpp"

namespace pkm {
namespace {

double polynomial_step(double eta, double u) {
  const double power = 1 / (eta + 1);
  return u < 0.5 ? portable::pow(2 * u, power) - 1 : 1 - portable::pow(2 * (1 - u), power);
}

}  // namespace

double mutated(const Mutation& mutation, const Variable& variable, double value, Stream& stream) {
  constexpr double kLog10000 = 9.210340371976182736;
  const double range = variable.upper - variable.lower;
  switch (mutation.kind) {
    case Mutation::Kind::multiscale: {
      const double sigma = mutation.sigma * portable::exp(-kLog10000 * stream.u01());
      return value + sigma * stream.normal() * range;
    }
    case Mutation::Kind::gaussian:
      return value + mutation.sigma * stream.normal() * range;
    case Mutation::Kind::polynomial:
      return value + polynomial_step(mutation.eta, stream.u01()) * range;
    case Mutation::Kind::uniform:
      break;
  }
  return variable.lower + stream.u01() * range;
}

}  // namespace pkm
