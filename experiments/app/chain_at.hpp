// The auxiliary chain of a mechanism at a pose, by its input or its output angle.
#pragma once

#include <optional>
#include <string>

#include "experiments/app/target.hpp"

namespace pkm {

struct ChainArguments {
  std::string theta, gamma, zeta;
};
/// Declares --theta, --gamma and --zeta.
void add_chain_options(CLI::App& command, ChainArguments& arguments);

/// With the motion of its input.
struct ChainAt {
  Turning input;
  double zeta;
  ChainReport report;
};

/// None where the mechanism has no chain. Throws ConfigError where an angle of one is given all the same.
std::optional<ChainAt> chain_at(const Target& target, const ChainArguments& arguments, MotionSample at);

void tell_chain(const AuxiliaryChain& names, const ChainAt& at, Printout& out);

}  // namespace pkm
