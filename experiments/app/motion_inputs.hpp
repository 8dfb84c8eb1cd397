// The inputs of a mechanism in addition to the pose, and the quantities that depend on them and on the motion.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Values of the option --input, such as "theta=30deg".
struct InputArguments {
  std::vector<std::string> inputs;
};
/// Declares --input.
void add_input_option(CLI::App& command, InputArguments& arguments);

/// Sets the inputs of a sample to the values given by --input, otherwise to the defaults. Throws ConfigError for
/// unknown names.
void set_inputs(const Mechanism& mechanism, const InputArguments& arguments, MotionSample& at);

/// A motion in which the inputs given by --input are constant; all other inputs are those of the original motion.
std::shared_ptr<const Motion> with_given_inputs(const Mechanism& mechanism, std::shared_ptr<const Motion> motion,
                                                const InputArguments& arguments);

/// Adds all quantities to the output under "quantities", and a table of those that depend on inputs or on rates.
void report_quantities(const MechanismInfo& info, const MotionSample& at, const std::vector<double>& values,
                       Printout& out);

}  // namespace pkm
