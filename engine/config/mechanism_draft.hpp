// Readers of the tables of a mechanism file, one function for each, in the order in which read_mechanism_toml calls
// them. mechanism_keys.hpp describes the keys.
//
// Reading and building are separate: the readers only fill a generic::Model, and generic::make_mechanism() makes a
// mechanism of any model, however it was built. The classes in engine/generic/limbs add the closed form of a limb to
// the expression graph of a model; they do not depend on TOML.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/mechanism_scope.hpp"
#include "engine/generic/performance/performance.hpp"

namespace pkm {

inline std::array<expression::Node, 3> nodes(const limbs::Vector3& v) {
  return {v[0].node(), v[1].node(), v[2].node()};
}

/// Direction of axis k (0 to 2) of a frame with the rotation matrix R.
inline limbs::Vector3 column(const limbs::Rotation& R, std::size_t k) { return {R[0][k], R[1][k], R[2][k]}; }

/// Names of the frames that every mechanism has.
inline constexpr const char *kBaseFrame = "base", *kPlatformFrame = "platform";

/// A motion of the platform along or about an axis of its moving frame.
struct PlatformMotion {
  std::string name;
  std::size_t axis;  ///< index of the axis: 0 for x, 1 for y, 2 for z
  bool rotates;
  /// Index of the motion's coordinate among the coordinates of the pose; std::nullopt: the motion is a function of
  /// these coordinates.
  std::optional<std::size_t> coordinate;
  const char* unit() const { return rotates ? "rad" : "m"; }
};

/// One of the successive rotations of the platform.
struct PlatformTurn {
  limbs::Vector3 axis;  ///< unit vector in the base frame
  limbs::Term angle;
  std::size_t index;  ///< index of the axis of rotation (0 to 2) in the platform's frame before this rotation
};

/// A frame to which tables of a mechanism file refer by its name: the base, the platform, or a [[frame]].
struct NamedFrame {
  std::string name;
  expression::Frame at;  ///< position and rotation in the base frame
  /// Body to which the frame is fixed: "base", "platform", or the name of a [[frame]] that moves relative to the frame
  /// on which it is defined.
  std::string body;
  /// Axes, in the base frame, of all rotations of the body relative to the base; std::nullopt: unknown.
  std::optional<std::vector<limbs::Vector3>> turns;
};

/// A part of a limb, or a [[link]]. It can have a mass, and [[body]] refers to it by a name such as "arm1.crank".
struct LimbPart {
  std::string name;                        ///< name of the part within its limb, for example "crank", "rod" or "slider"
  limbs::Vector3 from, to;                 ///< end points of the part in the base frame
  std::optional<limbs::Term> length = {};  ///< length of the part, if it is constant; otherwise std::nullopt
  /// Vector along the part, of any length; std::nullopt: the part does not rotate.
  std::optional<limbs::Vector3> line = {};
  /// The arm on whose end the part begins (`from`), or which the part is itself; std::nullopt for other parts.
  struct OnArm {
    std::size_t arm;
    limbs::Vector3 pivot;
    limbs::Term length;  ///< length of the arm from `pivot` to its end
    bool is_arm;
  };
  std::optional<OnArm> on_arm = {};
  /// A link that is an arc of a circle, between two joints whose axes intersect in its centre.
  struct Arc {
    /// Centre of the arc; first, last: unit vectors from the centre to the two ends.
    limbs::Vector3 centre, first, last;
    limbs::Term radius, angle;
  };
  std::optional<Arc> arc = {};
};

/// A limb that has been read, under the name by which other tables refer to it.
struct NamedLimb {
  std::string name;                              ///< name of the limb; for a copy, with its number: "arm2"
  std::string group;                             ///< name of the [[limb]] in the file, which all copies share: "arm"
  std::map<std::string, limbs::Vector3> points;  ///< points to which other tables can refer: "A", "B", "C", "S"
  std::vector<LimbPart> parts;

  std::string drive = "formula";
  /// Index of the limb's joint among the joints of the mechanism; for a limb with drive = "formula", of its first
  /// joint.
  std::size_t joint = 0;
  std::size_t joint_count = 1;  ///< number of joints; greater than 1 only for limbs with drive = "formula"
  /// Axis of the crank's pivot, or direction in which the slider moves; std::nullopt for other drives.
  std::optional<limbs::Vector3> axis = {};
  /// Common direction of the axes of the limb's joints; std::nullopt unless these are parallel revolute joints.
  std::optional<limbs::Vector3> revolute = {};
  bool has_rod = false;    ///< true: a rod or a telescopic leg carries the platform; false: the slider or two links do
  bool has_links = false;  ///< true: two links connect the slider to the platform, instead of a rod
  /// Vector from the middle of a pair of rods to one of them; std::nullopt: a single rod.
  std::optional<limbs::Vector3> beside = {};
  std::string begin_on = kBaseFrame;  ///< name of the body to which A or the rail is attached
  std::string end_on = "";            ///< name of the body to which the end B is attached; "": unspecified

  /// Minimum and maximum tension [N] of a cable; std::nullopt: the limb is no cable.
  std::optional<std::array<limbs::Term, 2>> tension = {};
  /// Radius of the pulley over which a cable leaves the base; std::nullopt: it leaves the base at the point A.
  std::optional<limbs::Term> pulley_radius = {};
  std::optional<limbs::Term> play = {};  ///< radial play of each passive joint [m]; std::nullopt: not given
  /// Stiffnesses of a round tube: axial E A [N], bending E I and torsional G J [N m^2]; and the area A of its
  /// cross-section [m^2].
  struct Section {
    limbs::Term EA, EI, GJ, area;
  };
  /// Cross-sections of a single rod or of the leg, of the crank, and of the slider. std::nullopt: the part is rigid.
  std::optional<Section> rod_section = {}, crank_section = {}, slider_section = {};
  /// Signed distance [m], in the slider's direction, from the guide in which the slider is clamped to the slider's end
  /// at the rod; std::nullopt: the slider is rigid.
  std::optional<limbs::Term> slider_length = {};
  /// Axes of the universal joints at the base's and the platform's end of the rod or leg, fixed to the bodies there.
  std::optional<std::array<limbs::Vector3, 2>> universal = {};

  /// For a spherical chain of three revolute joints: unit vectors along their axes.
  std::optional<std::array<limbs::Vector3, 3>> axes = {};
  /// Index in the chain of the driven joint, if it is not the joint that `drive` drives (the crank, slider or
  /// telescope).
  std::optional<std::size_t> driven = {};
  /// True: the last joint of a chain of parallel revolute joints is a spherical joint.
  bool ends_in_ball = false;
  /// True: the limb is a chain S P R, whose first joint is a spherical joint.
  bool begins_in_ball = false;
  /// For a chain U P R: first axis of its universal joint, fixed to the base. The second one is `revolute`.
  std::optional<limbs::Vector3> swivel = {};

  /// Whether the direction `revolute` is fixed to the body at the end of the limb, not to the base.
  bool is_hinged_at_end() const { return begins_in_ball || swivel; }
};

/// A limb whose table has the key `across`, a vector `normal` to the plane in which the limb moves. The component of
/// the vector from A to B along `normal` must be the same at every pose.
struct LimbInPlane {
  ConfigValue across;
  limbs::Vector3 A, B, normal;
  bool is_swivel = false;  ///< the vector is NamedLimb::swivel instead
};

/// An unknown of a [[solve]].
struct SolvedUnknown {
  ConfigValue at;  ///< the name of the unknown as it stands in the file
  std::string name;
  std::function<limbs::Term()> value;
};

/// A parameter that belongs to a single limb, such as "arm2.l_b", and its node in the expression graph.
struct OwnParameter : LimbParameter {
  expression::Node node{};
};

/// A sign that selects the working mode: its possible values, and a text for each of them in the names of modes.
struct SignChoice {
  std::string signs;               ///< possible values, the first of which is the default: "+-", "-+", "+" or "-"
  std::vector<std::string> names;  ///< for each value, its text in the names of modes
  /// True: the text follows a "/" at the end of the name of the mode, and is omitted for the default sign.
  bool is_branch = false;
};

/// A mechanism while its file is being read. Each reader adds to it.
struct MechanismDraft {
  generic::Model model;
  MechanismScope scope{model};
  limbs::Vector3 origin{zero(), zero(), zero()};  ///< origin of the platform's frame
  /// Rotation of the platform's frame.
  limbs::Rotation turn{limbs::rotation_about(2, zero(), limbs::Term(model.graph, 1.0))};
  std::vector<PlatformMotion> motions;  ///< the motions of the platform, in the order of the file
  /// The rotations that `turn` does not contain yet, because they follow a dependent angle that has not been read.
  std::vector<PlatformMotion> pending_rotations;
  std::vector<PlatformTurn> turns;           ///< the rotations that `turn` contains
  std::map<std::string, NamedFrame> frames;  ///< all frames of the mechanism, by name
  std::vector<std::string> frame_names;      ///< "base", "platform", and those of the [[frame]] tables
  std::vector<NamedLimb> limbs;
  std::vector<LimbInPlane> in_planes;
  std::vector<SignChoice> sign_choices;  ///< the signs of the working modes, in the order of the graph's inputs

  /// For each joint, the stiffness of its drive [N/m or N m/rad]; std::nullopt: rigid.
  std::vector<std::optional<limbs::Term>> drive_stiffness;
  std::vector<OwnParameter> own;
  /// The table of the selected mass model in [masses]; std::nullopt: there is no [masses].
  std::optional<ConfigValue> masses;
  std::vector<SolvedUnknown> unknowns;  ///< the unknowns of all [[solve]] tables
  std::vector<ConfigValue> let;         ///< the tables [let] of the file and of the selected mass model
  /// Tables of limbs with `chain`, rewritten with the keys of another drive; ConfigValue refers to them.
  std::deque<TomlValue> rewritten;

  limbs::Term zero() { return {model.graph, 0.0}; }
  /// Adds a sign, by which the working modes differ, to the inputs of the graph.
  /// @param first  '+' or '-': the default
  /// @param both   false: `first` is the only possible value
  limbs::Term add_sign(char first, bool both);
};

/// Reads the model of a mechanism file.
/// @param mass_model  name of one of its mass models; "": the first
generic::Model read_mechanism_model(const std::string& text, const std::string& file_name,
                                    const std::vector<LimbParameter>& own, const std::string& mass_model,
                                    const StudyAdditions& study = nullptr);

/// The text that a table has under a key; "" if the key is absent.
std::string text_of(const ConfigValue& table, const std::string& key);
/// Reads a unit that is a product of powers of SI units, such as "N m/rad".
std::string si_unit(const ConfigValue& unit);

/// Adds a parameter that belongs to a single limb to the draft.
void add_own_parameter(const LimbParameter& own, const Parameter& parameter, MechanismDraft& draft);
/// Calls `read` while the parameters that belong to this limb are in scope, also in formulas of [let].
void read_as_limb(const std::string& limb, const std::function<void()>& read, MechanismDraft& draft);
/// The parameters of single limbs that have an effect, because a joint or a limit depends on them.
std::vector<LimbParameter> effective_parameters(const MechanismDraft& draft);
/// Refuses a parameter of a single limb if the limb does not exist, or if no formula of the limb uses the parameter.
void refuse_idle_parameters(const MechanismDraft& draft);

/// Rotation about a coordinate axis. If the angle is a constant such as 90 deg, elements that should be 0, 1 or -1 are
/// exactly so.
limbs::Rotation rotation_by(std::size_t axis, const limbs::Term& angle);
/// Returns true if a node depends on the coordinates of the pose.
bool depends_on_pose(const expression::Graph& graph, expression::Node node);
/// Reads the coordinates of the platform. Those of the key `follows` are read when a formula uses them.
void read_coordinates(const ConfigValue& platform, MechanismDraft& draft);
/// Adds the names of all frames to the names that formulas may use. A frame is read when a formula uses it.
void read_frames(const ConfigValue& root, const ConfigValue& platform, MechanismDraft& draft);
/// Reads the dependent coordinates and frames that no formula has used so far, and the origin of the platform.
void resolve_frames(const ConfigValue& root, const ConfigValue& platform, MechanismDraft& draft);
/// Reads the tables [[limit]].
void read_limits(const ConfigValue& root, MechanismDraft& draft);
/// Reads [inputs]: variables other than the pose. Quantities, and the formulas of [let] that they use, may depend on
/// them.
void read_inputs(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[quantity]] of the file and, if it is not null, of a study. Their formulas may also use
/// "NAME_rate", the time derivative of a coordinate, an input or a quantity.
void read_quantities(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// The force that a limb transmits to the platform, along its rod or leg; without a rod, along the slider's direction.
struct LimbForce {
  limbs::Vector3 force;  ///< unit vector in the direction of the force
  limbs::Term input;     ///< input transmission index of the limb
  limbs::Vector3 end;    ///< the point B of the platform at which the force acts
};
/// The force of a limb; std::nullopt for limbs with drive = "formula" or with two links, which do not transmit a single
/// force.
std::optional<LimbForce> force_of(const NamedLimb& limb);
/// Returns true if a mechanism file or a study has a [[quantity]] with this name.
/// @param study  null if there is none
bool defines_quantity(const ConfigValue& root, const ConfigValue* study, const std::string& name);
/// Adds the transmission indices `lti`, `lti_input` and `lti_output` as quantities, if they are defined for the limbs.
void add_transmission(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Adds a quantity of the pose that mechanisms have without a [[quantity]]. If a file or study uses its name for its
/// own purposes, the quantity is listed as undefined instead.
void add_predefined_quantity(const ConfigValue& root, const ConfigValue* study, const generic::NamedTerm& quantity,
                             MechanismDraft& draft);
/// Adds the quantities of engine/generic/performance/performance.hpp whose data are given by the mechanism file or by
/// the study.
/// @param study  null if there is none
void add_performance(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Reads the limits of a cable's tension.
void read_tension(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft);
/// Reads the table [forces]: how redundant drives share a load, and the loads that the cables have to balance. Adds the
/// margin and the quantities of the cables (engine/generic/performance/tension_limits.hpp).
/// @param study  null if there is none
void add_forces(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Adds the quantity `constraint_singular_value`, if the constraint wrenches of all limbs are known.
void add_constraint_quantity(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft);
/// Reads the elastic moduli of a limb's cross-sections, and the play of its joints.
void read_elasticity(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft);
/// Compliance of the limb's end along the line of its rod or leg, due to rods, crank and slider [m/N].
limbs::Term compliance_of_links(const NamedLimb& limb, MechanismDraft& draft);
/// Compliance of a limb's drive, measured at the joint [m/N or rad/(N m)]; for a telescopic leg, the compliance of the
/// leg is included.
std::optional<limbs::Term> drive_compliance(const NamedLimb& limb, MechanismDraft& draft);
/// The limits that a study sets for quantities, as a table; std::nullopt if it sets none.
std::optional<ConfigValue> limits_of_quantities(const ConfigValue& study);
/// Adds a threshold for each limit of a quantity in the study, [workspace] limits = { NAME = { min = .. } }. It must be
/// called directly after read_limits(), because the number of limits determines the indices of all later inputs of the
/// graph.
void read_quantity_limits(const ConfigValue& study, MechanismDraft& draft);
/// Adds the margins of the limits that the study sets for quantities.
void add_quantity_margins(const ConfigValue& study, MechanismDraft& draft);
/// Reads the table [modes].
void read_modes(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[limb]]. For each limb, adds its joints, loop-closure equations, constraints, ranges, angles,
/// links and bodies.
void read_limbs(const ConfigValue& root, MechanismDraft& draft);
/// Refuses the key `across` of a limb if the component, along this direction, of the vector from the limb's end A to
/// its end B changes with the pose.
void refuse_changing_planes(MechanismDraft& draft);
/// Reads the tables [[margin]] and [[design]].
void read_margins(const ConfigValue& root, MechanismDraft& draft);
/// Refuses signs of [modes] that no formula of a joint or margin uses.
void refuse_idle_signs(const ConfigValue& root, MechanismDraft& draft);
/// Reads the tables [[link]]. @return the links, under the names that [[body]] uses
std::vector<LimbPart> read_links(const ConfigValue& root, MechanismDraft& draft);
/// Adds the limit on the clearance after all other limits, if there are links that could collide.
void add_clearance(MechanismDraft& draft);
/// Reads the table [survey].
void read_survey(const ConfigValue& root, MechanismDraft& draft);
/// Prepares the computation of ranges, by contraction, for the coordinates that have no `box`; coordinates that remain
/// unbounded have no range. To be called when the model has all of its constraints.
void bound_survey(MechanismDraft& draft);
/// Lists all combinations of the signs as working modes, the default first.
void list_modes(MechanismDraft& draft);

/// Adds the body of a part of a limb, if the limb's table gives the part a mass.
void add_part_body(const ConfigValue& table, const std::string& limb, const LimbPart& part, MechanismDraft& draft);
/// Adds the body of a thin link between two points, if its table has a `mass`.
void add_link_body(const ConfigValue& table, const std::string& name, const limbs::Vector3& from,
                   const limbs::Vector3& to, MechanismDraft& draft);
/// Adds the bodies of those [[frame]] tables that have a mass.
void read_frame_bodies(const ConfigValue& root, MechanismDraft& draft);
/// Adds the body of the platform: mass, centre and inertia.
void read_platform_body(const ConfigValue& platform, MechanismDraft& draft);
/// Reads the tables [[body]]. @param links  result of read_links()
void read_bodies(const ConfigValue& root, const std::vector<LimbPart>& links, MechanismDraft& draft);
/// Reads the tables [[joint]], and adds the joints of the limbs, to compute the forces in joints.
void add_joints(const ConfigValue& root, MechanismDraft& draft);
}  // namespace pkm
