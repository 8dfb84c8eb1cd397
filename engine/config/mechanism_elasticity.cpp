// Reader of what makes limbs compliant and inexact: elastic moduli of sections, play of joints; and the compliances of
// limbs that follow.
#include <algorithm>
#include <numbers>

#include "engine/config/mechanism_draft.hpp"

namespace pkm {
namespace {

using limbs::Term, limbs::Vector3;

/// Reads a cross-section; std::nullopt if it is not given, or has no Young's modulus.
std::optional<NamedLimb::Section> read_section(const ConfigValue& table, const std::string& key,
                                               MechanismDraft& draft) {
  const auto section = table.find_table(key);
  if (!section) return {};
  const auto shear_modulus = key == "leg_section" ? std::nullopt : section->find("shear");
  if (shear_modulus && !section->has("young"))
    throw shear_modulus->refusal("a shear modulus needs Young's modulus, `young`, too");
  if (!section->has("young")) return {};
  const auto positive = [&](const char* name, const char* unit) {
    return draft.scope.positive(section->at(name), unit, key);
  };
  const auto to_the_fourth = [](const Term& d) { return d * d * d * d; };
  const Term outer = positive("outer", "m"), inner = section->has("inner") ? positive("inner", "m") : draft.zero();
  draft.model.required.push_back({key + ": outer - inner", "m", (outer - inner).node()});
  const Term young = positive("young", "Pa");
  constexpr double kPoisson = 0.3;  // Poisson's ratio, approximately that of steel and aluminium
  const Term shear = shear_modulus ? positive("shear", "Pa") : young / (2 * (1 + kPoisson));
  const Term area = (outer * outer - inner * inner) * (std::numbers::pi / 4),
             moment = (to_the_fourth(outer) - to_the_fourth(inner)) * (std::numbers::pi / 64);
  return NamedLimb::Section{young * area, young * moment, shear * moment * 2, area};
}

Term length_of(const NamedLimb& limb, const std::string& part) {
  return std::ranges::find(limb.parts, part, &LimbPart::name)->length.value();
}

}  // namespace

void read_elasticity(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft) {
  if (const auto play = table.find("play")) {
    if (!limb.has_rod) throw play->refusal("the limb has no rod or leg with passive joints at its ends");
    limb.play = draft.scope.positive(*play, "m", limb.name, true);
  }
  if (limb.has_rod)
    limb.rod_section = read_section(table, limb.drive == "telescope" ? "leg_section" : "rod_section", draft);
  if (limb.drive == "crank") limb.crank_section = read_section(table, "crank_section", draft);
}

Term compliance_of_links(const NamedLimb& limb, MechanismDraft& draft) {
  Term compliance = draft.zero();
  if (limb.rod_section) {
    const Term length =
        limb.drive == "telescope" ? draft.model.term(draft.model.joints[limb.joint]) : length_of(limb, "rod");
    compliance = length / (limb.rod_section->EA * (limb.beside ? 2.0 : 1.0));
  }
  if (limb.crank_section) {  // the crank is a cantilever with the rod's force at its end
    const Term r = length_of(limb, "crank"), one(draft.model.graph, 1.0);
    const Term along = dot(force_of(limb)->force, limb.points.at("C") - limb.points.at("A")) / r;
    compliance = compliance + along * along * r / limb.crank_section->EA +
                 (one - along * along) * r * r * r / (limb.crank_section->EI * 3);
  }
  return compliance;
}

std::optional<Term> drive_compliance(const NamedLimb& limb, MechanismDraft& draft) {
  std::optional<Term> compliance;
  if (const auto& stiffness = draft.drive_stiffness[limb.joint]) compliance = Term(draft.model.graph, 1.0) / *stiffness;
  if (limb.drive == "telescope" && limb.rod_section) {
    const Term leg = compliance_of_links(limb, draft);
    compliance = compliance ? *compliance + leg : leg;
  }
  return compliance;
}

}  // namespace pkm
