// Reads the drive of a [[limb]] in closed form: a telescopic leg, a slider or a crank.

#include <cmath>

#include "engine/config/mechanism_limb.hpp"
#include "engine/config/tables.hpp"
#include "engine/expression/formula_lexer.hpp"

namespace pkm {
namespace {

using limbs::Ends, limbs::Term, limbs::Vector3;

void refuse_oblique(const LimbCopy& copy, const Vector3& a, const Vector3& b, const char* key, const char* other) {
  if (std::fabs(copy.draft.scope.at_default(dot(a, b))) > 1e-9)
    throw copy.table.find(key)->refusal(std::string("`") + key + "` has to be normal to " + other);
}

DrivenLimb slider_and_links(const LimbCopy& copy, const Ends& at, const Vector3& e, const Term& q) {
  if (const auto rod = copy.table.find("rod")) throw rod->refusal("give either `rod` or `links`, not both");
  const auto [l_1, l_2] = copy.links();
  const auto given = copy.table.find("axis");
  const Vector3 axis = given ? copy.direction(*given) : e;
  const Term max_distance = l_1 + l_2;
  return {limbs::slider_and_links(at, e, axis, l_1, l_2, limb_branch(copy), q), "q = (B - A) . e, two links across e",
          e, max_distance};
}

DrivenLimb slider(const LimbCopy& copy, const Ends& at, const Term& q) {
  const ConfigValue& table = copy.table;
  const auto along = table.find("along");
  if (along && table.has("direction"))
    throw along->refusal("give `direction` for a slide without `links`, and `along` for a slide with `links`");
  const Vector3 e = copy.direction(along ? *along : table.at("direction", "the slide's direction [x, y, z]"));
  if (at.across) refuse_oblique(copy, e, *at.across, along ? "along" : "direction", "`across`");
  if (const auto across = table.find("across"); across && !table.has("rod"))
    throw across->refusal("`across` has no effect on a slide without `rod`: " +
                          std::string(table.has("links")
                                          ? "its links move in the plane normal to `along`"
                                          : "only the platform's point along `direction` determines its position"));
  if (table.has("links")) return slider_and_links(copy, at, e, q);
  if (!table.has("rod")) {
    if (const auto sign = table.find("branch"))
      throw sign->refusal(
          "a slide without `rod` or `links` has one solution for every pose, so `branch` has no effect");
    return {limbs::slider(at, e, q), "q = (B - A) . e", e};
  }
  const Term rod = copy.length("rod", "the rod's length");
  return {limbs::slider_and_rod(at, e, rod, limb_branch(copy), q),
          "q = s + branch sqrt(rod^2 - (|v|^2 - s^2)), s = v . e, v = B - A", e, rod};
}

DrivenLimb crank(const LimbCopy& copy, const Ends& at, const Term& q) {
  const ConfigValue& table = copy.table;
  const Vector3 axis = copy.direction(table.at("axis", "the pivot's axis [x, y, z]"));
  const Vector3 zero = copy.direction(table.at("zero", "the crank's direction at q = 0, [x, y, z]"));
  refuse_oblique(copy, zero, axis, "zero", "`axis`");
  if (at.across) {
    refuse_oblique(copy, *at.across, zero, "across", "the crank's motion, along its `axis`");
    refuse_oblique(copy, *at.across, cross(axis, zero), "across", "the crank's motion, along its `axis`");
  }
  const Term crank = copy.length("crank", "the crank's length"), rod = copy.length("rod", "the rod's length");
  std::optional<std::array<Term, 2>> ends;
  if (table.has("range")) ends = copy.range("rad");
  const Term max_distance = crank + rod;
  return {limbs::crank_and_rod(at, axis, zero, crank, rod, limb_branch(copy), ends, q),
          "q = atan2(w, u) + branch acos(k / hypot(u, w)), k = (|v|^2 + crank^2 - rod^2) / (2 crank)", axis,
          max_distance};
}

DrivenLimb cable_over_pulley(const LimbCopy& copy, const Ends& at, const Term& q) {
  const ConfigValue radius = copy.table.at("pulley_radius", "the radius of the pulley");
  if (!copy.table.has("tension")) throw radius.refusal("a pulley requires a cable, i.e. a limb with `tension`");
  for (const std::string key : {"across", "universal", "leg_section", "cylinder_mass", "piston_mass"})
    if (const auto other = copy.table.find(key))
      throw other->refusal("a cable over a pulley has no `" + key + "`; remove it or `pulley_radius`");
  const auto axis = copy.table.find("pulley_axis");
  const Term zero(q.graph(), 0.0), one(q.graph(), 1.0);
  const Vector3 e = axis ? copy.direction(*axis) : copy.base.at.rotation * (copy.turn * Vector3(zero, zero, one));
  return {limbs::cable_over_pulley(at, e, copy.draft.scope.positive(radius, "m", copy.name), q),
          "q = sqrt(u^2 + w^2 - r^2) + r (pi - atan2(w, u) - atan2(sqrt(u^2 + w^2 - r^2), r))",
          {}};
}

}  // namespace

Term limb_branch(const LimbCopy& copy) {
  const ConfigValue value = copy.table.at("branch", "\"+\" or \"-\"");
  const Term sign = copy.draft.add_sign(value.word()[0], true);
  const std::string name = copy.name + "_branch";
  if (expression::may_be_name(name) && !copy.draft.scope.knows(name))
    copy.draft.scope.add(copy.table, name, sign.node());
  return sign;
}

DrivenLimb read_drive(const LimbCopy& copy, const Ends& at, const Term& q) {
  if (copy.drive == "slider") return slider(copy, at, q);
  if (copy.drive == "crank") return crank(copy, at, q);
  if (copy.table.has("pulley_radius") || copy.table.has("pulley_axis")) return cable_over_pulley(copy, at, q);
  return {limbs::telescope(at, q), "q = |B - A|", {}};
}

}  // namespace pkm
