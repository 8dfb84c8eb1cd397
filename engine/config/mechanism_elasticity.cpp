// Reads the elastic moduli of the limbs' cross-sections and the play of their joints, and derives the compliances of
// limbs and drives.
#include <algorithm>
#include <numbers>

#include "engine/config/mechanism_draft.hpp"

namespace pkm {
namespace {

using limbs::Term, limbs::Vector3;

/// Reads a cross-section. std::nullopt if it is not given, or if it serves only to compute a mass and has no Young's
/// modulus.
std::optional<NamedLimb::Section> read_section(const ConfigValue& table, const std::string& key,
                                               MechanismDraft& draft) {
  const auto section = table.find_table(key);
  if (!section) return {};
  const auto shear_modulus = key == "leg_section" ? std::nullopt : section->find("shear");
  if (shear_modulus && !section->has("young"))
    throw shear_modulus->refusal("a shear modulus needs Young's modulus, `young`, too");
  const bool is_of_mass = key == "rod_section" || key == "crank_section";
  if (is_of_mass && !section->has("young")) return {};
  const auto positive = [&](const char* name, const char* unit) {
    return draft.scope.positive(section->at(name), unit, key);
  };
  const auto to_the_fourth = [](const Term& d) { return d * d * d * d; };
  const Term outer = positive("outer", "m"), inner = section->has("inner") ? positive("inner", "m") : draft.zero();
  draft.model.required.push_back({key + ": outer - inner", "m", (outer - inner).node()});
  const Term young = positive("young", "Pa");
  constexpr double kPoisson = 0.3;  // Poisson's ratio of all materials, approximately that of steel and aluminium
  const Term shear = shear_modulus ? positive("shear", "Pa") : young / (2 * (1 + kPoisson));
  const Term area = (outer * outer - inner * inner) * (std::numbers::pi / 4),
             moment = (to_the_fourth(outer) - to_the_fourth(inner)) * (std::numbers::pi / 64);
  return NamedLimb::Section{young * area, young * moment, shear * moment * 2, area};
}

Term length_of(const NamedLimb& limb, const std::string& part) {
  return std::ranges::find(limb.parts, part, &LimbPart::name)->length.value();
}

void read_slider(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft) {
  const auto section = table.find_table("slider_section");
  if (!section) return;
  if (!limb.has_rod) throw section->refusal("the limb has no rod: only the bending by the force of a rod is computed");
  limb.slider_section = read_section(table, "slider_section", draft);
  const auto length = section->find("length");
  limb.slider_length =
      length ? draft.scope.positive(*length, "m", "slider_section") : draft.model.term(draft.model.joints[limb.joint]);
}

/// Returns the sum of `compliance` and the compliance of a cantilever that a unit force bends and stretches at its free
/// end.
/// @param along  component of the force along the cantilever
Term add_cantilever(const Term& compliance, const NamedLimb::Section& section, const Term& length, const Term& along) {
  return compliance + along * along * length / section.EA +
         (Term(length.graph(), 1.0) - along * along) * length * length * length / (section.EI * 3);
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
  if (limb.drive == "slider") read_slider(table, limb, draft);
}

Term compliance_of_links(const NamedLimb& limb, MechanismDraft& draft) {
  Term compliance = draft.zero();
  if (limb.rod_section) {
    const Term length =
        limb.drive == "telescope" ? draft.model.term(draft.model.joints[limb.joint]) : length_of(limb, "rod");
    compliance = length / (limb.rod_section->EA * (limb.beside ? 2.0 : 1.0));
  }
  if (limb.crank_section) {
    const Term r = length_of(limb, "crank");
    compliance = add_cantilever(compliance, *limb.crank_section, r,
                                dot(force_of(limb)->force, limb.points.at("C") - limb.points.at("A")) / r);
  }
  if (limb.slider_section)
    compliance = add_cantilever(compliance, *limb.slider_section, abs(*limb.slider_length),
                                dot(force_of(limb)->force, *limb.axis));
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
