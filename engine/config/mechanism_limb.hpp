// A limb with a drive of closed form while it is read: its drive, its parts, what is drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_draft.hpp"
#include "engine/generic/limbs/limb.hpp"

namespace pkm {

/// One of the copies that a [[limb]] describes, or the limb itself.
struct LimbCopy {
  const ConfigValue& table;
  MechanismDraft& draft;
  std::string drive;
  std::string group;     ///< the limb's name: "arm"
  std::string name;      ///< this copy's: "arm2"
  limbs::Rotation turn;  ///< of this copy

  limbs::Term length(const char* key, const char* expected) const;
  /// Turned with the copy; in the platform's frame or the base's.
  limbs::Vector3 direction(const ConfigValue& value, bool on_platform = false) const;
  /// The ends of `range`, which is there.
  std::array<limbs::Term, 2> range(const std::string& unit) const;
  /// l_1 and l_2 of `links`, which are there.
  std::array<limbs::Term, 2> links() const;
};

/// What a drive comes to.
struct DrivenLimb : limbs::Limb {
  std::string form;                     ///< the joint, in words
  std::optional<limbs::Vector3> e;      ///< along the slide, or the crank's axis
  std::optional<limbs::Term> beyond{};  ///< how far from A, or from the slide, B can be
};

/// @param q  the joint variable
DrivenLimb read_drive(const LimbCopy& copy, const limbs::Ends& at, const limbs::Term& q);

/// A limb's bodies, as [[body]] names them.
std::vector<std::string> parts_of_limb(const ConfigValue& table, const std::string& drive);
/// The same with their ends. Adds the limb's arm.
std::vector<LimbPart> read_parts(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// What is drawn, and keeps clear: where the limb has a `radius`.
void add_limb_links(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// Where the platform's frame has to be for the limb to reach: a box about A, or about the rail.
void add_reach(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);

/// [[limb]] with drive = "formula": the joints are formulas of the pose.
void read_formula_limb(const ConfigValue& table, const std::string& name, MechanismDraft& draft);

/// The input of a new joint.
limbs::Term add_joint_variable(const ConfigValue& table, const std::string& name, const std::string& unit,
                               MechanismDraft& draft);
/// The two ends of a limb's `range`.
std::array<limbs::Term, 2> read_range(const ConfigValue& range, const std::string& unit, const std::string& limb,
                                      MechanismDraft& draft);
/// The limits of a joint, where its limb's table has a `range`.
void add_range(const ConfigValue& table, const std::string& limb, const std::string& joint, const std::string& unit,
               const limbs::Term& q, MechanismDraft& draft);

}  // namespace pkm
