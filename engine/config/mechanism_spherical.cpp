// Reads a limb that is a spherical chain: joints, arcs that are drawn, masses.

#include <cmath>

#include "engine/config/mechanism_chains.hpp"
#include "engine/generic/limbs/spherical.hpp"

namespace pkm {
namespace {

using limbs::Term, limbs::Vector3;

constexpr int kSegments = 6;  // straight capsules that approximate an arc

/// A point of an arc, as a unit vector. @param part  0: first end, 1: last end
Vector3 along(const LimbPart::Arc& arc, double part) {
  return (arc.first * sin(arc.angle * (1 - part)) + arc.last * sin(arc.angle * part)) / sin(arc.angle);
}

void add_arc_links(const LimbCopy& copy, const LimbPart& part, const std::string& what, const Term& radius) {
  const LimbPart::Arc& arc = *part.arc;
  for (int k = 0; k < kSegments; ++k) {
    const auto end = [&](int i) {
      return nodes(arc.centre + along(arc, static_cast<double>(i) / kSegments) * arc.radius);
    };
    copy.draft.model.links.push_back(
        {what + " of " + copy.name, copy.name, end(k), end(k + 1), radius.node(), {copy.name}});
  }
}

}  // namespace

void read_spherical_limb(const LimbCopy& copy, const std::string& joint) {
  const Chain& chain = *copy.chain;
  const ConfigValue& table = copy.table;
  MechanismDraft& draft = copy.draft;
  generic::Model& model = draft.model;
  for (const char* const key : {"platform", "end", "end_on", "links", "pair", "play", "joint_base", "joint_platform",
                                "first_link_inertia", "second_link_inertia"})
    if (const auto given = table.find(key)) throw given->refusal(std::string("a spherical chain has no `") + key + "`");
  if (const auto copies = table.find("copies"); copies && copies->is_list())
    throw copies->refusal("a spherical chain is copied by { number = .., about = .. } or { angles = .., about = .. }");

  const Vector3 centre =
      copy.base.at.origin +
      copy.base.at.rotation *
          (copy.turn *
           draft.scope.point_of_design(table.at("base", "the centre of the spherical chain [x, y, z]"), copy.group));
  const ConfigValue list = table.at("axes", "the first axis, in the base's frame, and the last, in the platform's");
  const std::vector<ConfigValue> axes = list.elements("two axes");
  if (axes.size() != 2)
    throw list.error(
        "two axes: the first, in the base's frame, and the last, in the platform's; the axis in the "
        "middle follows from `angles`");
  const ConfigValue zero_value = table.at("zero", "the direction of the first link at q1 = 0, [x, y, z]");
  const Vector3 u = copy.direction(axes[0]), v = copy.direction(axes[1], true), zero = copy.direction(zero_value),
                reference = copy.direction(zero_value, true);
  if (std::fabs(draft.scope.at_default(dot(u, zero))) > 1e-9)
    throw zero_value.refusal("`zero` has to be normal to the first axis");
  const Vector3 in_platform = cross(v, reference);
  if (draft.scope.at_default(dot(in_platform, in_platform)) < 1e-18)
    throw zero_value.refusal("`zero` must not be parallel to the last axis, whose angle is counted to it, too");
  const ConfigValue given = *table.find("angles");
  const std::vector<ConfigValue> both = given.elements("two angles [alpha_1, alpha_2]");
  if (both.size() != 2) throw given.error("two angles [alpha_1, alpha_2]");
  const std::array<Term, 2> alpha = {draft.scope.positive(both[0], "rad", copy.group),
                                     draft.scope.positive(both[1], "rad", copy.group)};
  for (std::size_t i = 0; i < 2; ++i) {
    model.required.push_back(
        {"angles: pi - alpha_" + std::to_string(i + 1), "rad", (Term(model.graph, kPi) - alpha[i]).node()});
    if (draft.scope.at_default(alpha[i]) >= kPi) throw both[i].error("an angle > 0 and < 180 deg");
  }
  const Term q = add_joint_variable(table, joint, "rad", draft);
  const Term branch = limb_branch(copy);
  const limbs::SphericalChain found = limbs::spherical_chain(u, v, zero, reference, alpha, branch, q);
  for (const limbs::Constraint& constraint : found.constraints) {
    model.domains.push_back({copy.name + " " + constraint.name, constraint.unit, constraint.margin.node(),
                             copy.name + " cannot reach the pose"});
    draft.scope.mark_as_defined(constraint.margin.node());
  }
  Term middle = draft.zero();
  if (const auto range = table.find("range")) {
    const auto [from, to] = read_range(*range, "rad", copy.group, draft);
    middle = (from + to) * 0.5;
  }
  ChainJoints joints;
  for (std::size_t k = 0; k < 3; ++k)
    joints.emplace(k, wrapped(found.angles[k], k == chain.driven ? middle : draft.zero()));
  const Term& driven = joints.at(chain.driven);
  draft.scope.mark_as_defined(driven.node());
  for (const Term& element : found.w) draft.scope.mark_as_defined(element.node());
  draft.scope.add(table, joint, driven.node());
  model.joints.push_back(driven.node());
  model.closures.push_back(found.closures[chain.driven].node());
  model.info.closed_forms.push_back("spherical chain R-R-R, joint " + std::to_string(chain.driven + 1) +
                                    " driven: w . v = cos(alpha_2), A cos(q1) + B sin(q1) = C");
  add_range(table, copy.group, joint, "rad", driven, draft);
  name_chain_joints(copy, joints);

  const auto arc_radius = table.find("arc_radius");
  if (!arc_radius)
    for (const std::string& key : table.keys())
      if (key == "radius" || key.starts_with("first_link_") || key.starts_with("second_link_"))
        throw table.find(key)->refusal("`" + key + "` requires `arc_radius`, the radius of the arcs of the links");
  const Term r = arc_radius ? draft.scope.positive(*arc_radius, "m", copy.name) : draft.zero();
  const auto part = [&](const char* name, const Vector3& first, const Vector3& last, const Term& angle) {
    return LimbPart{.name = name,
                    .from = centre + first * r,
                    .to = centre + last * r,
                    .length = angle * r,
                    .arc = LimbPart::Arc{centre, first, last, r, angle}};
  };
  NamedLimb limb{.name = copy.name,
                 .group = copy.group,
                 .points = {{"A", centre + u * r}, {"B", centre + v * r}, {"C", centre + found.w * r}},
                 .parts = {part("first_link", u, found.w, alpha[0]), part("second_link", found.w, v, alpha[1])},
                 .drive = "chain",
                 .joint = model.joints.size() - 1,
                 .axis = u};
  limb.begin_on = copy.base.body;
  limb.end_on = copy.platform.body;
  limb.axes = {u, found.w, v};
  limb.driven = chain.driven;
  for (const auto& [point, place] : limb.points) draft.scope.add_member(copy.name + "." + point, place);
  for (const LimbPart& each : limb.parts) add_part_body(table, copy.name, each, draft);
  if (const auto radius = table.find("radius")) {
    const Term thickness = draft.scope.positive(*radius, "m", copy.name, true);
    add_arc_links(copy, limb.parts[0], "first link", thickness);
    add_arc_links(copy, limb.parts[1], "second link", thickness);
    model.links.push_back({copy.platform.body + "'s arm of " + copy.name,
                           copy.platform.body,
                           nodes(copy.platform.at.origin),
                           nodes(limb.points.at("B")),
                           thickness.node(),
                           {copy.platform.body}});
  }
  draft.limbs.push_back(std::move(limb));
}

}  // namespace pkm
