#include "engine/config/mechanism_limb.hpp"

#include <stdexcept>

namespace pkm {

using generic::Inputs;
using limbs::Term, limbs::Vector3;

Term LimbCopy::length(const char* key, const char* expected) const {
  return draft.scope.positive(table.at(key, expected), "m", group);
}

Vector3 LimbCopy::direction(const ConfigValue& value, bool on_platform) const {
  const Vector3 turned = turn * draft.scope.direction(value, group);
  return (on_platform ? platform : base).at.rotation * turned;
}

std::array<Term, 2> LimbCopy::range(const std::string& unit) const {
  return read_range(*table.find("range"), unit, group, draft);
}

std::array<Term, 2> LimbCopy::links() const {
  const ConfigValue links = *table.find("links");
  const auto lengths = links.elements("two lengths [l_1, l_2]");
  if (lengths.size() != 2) throw links.error("two lengths [l_1, l_2]");
  const Term l_1 = draft.scope.positive(lengths[0], "m", group), l_2 = draft.scope.positive(lengths[1], "m", group);
  return {l_1, l_2};
}

Term add_joint_variable(const ConfigValue& table, const std::string& name, const std::string& unit,
                        MechanismDraft& draft) {
  generic::Model& model = draft.model;
  if (model.inputs.joints == kMaxJoints)
    throw table.refusal("a mechanism has at most " + std::to_string(kMaxJoints) + " joints");
  model.info.joints.push_back({name, unit});
  const auto stiffness = table.find("drive_stiffness");
  draft.drive_stiffness.push_back(
      stiffness ? std::optional(draft.scope.positive(*stiffness, unit == "rad" ? "N m/rad" : "N/m", name))
                : std::nullopt);
  return model.term(model.graph.input(model.inputs.joint(model.inputs.joints++), Inputs::kJoints));
}

std::array<Term, 2> read_range(const ConfigValue& range, const std::string& unit, const std::string& limb,
                               MechanismDraft& draft) {
  constexpr const char* kExpected = "two numbers or formulas [minimum, maximum]";
  const auto ends = range.elements(kExpected);
  if (ends.size() != 2) throw range.error(kExpected);
  const Term from = draft.scope.of_design(ends[0], unit, limb), to = draft.scope.of_design(ends[1], unit, limb);
  draft.scope.refuse_empty(range, from, to);
  return {from, to};
}

void add_range(const ConfigValue& table, const std::string& limb, const std::string& joint, const std::string& unit,
               const Term& q, MechanismDraft& draft) {
  const auto range = table.find("range");
  if (!range) return;
  const auto [from, to] = read_range(*range, unit, limb, draft);
  draft.model.ranges.push_back({joint, unit, from.node(), to.node()});
  draft.model.margins.push_back({joint + " min", unit, (q - from).node()});
  draft.model.margins.push_back({joint + " max", unit, (to - q).node()});
}

Term MechanismDraft::add_sign(char first, bool both) {
  const Term sign = model.term(model.graph.input(model.inputs.sign(model.inputs.signs), Inputs::kDesign));
  if (model.inputs.signs == Inputs::kMaxSigns)
    throw std::invalid_argument("a mechanism has at most " + std::to_string(Inputs::kMaxSigns) +
                                " signs of its working modes");
  ++model.inputs.signs;
  SignChoice choice{.signs = std::string(1, first)};
  if (both) choice.signs += first == '+' ? '-' : '+';
  for (const char each : choice.signs) choice.names.emplace_back(1, each);
  sign_choices.push_back(std::move(choice));
  return sign;
}

}  // namespace pkm
