#include "experiments/app/chain_at.hpp"

#include "engine/setup/assignments.hpp"
#include "experiments/app/axes.hpp"

namespace pkm {
namespace {

double chain_angle(const Mechanism& mechanism, const std::string& text, const std::string& option) {
  if (text.empty()) return 0;
  if (!mechanism.chain())
    throw ConfigError({"", 0, option}, "mechanism " + mechanism.info().name + " has no auxiliary chain");
  return parse_number(text, option, "rad");
}

}  // namespace

void add_chain_options(CLI::App& command, ChainArguments& arguments) {
  add_option(command, "--theta ANGLE", arguments.theta, "Input angle of an auxiliary chain; default 0");
  add_option(command, "--gamma ANGLE", arguments.gamma, "Its output angle instead: the input follows");
  add_option(command, "--zeta ANGLE", arguments.zeta, "Phase of its forks; default 0");
}

std::optional<ChainAt> chain_at(const Target& target, const ChainArguments& arguments, MotionSample at) {
  if (!arguments.theta.empty() && !arguments.gamma.empty())
    throw ConfigError({"", 0, "--gamma"}, "the chain's input follows from its output; give --theta or --gamma");
  at.input.angle = chain_angle(*target.mechanism, arguments.theta, "--theta");
  const double zeta = chain_angle(*target.mechanism, arguments.zeta, "--zeta");
  const double gamma = chain_angle(*target.mechanism, arguments.gamma, "--gamma");
  const AuxiliaryChain* const chain = target.mechanism->chain();
  if (!chain) return {};
  if (!arguments.gamma.empty()) at.input.angle = chain->input_for(target.parameters, at.pose, gamma, zeta).value_or(0);
  return ChainAt{at.input, zeta, chain->report(target.parameters, at, zeta)};
}

void tell_chain(const AuxiliaryChain& names, const ChainAt& at, Printout& out) {
  const ChainReport& chain = at.report;
  const Turning& turning = chain.output;
  const std::string in = names.input(), name = names.output();
  const auto found = [&chain](const Json& value) { return chain.turns ? value : Json(); };
  out.json["angles"][name] = found(turning.angle);
  out.json["chain"] = {{in, at.input.angle},
                       {"zeta", at.zeta},
                       {"reason", chain.turns ? Json() : Json(chain.reason)},
                       {name, found(turning.angle)},
                       {name + "_speed", found(turning.speed)},
                       {name + "_acceleration", found(turning.acceleration)},
                       {"omega", found(chain.spin.velocity.m)},
                       {"alpha", found(chain.spin.acceleration.m)},
                       {"gradient", found(vector_json(chain.influence.gradient))},
                       {"hessian", found(matrix_json(chain.influence.hessian))}};
  if (chain.turns)
    out.section("auxiliary chain", {{in, position(at.input.angle, "rad")},
                                    {name, position(turning.angle, "rad")},
                                    {"speed", number(turning.speed, "rad/s")},
                                    {"acceleration", number(turning.acceleration, "rad/s^2")}});
  else
    out.text += '\n' + name + " does not exist: " + chain.reason + '\n';
}

}  // namespace pkm
