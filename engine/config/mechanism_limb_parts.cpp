// Computes the parts of a limb in closed form, the links that are drawn, and the reach of the limb.

#include "engine/config/mechanism_limb.hpp"

namespace pkm {

using limbs::Ends, limbs::Term, limbs::Vector3;

std::vector<std::string> parts_of_limb(const ConfigValue& table, const std::string& drive) {
  if (drive == "chain") {
    if (table.has("angles")) return {"first_link", "second_link"};
    return {"cylinder",   "piston",      "crank", "slider",
            "first_link", "second_link", "rod"};  // those of all drives, for which chains are rewritten
  }
  if (drive == "telescope") return {"cylinder", "piston"};
  if (drive == "crank") return {"crank", "rod"};
  if (table.has("links")) return {"slider", "first_link", "second_link"};
  if (table.has("rod")) return {"slider", "rod"};
  return {"slider"};
}

std::vector<LimbPart> read_parts(const LimbCopy& copy, const Ends& at, const DrivenLimb& limb) {
  if (copy.drive == "telescope") {
    const Vector3 v = at.B - limb.C, leg = at.across ? v - *at.across * dot(v, *at.across) : v;
    const Vector3 line = leg / limbs::length(leg);
    return {{.name = "cylinder", .from = limb.C, .to = at.B, .line = line},
            {.name = "piston", .from = limb.C, .to = at.B, .line = line}};
  }
  const bool is_crank = copy.drive == "crank";
  std::vector<LimbPart> list;
  if (!is_crank) list.push_back({.name = "slider", .from = limb.S, .to = limb.S});
  if (limb.arm) {
    const auto [of_arm, of_rod] =
        is_crank ? std::array{copy.length("crank", "a length"), copy.length("rod", "a length")} : copy.links();
    const std::vector<std::string> names = parts_of_limb(copy.table, copy.drive);
    const Vector3 C = limb.S + limb.arm->arm;
    list.push_back({names[names.size() - 2], limb.S, C, of_arm, limb.arm->arm});
    list.push_back({names.back(), C, at.B, of_rod, limb.arm->rod});
    if (copy.moves()) return list;  // the formulas for the rates of arms assume an axis that does not move
    std::vector<generic::ArmNodes>& arms = copy.draft.model.arms;
    list[list.size() - 2].on_arm = LimbPart::OnArm{arms.size(), limb.S, of_arm, true};
    list.back().on_arm = LimbPart::OnArm{arms.size(), limb.S, of_arm, false};
    arms.push_back({nodes(limb.arm->arm), nodes(limb.arm->axis), nodes(limb.arm->rod), nodes(at.B),
                    is_crank ? std::optional(limb.joint.node()) : std::nullopt});
  } else if (copy.table.has("rod")) {
    list.push_back({"rod", limb.S, at.B, copy.length("rod", "a length"), at.B - limb.S});
  }
  return list;
}

void add_limb_links(const LimbCopy& copy, const Ends& at, const DrivenLimb& limb) {
  const auto radius = copy.table.find("radius");
  if (!radius) return;
  const bool has_links = copy.table.has("links");
  const Term r = copy.draft.scope.positive(*radius, "m", copy.name, true);
  const auto link = [&](const std::string& what, const std::string& part, const Vector3& from, const Vector3& to) {
    const std::string& group = what.ends_with("arm") ? part : copy.name;
    copy.draft.model.links.push_back({what + " of " + copy.name, part, nodes(from), nodes(to), r.node(), {group}});
  };
  if (copy.drive == "crank") link("crank", copy.name, at.A, limb.C);
  if (has_links) link("first link", copy.name, limb.S, limb.C);
  if (copy.drive == "telescope" || copy.table.has("rod") || has_links)
    link(copy.drive == "telescope" ? "leg" : has_links ? "second link" : "rod", copy.name, limb.C, at.B);
  if (copy.drive == "slider" && copy.table.has("range")) {
    const auto [from, to] = copy.range("m");
    link("rail", copy.moves() ? copy.base.body : kFramePart, at.A + *limb.e * from, at.A + *limb.e * to);
  }
  if (copy.table.has("end")) return;
  const std::string& body = copy.platform.body;
  link(body + "'s arm", body, copy.draft.frames.at(body).at.origin, at.B);
}

void add_reach(const LimbCopy& copy, const Ends& at, const DrivenLimb& limb) {
  if (!limb.max_distance) return;
  Vector3 v = at.B - at.A;
  Term far = *limb.max_distance;
  if (at.across) v = v - *at.across * dot(v, *at.across);
  if (copy.drive == "slider") {
    if (copy.table.has("range") && !copy.table.has("links")) {
      const auto [from, to] = copy.range("m");
      v = v - *limb.e * ((from + to) * 0.5);
      far = far + (to - from) * 0.5;
    } else {
      v = cross(v, *limb.e);
    }
  }
  std::vector<expression::Node>& constraints = copy.draft.model.reach_constraints;
  constraints.push_back((far * far - dot(v, v)).node());
  if (!limb.arm || copy.drive != "crank" || !copy.table.has("range")) return;
  // The crank's angle is within half its range of the middle of the range: a constraint without inverse functions,
  // which are discontinuous.
  const auto [from, to] = copy.range("rad");
  const Term middle = (from + to) * 0.5;
  const Term half = call(expression::operation("min"), (to - from) * 0.5, Term(copy.draft.model.graph, kPi));
  const Vector3 zero = copy.direction(copy.table.at("zero", "a direction"));
  const Vector3 to_middle = zero * cos(middle) + cross(*limb.e, zero) * sin(middle);
  constraints.push_back((dot(limb.arm->arm, to_middle) - copy.length("crank", "a length") * cos(half)).node());
}

}  // namespace pkm
