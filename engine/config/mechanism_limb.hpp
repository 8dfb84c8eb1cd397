// Reading of one limb: the drive in closed form, the parts, and the links that are drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_draft.hpp"
#include "engine/generic/limbs/limb.hpp"

namespace pkm {

/// One of the copies that a [[limb]] describes, or the limb itself if it has no copies.
struct LimbCopy {
  const ConfigValue& table;
  MechanismDraft& draft;
  std::string drive;
  std::string group;     ///< name in the file: "arm"
  std::string name;      ///< name of this copy: "arm2"
  limbs::Rotation turn;  ///< rotation of this copy

  limbs::Term length(const char* key, const char* expected) const;
  /// Reads a direction and rotates it with the copy. @param on_platform  true: given in the platform's frame
  limbs::Vector3 direction(const ConfigValue& value, bool on_platform = false) const;
  /// Reads both ends of the key `range`, which must be present.
  std::array<limbs::Term, 2> range(const std::string& unit) const;
  /// Reads l_1 and l_2 of the key `links`, which must be present.
  std::array<limbs::Term, 2> links() const;
};

/// A limb in closed form with its drive.
struct DrivenLimb : limbs::Limb {
  std::string form;                           ///< formula of the joint coordinate
  std::optional<limbs::Vector3> e;            ///< direction of the slide, or axis of the crank
  std::optional<limbs::Term> max_distance{};  ///< maximum distance of B from A or from the slide
};

/// Reads the drive of a limb. @param q  the joint variable
DrivenLimb read_drive(const LimbCopy& copy, const limbs::Ends& at, const limbs::Term& q);

/// Names of the parts of a limb, by which [[body]] refers to them.
std::vector<std::string> parts_of_limb(const ConfigValue& table, const std::string& drive);
/// The parts of a limb with their ends. Adds the limb's arm to the model.
std::vector<LimbPart> read_parts(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// Adds the links that are drawn and tested for clearance, if the limb has a `radius`.
void add_limb_links(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// Adds a box around A, or around the rail, that contains the origin of the platform's frame at every pose that the
/// limb can reach.
void add_reach(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);

/// Reads a [[limb]] with drive = "formula": the joints are formulas of the pose.
void read_formula_limb(const ConfigValue& table, const std::string& name, MechanismDraft& draft);

/// Adds a joint and its input to the graph.
limbs::Term add_joint_variable(const ConfigValue& table, const std::string& name, const std::string& unit,
                               MechanismDraft& draft);
/// Reads the two ends of a limb's `range`.
std::array<limbs::Term, 2> read_range(const ConfigValue& range, const std::string& unit, const std::string& limb,
                                      MechanismDraft& draft);
/// Adds the limits of a joint, if the table of its limb has a `range`.
void add_range(const ConfigValue& table, const std::string& limb, const std::string& joint, const std::string& unit,
               const limbs::Term& q, MechanismDraft& draft);

}  // namespace pkm
