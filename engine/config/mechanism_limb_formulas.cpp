// Reads a [[limb]] with drive = "formula", whose joint coordinates are formulas of the pose.

#include "engine/config/mechanism_limb.hpp"

namespace pkm {

using limbs::Term;

namespace {

struct JointVariable {
  std::string name;
  Term q;
};

/// Reads a joint and adds its loop-closure equation `formula - q`.
JointVariable read_joint(const ConfigValue& table, const std::string& limb, const std::string& name,
                         const ConfigValue& text, const std::string& unit, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const Term q = add_joint_variable(table, name, unit, draft), joint = draft.scope.formula(text, unit, name);
  model.joints.push_back(joint.node());
  model.closures.push_back((joint - q).node());
  model.info.closed_forms.push_back("formula: " + text.text("a formula").substr(0, 80));
  model.defined.push_back(model.graph.apply(expression::operation("*"), std::array{joint.node(), draft.zero().node()}));
  draft.scope.add(text, name, joint.node());
  add_range(table, limb, name, unit, joint, draft);
  return {name, q};
}

/// Reads the loop-closure equations of a limb, in which the names of its joints are variables. They replace the default
/// equations q = f(pose), which cannot show serial singularities: their Jacobian Jq with respect to the joints is
/// constant, and only G, the one with respect to the pose, varies.
void replace_closures(const ConfigValue& list, const std::vector<JointVariable>& joints, MechanismDraft& draft) {
  const std::string expected = "a list of as many formulas as the limb has joints, " + std::to_string(joints.size());
  const auto closures = list.elements(expected);
  if (closures.size() != joints.size()) throw list.error(expected);
  const auto usual = draft.scope.meanings();
  for (const JointVariable& joint : joints) draft.scope.replace(joint.name, joint.q.node());
  std::vector<expression::Node>& all = draft.model.closures;
  all.resize(all.size() - joints.size());
  for (const ConfigValue& closure : closures) all.push_back(draft.scope.formula(closure, "1", "a closure").node());
  draft.scope.restore(usual);
}

}  // namespace

void read_formula_limb(const ConfigValue& table, const std::string& name, MechanismDraft& draft) {
  const std::string unit = table.word_at("unit");
  const auto joints = table.find_table("joints");
  if (joints && table.has("joint")) throw joints->refusal("a limb has `joint` or `joints`, not both");
  std::vector<JointVariable> variables;
  if (!joints) {
    variables.push_back(read_joint(table, name, name,
                                   table.at("joint", "the joint's formula, or joints = { q1 = .., .. }"), unit, draft));
  } else {
    if (joints->keys().empty()) throw joints->error("at least one joint");
    for (const std::string& joint : joints->keys())
      variables.push_back(read_joint(table, name, joint, *joints->find(joint), unit, draft));
  }
  if (const auto closures = table.find("closures")) replace_closures(*closures, variables, draft);
  draft.limbs.push_back({.name = name,
                         .group = name,
                         .points = {},
                         .parts = {},
                         .joint = draft.model.joints.size() - variables.size(),
                         .joint_count = variables.size()});
}

}  // namespace pkm
