// [[limb]] with drive = "formula": joints that are formulas of the pose.

#include "engine/setup/mechanism_limb.hpp"

namespace pkm {

using limbs::Term;

namespace {

void read_joint(const ConfigValue& table, const std::string& limb, const std::string& name, const ConfigValue& text,
                const std::string& unit, MechanismDraft& draft) {
  described::Model& model = draft.model;
  const Term q = add_joint_variable(table, name, unit, draft), joint = draft.scope.formula(text, unit, name);
  model.joints.push_back(joint.node());
  model.closures.push_back((joint - q).node());
  model.info.closed_forms.push_back("formula: " + text.text("a formula").substr(0, 80));
  model.defined.push_back(model.graph.apply(graph::operation("*"), std::array{joint.node(), draft.zero().node()}));
  draft.scope.add(text, name, joint.node());
  add_range(table, limb, name, unit, joint, draft);
}

}  // namespace

void read_formula_limb(const ConfigValue& table, const std::string& name, MechanismDraft& draft) {
  const auto given = table.find("unit");
  const std::string unit = given ? given->word({"m", "rad"}) : "m";
  const auto joints = table.find("joints");
  if (joints && table.has("joint")) throw joints->refusal("a limb has `joint` or `joints`, not both");
  if (!joints) {
    read_joint(table, name, name, table.at("joint", "the joint's formula, or joints = { q1 = .., .. }"), unit, draft);
  } else {
    joints->expect_table("a table { q1 = formula, .. }");
    if (joints->keys().empty()) throw joints->error("at least one joint");
    for (const std::string& joint : joints->keys()) read_joint(table, name, joint, *joints->find(joint), unit, draft);
  }
  draft.limbs.push_back({.name = name, .group = name, .points = {}, .parts = {}});
  draft.reaches.emplace_back();
}

}  // namespace pkm
