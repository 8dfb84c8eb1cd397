// Reading of one limb: the drive in closed form, the parts, and the links that are drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_draft.hpp"
#include "engine/generic/limbs/limb.hpp"

namespace pkm {

struct Chain;

/// One of the copies that a [[limb]] describes; if it has no key `copies`, the limb itself.
struct LimbCopy {
  const ConfigValue& table;
  MechanismDraft& draft;
  std::string drive;
  std::string group;                  ///< name of the [[limb]] in the file, for example "arm"
  std::string name;                   ///< name of this copy, for example "arm2"
  limbs::Rotation turn;               ///< rotation that maps the geometry in the file to this copy
  const NamedFrame &base, &platform;  ///< frames to which the two ends of the limb are attached
  ConfigValue ends;  ///< table that contains the limb's keys `base` and `platform`: the table of the limb, or an
                     ///< element of `copies`, whose other keys are in `table`
  const Chain* chain = nullptr;  ///< the chain of joints of a limb with the key `chain`; null for other limbs

  limbs::Term length(const char* key, const char* expected) const;
  /// Reads a direction and rotates it with the copy.
  /// @param on_platform  true: it is given in the frame `platform`; false: in the frame `base`
  limbs::Vector3 direction(const ConfigValue& value, bool on_platform = false) const;
  /// Returns true if the base of the limb moves relative to the base frame of the mechanism.
  bool moves() const { return base.body != kBaseFrame; }
  /// Reads the minimum and the maximum of the key `range`, which must be present.
  std::array<limbs::Term, 2> range(const std::string& unit) const;
  /// Reads the lengths l_1 and l_2 of the key `links`, which must be present.
  std::array<limbs::Term, 2> links() const;
};

/// A limb with its inverse kinematics in closed form, for the drive that its table selects.
struct DrivenLimb : limbs::Limb {
  std::string form;  ///< text that describes the closed form of the joint coordinate
  /// Direction of the slider, or axis of the crank; std::nullopt for a telescopic leg.
  std::optional<limbs::Vector3> e;
  /// Maximum distance of B from A or from the line on which the slider moves; std::nullopt if lengths of parts do
  /// not limit it.
  std::optional<limbs::Term> max_distance{};
  /// Coordinate of another joint of the limb's chain, which is driven instead; std::nullopt: `joint` is driven.
  std::optional<limbs::Term> driven{};
};

/// The branch sign (+1 or -1), which selects one of two solutions of the inverse kinematics, as an input of the graph.
/// Formulas of quantities and margins refer to it by a name such as "arm1_branch".
limbs::Term limb_branch(const LimbCopy& copy);
/// Reads the drive of a limb, and computes the limb's closed form.
/// @param q  joint coordinate as a variable of the loop-closure equation
DrivenLimb read_drive(const LimbCopy& copy, const limbs::Ends& at, const limbs::Term& q);

/// Names of the parts that a limb with this table and drive has; [[body]] refers to them by these names.
std::vector<std::string> parts_of_limb(const ConfigValue& table, const std::string& drive);
/// The parts of a limb with their end points. If the limb has an arm (a crank, or the first of two links), the arm is
/// added to the model.
std::vector<LimbPart> read_parts(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// Adds the links of a limb, which are drawn and tested for clearance, if its table has the key `radius`.
void add_limb_links(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);
/// Adds constraints that follow from others, but are easier to contract: the lengths of the limb span the distance of
/// its end B from A, from the line of its slider, or from the middle of its rail; and the angle of a crank is in its
/// range, as a formula without inverse functions.
void add_reach(const LimbCopy& copy, const limbs::Ends& at, const DrivenLimb& limb);

/// Reads a [[limb]] with drive = "formula", whose joint coordinates are formulas of the pose.
void read_formula_limb(const ConfigValue& table, const std::string& name, MechanismDraft& draft);

/// Adds a joint to the model, and its coordinate to the inputs of the graph.
limbs::Term add_joint_variable(const ConfigValue& table, const std::string& name, const std::string& unit,
                               MechanismDraft& draft);
/// Reads the two ends of a limb's `range`.
std::array<limbs::Term, 2> read_range(const ConfigValue& range, const std::string& unit, const std::string& limb,
                                      MechanismDraft& draft);
/// Adds the lower and upper limit of a joint, if the table of its limb has the key `range`.
void add_range(const ConfigValue& table, const std::string& limb, const std::string& joint, const std::string& unit,
               const limbs::Term& q, MechanismDraft& draft);

}  // namespace pkm
