// The sections of a mechanism's file, one function each, in the order in which read_mechanism_toml calls them.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/mechanism_scope.hpp"

namespace pkm {

inline std::array<expression::Node, 3> nodes(const limbs::Vector3& v) {
  return {v[0].node(), v[1].node(), v[2].node()};
}

/// A part of a limb, or a link: what may have a mass, and what [[body]] calls "arm1.crank".
struct LimbPart {
  std::string name;                         ///< "crank", "rod", "slider"
  limbs::Vector3 from, to;                  ///< its ends
  std::optional<limbs::Term> length = {};   ///< where it is constant
  std::optional<limbs::Vector3> line = {};  ///< along it, of any length; none: it does not turn
  /// Where `from` is the end of an arm, or the part is the arm itself.
  struct OnArm {
    std::size_t arm;
    limbs::Vector3 pivot;
    limbs::Term length;  ///< of the arm
    bool is_arm;
  };
  std::optional<OnArm> on_arm = {};
};

/// A limb as other sections name it.
struct NamedLimb {
  std::string name;                              ///< "arm2"
  std::string group;                             ///< "arm": all copies
  std::map<std::string, limbs::Vector3> points;  ///< "A", "B", "C", "S"
  std::vector<LimbPart> parts;

  std::string drive = "formula";
  std::size_t joint = 0;                        ///< its number among the mechanism's
  std::optional<limbs::Vector3> axis = {};      ///< of the crank's pivot, or along the slide
  std::optional<limbs::Vector3> revolute = {};  ///< the axis of its joints, where they are parallel revolutes
  std::optional<limbs::Vector3> beside = {};    ///< from its rod to one of a pair
  std::string end_on = "";                      ///< the body that carries its end; "": the file does not say
};

/// A limb with `across`, whose ends keep their distance along the normal at every pose.
struct LimbInPlane {
  ConfigValue across;
  limbs::Vector3 A, B, normal;
};

/// A limb's own parameter in the graph.
struct OwnParameter : LimbParameter {
  expression::Node node{};
};

/// The values that a sign of the working modes can have, and how names of modes call them.
struct SignChoice {
  std::string signs;               ///< "+-": the file's first is the default
  std::vector<std::string> names;  ///< of each
  bool is_branch = false;          ///< named behind a "/", and only where it is not the default
};

/// What the sections build up together.
struct MechanismDraft {
  generic::Model model;
  MechanismScope scope{model};
  limbs::Vector3 origin{zero(), zero(), zero()};  ///< of the platform's frame
  limbs::Rotation turn{limbs::rotation_about(2, zero(), limbs::Term(model.graph, 1.0))};
  std::vector<NamedLimb> limbs;
  std::vector<LimbInPlane> in_planes;
  std::vector<std::array<std::optional<std::array<limbs::Term, 2>>, 3>> reaches;  ///< by limb: x, y, z
  std::vector<SignChoice> sign_choices;                                           ///< by sign

  std::vector<OwnParameter> own;
  std::optional<ConfigValue> masses;  ///< the alternative of [masses] in force
  std::vector<ConfigValue> let;       ///< [let], and that of the masses

  limbs::Term zero() { return {model.graph, 0.0}; }
  /// A sign of the working modes, and its place among the inputs. @param first  '+' or '-': the file's
  limbs::Term add_sign(char first, bool both);
};

/// What a file describes. @param mass_model  one of its alternatives; "": the first
generic::Model read_mechanism_model(const std::string& text, const std::string& file_name,
                                    const std::vector<LimbParameter>& own, const std::string& mass_model);

/// The text under a key; "" where there is none.
std::string text_of(const ConfigValue& table, const std::string& key);
/// A product of SI units.
std::string si_unit(const ConfigValue& unit);

/// Adds a limb's own parameter to those of the file.
void add_own_parameter(const LimbParameter& own, const Parameter& parameter, MechanismDraft& draft);
/// Does `read`, the while formulas mean the limb's own parameters, also by way of [let].
void read_as_limb(const std::string& limb, const std::function<void()>& read, MechanismDraft& draft);
/// Refuses own parameters of limbs that are not there or have no such parameter in their formulas.
void refuse_idle_parameters(const MechanismDraft& draft);

/// [[limit]]
void read_limits(const ConfigValue& root, MechanismDraft& draft);
/// [inputs]: what quantities, and formulas of [let] that serve them, may depend on beside the pose.
void read_inputs(const ConfigValue& root, MechanismDraft& draft);
/// [[quantity]]: formulas that know "NAME_rate", the derivative by time of a coordinate, an input or a quantity, too.
void read_quantities(const ConfigValue& root, MechanismDraft& draft);
/// [modes]
void read_modes(const ConfigValue& root, MechanismDraft& draft);
/// The limbs of the file: joints, closures, conditions, ranges, angles, links, bodies.
void read_limbs(const ConfigValue& root, MechanismDraft& draft);
/// Refuses `across` where the pose moves the limb's end out of its plane.
void refuse_changing_planes(MechanismDraft& draft);
/// [[margin]] and [[design]]
void read_margins(const ConfigValue& root, MechanismDraft& draft);
/// Refuses signs of [modes] that double the working modes for nothing.
void refuse_idle_signs(const ConfigValue& root, MechanismDraft& draft);
/// [[link]]. @return  the links as [[body]] names them
std::vector<LimbPart> read_links(const ConfigValue& root, MechanismDraft& draft);
/// The limit of the clearance, behind all others, where links have to keep clear of each other.
void add_clearance(MechanismDraft& draft);
/// [survey]
void read_survey(const ConfigValue& root, MechanismDraft& draft);
/// All combinations of the signs, the file's first.
void list_modes(MechanismDraft& draft);

/// Keys of a limb's table that say the mass of a part.
std::vector<std::string> mass_keys(const std::string& part);
/// The body of a limb's part, where its table gives it a mass.
void add_part_body(const ConfigValue& table, const std::string& limb, const LimbPart& part, MechanismDraft& draft);
/// A link with `mass` and `inertia`, thin between two points.
void add_link_body(const ConfigValue& table, const std::string& name, const limbs::Vector3& from,
                   const limbs::Vector3& to, MechanismDraft& draft);
/// The platform's own mass, centre and inertia.
void read_platform_body(const ConfigValue& platform, MechanismDraft& draft);
/// [[body]]. @param links  names of [[link]]s with their directions
void read_bodies(const ConfigValue& root, const std::vector<LimbPart>& links, MechanismDraft& draft);
/// [[joint]], and the joints of limbs, for the forces in them.
void add_joints(const ConfigValue& root, MechanismDraft& draft);
/// [x, y, z] or a limb's point, "arm1.C".
limbs::Vector3 read_point(const ConfigValue& value, const std::string& what, MechanismDraft& draft);

}  // namespace pkm
