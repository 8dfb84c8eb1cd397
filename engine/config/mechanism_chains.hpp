// Limbs that are given as a chain of joints, [[limb]] chain = ["P", "R", "S"].
//
// A chain whose inverse kinematics is that of a slider, a crank or a telescope is rewritten as a limb with this drive;
// the coordinates of its other joints follow from the points of the limb, and one of these joints may be driven
// instead. A spherical chain has its own closed form (engine/generic/limbs/spherical.hpp). The joint coordinates of all
// other chains are computed by Newton's method.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_limb.hpp"

namespace pkm {

/// A chain as its table describes it.
struct Chain {
  ConfigValue table;   ///< the table of the limb in the file
  std::string joints;  ///< letters of the joints, from the base to the platform: "PRS"
  std::string drive;   ///< the drive with the same inverse kinematics, for example "slider"; "chain": there is none
  std::size_t driven;  ///< index of the driven joint
  std::size_t usual;   ///< index of the joint that `drive` drives

  bool is_spherical() const { return table.has("angles"); }
  /// Whether the chain has the closed form of a limb with another drive.
  bool is_rewritten() const { return drive != "chain"; }
  /// Whether the plane of the leg rotates with the platform, on which the only revolute joint of the chain is.
  bool is_hinged_at_platform() const { return joints == "SPR" || joints == "UPR"; }
  const char* unit(std::size_t joint) const { return joints[joint] == 'P' ? "m" : "rad"; }
};

/// An angle plus the multiple of 2 pi by which the result is within pi of the angle `centre`.
limbs::Term wrapped(const limbs::Term& angle, const limbs::Term& centre);
/// The joints of a chain for messages: "P-R-S".
std::string with_dashes(const std::string& joints);
/// Reads the keys `chain` and `driven`.
Chain read_chain(const ConfigValue& table);
/// Converts the table of a limb with `chain` to that of a limb with the drive chain.drive. The chain is_rewritten().
ConfigValue rewritten(const Chain& chain, MechanismDraft& draft);

/// Coordinates of the joints of a chain by their index, for the joints whose coordinates are defined.
using ChainJoints = std::map<std::size_t, limbs::Term>;
/// Coordinates of the joints of a chain that was rewritten. If the driven joint is not the one that the drive
/// describes, it becomes the joint of the limb.
/// @param limb  the closed form for the drive
/// @param q     coordinate of the driven joint as a variable of the loop-closure equation
ChainJoints find_chain_joints(const LimbCopy& copy, const limbs::Ends& at, const limbs::Term& q, DrivenLimb& limb);
/// Describes the joint at the base of the chains S P R and U P R. @param limb  the limb, with its revolute axis
void describe_base_joint(const LimbCopy& copy, NamedLimb& limb);
/// A coordinate of a joint of a chain.
struct ChainCoordinate {
  std::string name;  ///< name within the limb: "q2"
  const char* unit;
  limbs::Term value;
  bool is_driven;
};
/// Adds the names and ranges of the coordinates of a chain: "arm1.q2".
void name_chain_coordinates(const LimbCopy& copy, const std::vector<ChainCoordinate>& coordinates);
/// The same for joints with one coordinate each.
void name_chain_joints(const LimbCopy& copy, const ChainJoints& joints);

/// Adds a copy of a limb that is a spherical chain. @param joint  name of its driven joint
void read_spherical_limb(const LimbCopy& copy, const std::string& joint);
/// Adds a copy of a limb that is a chain without a closed form. @param joint  name of its driven joint
void read_solved_limb(const LimbCopy& copy, const std::string& joint);

}  // namespace pkm
