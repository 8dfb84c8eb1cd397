// The inputs of a mechanism besides the pose, and the quantities that depend on them and on the motion.
#pragma once

#include <string>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Values of the option --input: "theta=30deg".
struct InputArguments {
  std::vector<std::string> inputs;
};
/// Declares --input.
void add_input_option(CLI::App& command, InputArguments& arguments);

/// Sets the values of a sample's inputs: those of --input, else the defaults. Throws ConfigError for unknown names.
void set_inputs(const Mechanism& mechanism, const InputArguments& arguments, MotionSample& at);

/// A motion whose inputs have constant values where --input gives them; else they are those of the motion.
std::shared_ptr<const Motion> with_given_inputs(const Mechanism& mechanism, std::shared_ptr<const Motion> motion,
                                                const InputArguments& arguments);

/// Adds "quantities" to the output, and a table of those that depend on inputs or rates.
void report_quantities(const MechanismInfo& info, const MotionSample& at, const std::vector<double>& values,
                       Printout& out);

}  // namespace pkm
