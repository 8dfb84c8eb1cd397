#include "experiments/app/motion_inputs.hpp"

#include "engine/config/assignments.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

/// For each input of the mechanism, the value that --input gives; std::nullopt if it gives none.
std::vector<std::optional<double>> given_inputs(const Mechanism& mechanism, const InputArguments& arguments) {
  const MechanismInfo& info = mechanism.info();
  if (info.inputs.empty() && !arguments.inputs.empty())
    throw ConfigError({"", 0, "--input"}, "mechanism " + info.name + " has no inputs besides the pose");
  std::vector<Assignable> known;
  for (const InputInfo& input : info.inputs) known.push_back({input.name, input.unit});
  return parse_assignments(arguments.inputs, "--input", known);
}

}  // namespace

void add_input_option(CLI::App& command, InputArguments& arguments) {
  add_list_option(command, "--input", arguments.inputs,
                  "Values of the mechanism's inputs besides the pose, on which its quantities depend");
}

void set_inputs(const Mechanism& mechanism, const InputArguments& arguments, MotionSample& at) {
  const auto given = given_inputs(mechanism, arguments);
  at.inputs.resize(given.size());
  for (std::size_t i = 0; i < given.size(); ++i)
    at.inputs[i].value = given[i].value_or(mechanism.info().inputs[i].value);
}

std::shared_ptr<const Motion> with_given_inputs(const Mechanism& mechanism, std::shared_ptr<const Motion> motion,
                                                const InputArguments& arguments) {
  const auto given = given_inputs(mechanism, arguments);
  if (arguments.inputs.empty()) return motion;
  MotionSample defaults;
  set_inputs(mechanism, {}, defaults);
  const auto at = [motion, given, defaults](double time) {
    MotionSample sample = motion->at(time);
    if (sample.inputs.empty()) sample.inputs = defaults.inputs;
    for (std::size_t i = 0; i < given.size(); ++i)
      if (given[i]) sample.inputs[i] = {.value = *given[i]};
    return sample;
  };
  return std::make_shared<const Motion>(motion->duration(), at, [motion](TimeGraph& to) { return motion->write(to); });
}

void report_quantities(const MechanismInfo& info, const MotionSample& at, const std::vector<double>& values,
                       Printout& out) {
  out.json["quantities"] = values_by_name(pose_quantities_of(info, values));
  std::vector<Row> rows;
  for (std::size_t i = 0; i < at.inputs.size(); ++i)
    rows.push_back({info.inputs[i].name, number(at.inputs[i].value, info.inputs[i].unit)});
  for (std::size_t i = 0; i < values.size(); ++i)
    if (info.quantities[i].of_motion)
      rows.push_back(
          {info.quantities[i].name, std::isnan(values[i]) ? "undefined" : number(values[i], info.quantities[i].unit)});
  out.add_table("inputs, and quantities of the motion", rows);
}

}  // namespace pkm
