// How a design's objectives and margins change with its parameters, and how bad tolerances of these may be.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

struct SensitivityArguments {
  bool sensitivity = false;
  std::vector<std::string> tolerance;
};
/// Declares --sensitivity and --tolerance.
void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments);

/// Tells what is asked for, of a design that was evaluated. Throws ConfigError where the problem has no derivatives.
void tell_sensitivities(const DesignProblem& problem, const DesignReport& report, const SensitivityArguments& arguments,
                        Printout& out);

}  // namespace pkm
