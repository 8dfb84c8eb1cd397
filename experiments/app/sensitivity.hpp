// Sensitivity analysis of one design: derivatives of objectives and margins with respect to the parameters, and the
// first-order worst case for parameters within tolerances.
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

/// Reports what the arguments request. Throws ConfigError if the problem has no derivatives.
/// @param report  evaluation of the design
void report_sensitivities(const DesignProblem& problem, const DesignReport& report,
                          const SensitivityArguments& arguments, Printout& out);

}  // namespace pkm
