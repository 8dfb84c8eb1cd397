// Reader of what makes the limbs compliant and inexact: stiffness of drives, Young's modulus of sections, play.
#include <numbers>

#include "engine/config/mechanism_draft.hpp"

namespace pkm {
namespace {

using limbs::Term;

/// A round tube: outer and inner diameter and Young's modulus.
struct Tube {
  Term outer, inner, young;

  Term area() const { return (outer * outer - inner * inner) * (std::numbers::pi / 4); }
  /// Second moment of area.
  Term second_moment() const {
    const auto fourth = [](const Term& d) { return d * d * d * d; };
    return (fourth(outer) - fourth(inner)) * (std::numbers::pi / 64);
  }
};

/// std::nullopt if the section is not given, or without Young's modulus.
std::optional<Tube> read_tube(const ConfigValue& table, const std::string& key, MechanismDraft& draft) {
  const auto section = table.find_table(key);
  if (!section || !section->has("young")) return {};
  const auto positive = [&](const char* name, const char* unit) {
    return draft.scope.positive(section->at(name), unit, key);
  };
  return Tube{positive("outer", "m"), section->has("inner") ? positive("inner", "m") : draft.zero(),
              positive("young", "Pa")};
}

Term length_of(const NamedLimb& limb, const std::string& part) {
  const auto found = std::ranges::find(limb.parts, part, &LimbPart::name);
  return found->length.value();
}

}  // namespace

void read_elasticity(const ConfigValue& table, const Term& leg, NamedLimb& limb, MechanismDraft& draft) {
  if (const auto play = table.find("play")) {
    if (!limb.has_rod) throw play->refusal("this slide carries the platform; it has no passive joints");
    limb.play = draft.scope.positive(*play, "m", limb.name, true);
  }
  const bool is_telescope = limb.drive == "telescope";
  const std::string rod_key = is_telescope ? "leg_section" : "rod_section";
  if (limb.has_rod)
    if (const auto tube = read_tube(table, rod_key, draft)) {
      const double rods = limb.beside ? 2 : 1;
      limb.rod_compliance = (is_telescope ? leg : length_of(limb, "rod")) / (tube->young * tube->area() * rods);
    }
  if (limb.drive == "crank")
    if (const auto tube = read_tube(table, "crank_section", draft)) {
      const Term r = length_of(limb, "crank");
      limb.crank = {r / (tube->young * tube->area()), r * r * r / (tube->young * tube->second_moment() * 3)};
    }
}

}  // namespace pkm
