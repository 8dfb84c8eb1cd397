// Readers of the tables of a mechanism file, one function for each, in the order in which read_mechanism_toml calls
// them. mechanism_keys.hpp describes the keys.
//
// Reading and building are separate: the readers only fill a generic::Model, and generic::make_mechanism() makes a
// mechanism of any model, however it was built. The classes in engine/generic/limbs add the closed form of a limb to
// the expression graph of a model; they do not depend on TOML.
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

/// A part of a limb, or a link. It may have a mass; [[body]] refers to it by a name such as "arm1.crank".
struct LimbPart {
  std::string name;                         ///< "crank", "rod", "slider"
  limbs::Vector3 from, to;                  ///< ends of the part
  std::optional<limbs::Term> length = {};   ///< length, if it is constant
  std::optional<limbs::Vector3> line = {};  ///< vector along the part, of any length; std::nullopt: the part does not
                                            ///< rotate
  /// Set if `from` is the end of an arm, or the part is the arm itself.
  struct OnArm {
    std::size_t arm;
    limbs::Vector3 pivot;
    limbs::Term length;  ///< length of the arm
    bool is_arm;
  };
  std::optional<OnArm> on_arm = {};
};

/// A limb that has been read, under the name by which other tables refer to it.
struct NamedLimb {
  std::string name;                              ///< "arm2"
  std::string group;                             ///< "arm": name of the limb in the file, which all copies share
  std::map<std::string, limbs::Vector3> points;  ///< "A", "B", "C", "S"
  std::vector<LimbPart> parts;

  std::string drive = "formula";
  std::size_t joint = 0;                        ///< index among the joints of the mechanism; for a formula limb, of its
                                                ///< first joint
  std::size_t joint_count = 1;                  ///< greater than 1 only for formula limbs
  std::optional<limbs::Vector3> axis = {};      ///< axis of the crank's pivot, or direction of the slide
  std::optional<limbs::Vector3> revolute = {};  ///< common axis of its joints, if they are parallel revolutes
  bool has_rod = false;                         ///< a rod or telescope; false: a slide that carries the platform
  bool has_links = false;                       ///< it has two links instead of a rod
  std::optional<limbs::Vector3> beside = {};    ///< vector from the middle of a pair of rods to one of them
  std::string end_on = "";                      ///< the body to which its end is attached; "": unspecified

  std::optional<limbs::Term> play = {};  ///< radial play of each passive joint [m]
  /// Stiffness of a round tube, axial E A [N], bending E I and torsional G J [N m^2], and its cross-section A [m^2].
  struct Section {
    limbs::Term EA, EI, GJ, area;
  };
  /// Cross-section of one rod or of the leg, of the crank, and of the slider; std::nullopt: rigid.
  std::optional<Section> rod_section = {}, crank_section = {}, slider_section = {};
  std::optional<limbs::Term> slider_length = {};  ///< from the guide to the slider, along the slide [m]
  std::optional<limbs::Vector3> universal = {};   ///< axis of its universal joints, on the drive's side of each joint
};

/// A limb with the key `across`: the component of the vector between its ends along the normal must be the same at
/// every pose.
struct LimbInPlane {
  ConfigValue across;
  limbs::Vector3 A, B, normal;
};

/// A parameter of a single limb in the graph.
struct OwnParameter : LimbParameter {
  expression::Node node{};
};

/// A sign that selects the working mode: its possible values, and their texts in the names of modes.
struct SignChoice {
  std::string signs;               ///< "+-": the first is the default
  std::vector<std::string> names;  ///< texts of the signs
  bool is_branch = false;          ///< true: its text follows a "/" in the name of the mode, unless the sign is the
                                   ///< default
};

/// The mechanism as far as it has been read; each reader adds to it.
struct MechanismDraft {
  generic::Model model;
  MechanismScope scope{model};
  limbs::Vector3 origin{zero(), zero(), zero()};  ///< origin of the platform's frame
  bool has_origin = false;                        ///< whether `origin` has been read
  /// Rotation of the platform's frame.
  limbs::Rotation turn{limbs::rotation_about(2, zero(), limbs::Term(model.graph, 1.0))};
  std::vector<NamedLimb> limbs;
  std::vector<LimbInPlane> in_planes;
  std::vector<std::array<std::optional<std::array<limbs::Term, 2>>, 3>> reaches;  ///< for each limb, ranges of x, y, z
  std::vector<SignChoice> sign_choices;                                           ///< in the order of the inputs

  std::vector<std::optional<limbs::Term>> drive_stiffness;  ///< for each joint [N/m or N m/rad]; std::nullopt: rigid
  std::vector<OwnParameter> own;
  std::optional<ConfigValue> masses;  ///< the selected alternative of [masses]
  std::vector<ConfigValue> let;       ///< [let], and the `let` of the masses

  limbs::Term zero() { return {model.graph, 0.0}; }
  /// Adds a sign of the working modes to the inputs of the graph. @param first  '+' or '-': the default
  limbs::Term add_sign(char first, bool both);
};

/// Reads the model of a mechanism file. @param mass_model  one of its alternatives; "": the first
generic::Model read_mechanism_model(const std::string& text, const std::string& file_name,
                                    const std::vector<LimbParameter>& own, const std::string& mass_model,
                                    const StudyAdditions& study = nullptr);

/// The text under a key; "" if the key is absent.
std::string text_of(const ConfigValue& table, const std::string& key);
/// A product of SI units.
std::string si_unit(const ConfigValue& unit);

/// Adds a parameter of a single limb.
void add_own_parameter(const LimbParameter& own, const Parameter& parameter, MechanismDraft& draft);
/// Calls `read` with the limb's own parameters in scope, also in formulas of [let].
void read_as_limb(const std::string& limb, const std::function<void()>& read, MechanismDraft& draft);
/// Refuses a parameter of a single limb if the limb does not exist, or if no formula of the limb uses the parameter.
void refuse_idle_parameters(const MechanismDraft& draft);

/// Reads the tables [[limit]].
void read_limits(const ConfigValue& root, MechanismDraft& draft);
/// Reads [inputs]: variables other than the pose. Quantities, and the formulas of [let] that they use, may depend on
/// them.
void read_inputs(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[quantity]] of the file and, if it is not null, of a study. Their formulas may also use
/// "NAME_rate", the time derivative of a coordinate, an input or a quantity.
void read_quantities(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// The force that a limb transmits to the platform, along a rod, a leg or a slide.
struct LimbForce {
  limbs::Vector3 force;  ///< unit vector
  limbs::Term input;     ///< input transmission index
  limbs::Vector3 end;    ///< point of the platform at which the force acts: B
};
/// The force of a limb; std::nullopt for limbs that are formulas or have links, which transmit more than one force.
std::optional<LimbForce> force_of(const NamedLimb& limb);
/// Whether a file or a study has a [[quantity]] of this name. @param study  null if there is none
bool defines_quantity(const ConfigValue& root, const ConfigValue* study, const std::string& name);
/// Adds the transmission indices `lti`, `lti_input` and `lti_output` as quantities, if they are defined for the limbs.
void add_transmission(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Adds the quantities of engine/generic/performance/performance.hpp whose data are given by the file or by the study,
/// which may be null.
void add_performance(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Reads the elastic moduli of a limb's cross-sections, and the play of its joints.
void read_elasticity(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft);
/// Compliance of the limb's end along the line of its rod or leg, due to rods, crank and slider [m/N].
limbs::Term compliance_of_links(const NamedLimb& limb, MechanismDraft& draft);
/// Compliance of a limb's drive, measured at the joint [m/N or rad/(N m)]; for a telescope, including that of the leg.
std::optional<limbs::Term> drive_compliance(const NamedLimb& limb, MechanismDraft& draft);
/// The limits of quantities in a study, as a table; std::nullopt if it has none.
std::optional<ConfigValue> limits_of_quantities(const ConfigValue& study);
/// Adds a threshold for each limit of a quantity in the study, [workspace] limits = { NAME = { min = .. } }. It is
/// called directly after read_limits(), because the positions of all later inputs of the graph depend on the number of
/// limits.
void read_quantity_limits(const ConfigValue& study, MechanismDraft& draft);
/// Adds the margins of the limits of quantities in the study.
void add_quantity_margins(const ConfigValue& study, MechanismDraft& draft);
/// Reads the table [modes].
void read_modes(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[limb]]: joints, loop-closure equations, constraints, ranges, angles, links, bodies.
void read_limbs(const ConfigValue& root, MechanismDraft& draft);
/// Refuses `across` if the end of the limb leaves the limb's plane at some poses.
void refuse_changing_planes(MechanismDraft& draft);
/// Reads the tables [[margin]] and [[design]].
void read_margins(const ConfigValue& root, MechanismDraft& draft);
/// Refuses signs of [modes] that no formula of a joint or margin uses.
void refuse_idle_signs(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[link]]. @return the links, under the names that [[body]] uses
std::vector<LimbPart> read_links(const ConfigValue& root, MechanismDraft& draft);
/// Adds the limit of the clearance, as the last limit, if there are links that could collide.
void add_clearance(MechanismDraft& draft);
/// Reads the table [survey].
void read_survey(const ConfigValue& root, MechanismDraft& draft);
/// Lists all combinations of the signs, the default first.
void list_modes(MechanismDraft& draft);

/// Adds the body of a limb's part, if its table gives it a mass.
void add_part_body(const ConfigValue& table, const std::string& limb, const LimbPart& part, MechanismDraft& draft);
/// Adds the body of a thin link between two points, if its table has a `mass`.
void add_link_body(const ConfigValue& table, const std::string& name, const limbs::Vector3& from,
                   const limbs::Vector3& to, MechanismDraft& draft);
/// Adds the body of the platform: mass, centre and inertia.
void read_platform_body(const ConfigValue& platform, MechanismDraft& draft);
/// Reads the tables [[body]]. @param links  result of read_links()
void read_bodies(const ConfigValue& root, const std::vector<LimbPart>& links, MechanismDraft& draft);
/// Reads the tables [[joint]], and adds the joints of the limbs, to compute the forces in joints.
void add_joints(const ConfigValue& root, MechanismDraft& draft);
}  // namespace pkm
