// A mechanism as described by its file: names, and all formulas as nodes of one expression graph. The structs whose
// names end in Nodes hold such nodes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/dynamics/force_distribution.hpp"
#include "engine/generic/limbs/limb.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::generic {

using expression::Graph;
using expression::Groups;
using expression::Node;

/// Layout of the graph's inputs, in this order: parameters, thresholds of limits and signs of the working mode (one
/// group); coordinates (one group each); joints, as variables of the loop-closure equations; rates of the coordinates;
/// extra inputs, on which only quantities depend, and their rates; accelerations of the coordinates and of the extra
/// inputs; ends of the ranges of contracted coordinates (in the group of the parameters).
struct Inputs {
  std::size_t parameters = 0, limits = 0, signs = 0, coordinates = 0, joints = 0, extras = 0;

  static constexpr std::size_t kMaxSigns = 8, kMaxExtras = 8;
  static constexpr Groups kDesign = 1, kJoints = 2, kRates = 4U << kMaxCoordinates, kExtras = 8U << kMaxCoordinates;
  static constexpr Groups coordinate_group(std::size_t i) { return 4U << i; }

  std::size_t limit(std::size_t i) const { return parameters + i; }
  std::size_t sign(std::size_t i) const { return limit(limits) + i; }
  std::size_t coordinate(std::size_t i) const { return sign(kMaxSigns) + i; }
  std::size_t joint(std::size_t i) const { return coordinate(coordinates) + i; }
  std::size_t rate(std::size_t i) const { return joint(kMaxJoints) + i; }
  std::size_t extra(std::size_t i) const { return rate(coordinates) + i; }
  std::size_t extra_rate(std::size_t i) const { return extra(kMaxExtras) + i; }
  std::size_t acceleration(std::size_t i) const { return extra_rate(kMaxExtras) + i; }
  std::size_t extra_acceleration(std::size_t i) const { return acceleration(coordinates) + i; }
  /// Lower (side 0) or upper (side 1) end of the range that ContractedBox computes for a coordinate.
  std::size_t range_end(std::size_t i, std::size_t side) const { return extra_acceleration(kMaxExtras) + 2 * i + side; }
  std::size_t count() const { return range_end(coordinates, 0); }
};

/// A named value of a pose or of a design.
struct Result {
  std::string name;
  std::string unit;
  Node node{};
  /// For a constraint in Model::domains: what its violation means, for messages, such as "limb1 cannot reach the pose";
  /// otherwise "".
  std::string consequence{};
};

/// A group of consecutive margins of a model, with indices [first, first + count), that is reported as a single margin:
/// the value of `shown` if it is present, otherwise the minimum of the group.
struct ReportedMargin {
  std::string name, unit;
  std::size_t first = 0, count = 1;
  std::optional<Node> shown{};
};

/// The range of a joint. It depends on the design and may be empty.
struct JointRange {
  std::string joint, unit;
  Node from{}, to{};
};

/// A limit of a pose quantity that is not given by a formula.
struct ReportLimit {
  const PoseQuantity* quantity;
  std::size_t limit;  ///< index among MechanismInfo::limits
  bool is_minimum;    ///< true: the threshold is the minimum of the quantity; false: its maximum
};

/// Name of the limit on the clearance of links.
inline constexpr const char* kClearanceLimit = "clearance_min";

/// A link as a capsule: the ends of its axis and its radius.
struct LinkNodes {
  std::string name, part;
  std::array<Node, 3> from, to;
  Node radius;
  /// Groups to which the link belongs; the clearance of two links with a common group is not tested.
  std::vector<std::string> groups;
  bool has_clearance = true;  ///< false: the link is drawn, but its clearance is not tested
};

/// The terms of limbs::CrankRange as nodes, and the constraints of the model that can be replaced by them.
struct CrankRangeNodes {
  Node at_min, at_max, after_min, before_max, half_turn, reach, branch;
  std::vector<Node> constraints;
};

/// The two quadratic terms of limbs::Annulus as nodes, and the constraints of the model that can be replaced by them.
struct AnnulusNodes {
  std::array<Node, 2> surfaces;
  std::vector<Node> constraints;
  /// Index in Model::crank_ranges of the same limb's crank range; std::nullopt if the limb has no joint range.
  std::optional<std::size_t> crank_range;
};

/// The terms of limbs::RodAndPath and the range of the limb's joint as nodes, and the constraints of the model that can
/// be replaced by both.
struct RodAndPathNodes {
  bool is_circle;
  std::array<Node, 3> v, axis, zero;
  Node crank, rod, branch, from, to;
  std::vector<Node> constraints;
};

/// The inner end C and outer end B of the rod or telescope of a limb. C depends on the joint coordinates only; B is
/// fixed to the platform, or given by a formula.
struct RodNodes {
  std::array<Node, 3> C, B;
};

/// Size of the mechanism, by which the objective workspace-ratio divides.
struct SizeNodes {
  Node node;
  std::string unit, meaning;
};

/// The vectors of limbs::Arm as nodes, and the end B of its rod.
struct ArmNodes {
  std::array<Node, 3> arm, axis, rod, B;
  std::optional<Node> joint;  ///< joint coordinate, if the arm is driven; otherwise std::nullopt
};

/// A coordinate of the platform that follows from the coordinates of the pose.
struct DependentCoordinate {
  std::string name, unit;
  std::string kind;  ///< direction of the motion, such as "along x" or "about z"
  Node node{};
};

/// A frame of the mechanism file.
struct FrameInfo {
  std::string name;
  std::string on;   ///< name of the frame relative to which this frame is defined
  bool is_movable;  ///< true if this frame moves relative to the frame `on`
};

/// A rigid body. Twice its kinetic energy is the sum of the terms below; ' is the time derivative.
struct BodyNodes {
  /// The term weight f' . g' of twice the kinetic energy, for the vectors f and g.
  struct Product {
    std::array<Node, 3> f, g;
    Node weight;
  };
  /// The term weight q'^2 of twice the kinetic energy, for the angle q of an arm.
  struct ArmRotation {
    std::size_t arm;
    Node weight;
  };
  /// The term weight |d x d'|^2 / |d|^4 of twice the kinetic energy, for a slender body along the vector d that does
  /// not spin about d.
  struct LineRotation {
    std::array<Node, 3> d;
    Node weight;
  };
  std::string name;
  Node mass;
  std::array<Node, 3> centre;  ///< position of the centre of mass in the base frame [m]
  std::vector<Product> products;
  std::vector<ArmRotation> arm_rotations;
  std::vector<LineRotation> line_rotations;
  /// Principal moments of inertia about the centre of mass: for a slender body along and across its axis, otherwise
  /// about the axes of the platform frame.
  std::optional<std::array<Node, 3>> inertia{};
  /// Rotation of the axes of `inertia`, by rows; std::nullopt: those of a slender body.
  std::optional<std::array<std::array<Node, 3>, 3>> axes{};
  std::string part_of{};  ///< name of the body to which this body is rigidly attached; "" if there is none
};

/// An elastic beam that is clamped at the point `near` and loaded at the point `far`.
struct BeamNodes {
  std::array<Node, 3> near, far;
  Node EA, EI, GJ;  ///< axial stiffness [N], bending stiffness [N m^2] and torsional stiffness [N m^2]
  Node area;        ///< area of the cross-section [m^2]
};

/// A rigid body of the Newton-Euler equations, in which all joints are replaced by their reactions.
struct SolidNodes {
  std::string name;
  /// Indices in Model::bodies of the bodies that this solid consists of; empty: the solid has no mass.
  std::vector<std::size_t> bodies{};
  /// Fraction of the mass and inertia of `bodies` that belongs to this solid: 1/2 for each of two parallel rods.
  double share = 1;
  std::array<Node, 3> point;  ///< a point that is fixed to the solid
  /// A vector along the body, which rotates with it (without spin about the vector); std::nullopt if there is none.
  std::optional<std::array<Node, 3>> line{};
  /// Offset of the solid's centre of mass from that of `bodies`; std::nullopt: there is none.
  std::optional<std::array<Node, 3>> centre_offset{};
  bool is_platform = false;  ///< true: the solid is the platform
  /// Rotation of the platform or of a [[frame]], by rows; std::nullopt: the body rotates with `line`, if at all.
  std::optional<std::array<std::array<Node, 3>, 3>> rotation{};

  /// The elasticity of a solid as a beam: one of its joints clamps it, all other joints load it.
  struct Beam : BeamNodes {
    std::size_t near_joint;  ///< index of the joint that clamps the beam
    bool is_rod;             ///< true: a rod, pinned at both ends; false: a crank
  };
  std::optional<Beam> beam{};  ///< elasticity of the solid; std::nullopt: it is rigid
};

/// A joint between two solids, or between a solid and the base.
struct JointNodes {
  /// Which couples the joint transmits: `along`, only those about its `axes`; `all_but_about`, all that are normal to
  /// its `axes`.
  enum class Couples { along, all_but_about };
  struct Drive {
    std::size_t joint;
    std::array<Node, 3> axis;
    bool turns = false;  ///< true: the driven joint is revolute; false: prismatic
    /// Index in Model::bodies of the slide, a point mass that moves with the drive; std::nullopt if there is none.
    std::optional<std::size_t> slide{};
    std::optional<Node> compliance{};  ///< compliance of the drive [m/N or rad/(N m)]; std::nullopt: it is rigid
    /// Elasticity of the slide, which is loaded by all joints that have this drive; std::nullopt: it is rigid.
    std::optional<BeamNodes> ram{};
  };
  std::string name;
  std::array<Node, 3> point;
  std::size_t on;                   ///< index of one of the two solids that the joint connects
  std::optional<std::size_t> from;  ///< index of the other one of the two solids; std::nullopt: the base
  Couples couples;
  std::vector<std::array<Node, 3>> axes;
  std::optional<Drive> drive{};
  /// For a universal joint: its axis on the body that carries the rod, and the index of the rod's solid.
  struct Universal {
    std::array<Node, 3> axis;
    std::size_t rod;
  };
  std::optional<Universal> universal{};
  /// True if the platform is a pin, i.e. a point about which several rods rotate, and if this joint attaches it to its
  /// rod. Otherwise the rotation of the platform, which has no effect, would be undetermined.
  bool holds_pin = false;
};

/// All bodies and joints, for reactions in the joints and for the mobility of the platform.
struct JointedBodies {
  std::vector<SolidNodes> solids;
  std::vector<JointNodes> joints;
};

/// A mass or an inertia, which has to be positive.
struct MassCheck {
  std::string name;  ///< name for messages, such as "the mass of rod 11"
  std::string unit;
  Node node;
  bool may_vanish;
};

/// The matrices and vectors of PoseDynamics as nodes, which depend on the coordinates and their rates; matrices are
/// row-major.
struct EquationNodes {
  std::vector<Node> J, J_rate_X, M_X, h_X, G_X, J_wrench;
};

/// The balance of the loads by drives with limits of the tension, which a margin states.
struct BalanceNodes {
  struct Loads {
    std::vector<Node> centre;                  ///< by coordinate
    std::vector<std::vector<Node>> half_axes;  ///< the loads are centre + sum of u_k half_axes[k] for all |u_k| <= 1
  };
  Node margin{};
  std::vector<Node> J;       ///< joints x coordinates, row by row
  std::vector<Loads> loads;  ///< sets of loads; empty: the tensions balance each other (wrench closure)
};

class ContractedBox;

/// A mechanism as described by its file. Constraints are satisfied if they are >= 0. Vectors are in the base frame.
struct Model {
  MechanismInfo info;
  Graph graph;
  Inputs inputs;
  std::vector<std::vector<double>> signs;  ///< signs of each working mode, by mode

  // The following members describe the kinematics.

  std::vector<Node> joints, closures;  ///< formulas of the joint coordinates; left sides of the loop-closure equations
  std::vector<Result> domains;         ///< constraints under which the pose assembles
  std::vector<Result> margins;         ///< constraints that a feasible pose has to satisfy in addition
  /// Constraints 0 * formula >= 0, each of which is satisfied if and only if its formula has a finite value.
  std::vector<Node> defined;
  /// Unit of those domains and margins that depend on the pose; "" if they have different units.
  std::string margin_unit;
  std::vector<ReportedMargin> reported_margins;
  std::vector<CrankRangeNodes> crank_ranges;
  std::vector<AnnulusNodes> annuli;
  std::vector<RodAndPathNodes> paths;
  std::vector<Node> quantities;  ///< formulas of the quantities, in the order of MechanismInfo::quantities
  std::vector<ReportLimit> report_limits;
  /// Bounds of the joint errors [m, rad] that the quantity `accuracy` assumes, by joint; empty if there are none.
  std::vector<Node> joint_errors;
  std::vector<Result> angles;  ///< angles of the passive joints

  // The following members describe the platform frame and the other frames.

  std::array<Node, 3> origin;
  std::array<std::array<Node, 3>, 3> rotation;  ///< rotation matrix, by rows
  std::vector<DependentCoordinate> dependent;   ///< coordinates that follow from the others
  std::vector<FrameInfo> frames;                ///< frames of the mechanism file
  /// Axis of the rotation that a coordinate describes, 0 to 2, by coordinate; std::nullopt if it describes none.
  std::vector<std::optional<std::size_t>> rotation_axes;
  /// Angular velocity of the platform for a unit rate of a coordinate, by coordinate.
  std::vector<std::array<Node, 3>> rotation_directions;
  /// Axis of the translation that a coordinate describes, 0 to 2, by coordinate; std::nullopt if none.
  std::vector<std::optional<std::size_t>> translation_axes;

  // The following members describe the design: its checks, size, characteristic lengths and thresholds.

  std::vector<JointRange> ranges;
  std::vector<Result> required;  ///< constraints that a design has to satisfy to describe a mechanism
  std::vector<DesignMarginInfo> tests;
  std::vector<Node> test_nodes;
  std::optional<SizeNodes> size;
  /// Characteristic length (of rotations) and characteristic radius (of revolute drives) of the conditioning;
  /// std::nullopt if the file does not define them.
  std::optional<Node> length, radius;
  /// Indices of the coordinates that the conditioning includes; empty: all.
  std::vector<std::size_t> conditioning_coordinates;
  /// For each limit, the threshold that follows from the design; std::nullopt if the file gives no formula for it.
  std::vector<std::optional<Node>> derived;
  /// For each limit, the index of the parameter with the same name, whose value is the default threshold; std::nullopt
  /// if there is no such parameter.
  std::vector<std::optional<std::size_t>> limit_parameters;

  // The following members describe the ranges in which workspace analyses search the coordinates.

  /// Range of each coordinate that a workspace analysis searches; std::nullopt if neither the file nor the constraints
  /// bound it.
  std::vector<std::optional<std::array<Node, 2>>> box;
  /// By coordinate, whether its range is computed by contraction of the constraints; `box` is then Inputs::range_end().
  std::vector<bool> is_contracted;
  std::shared_ptr<const ContractedBox> contracted_box;  ///< null if no coordinate is contracted
  /// Constraints >= 0 on the distances that the limbs can span, which follow from the other constraints.
  std::vector<Node> reach_constraints;
  /// Range of each coordinate outside of which no pose is feasible; std::nullopt if the mechanism file defines none.
  std::vector<std::optional<std::array<Node, 2>>> reach;
  /// Value at which an analysis fixes a coordinate by default, by coordinate; std::nullopt if the mechanism file does
  /// not define it.
  std::vector<std::optional<Node>> default_values;

  // The following members describe the links.

  std::vector<LinkNodes> links;
  std::vector<LinkPair> link_pairs;       ///< pairs of indices of links whose clearance is tested
  std::vector<std::size_t> moving_links;  ///< indices of the links whose clearance from obstacles is tested
  /// Index of the clearance limit among MechanismInfo::limits; std::nullopt if there is none. The clearance limit is
  /// not an input of the graph, and is listed after all limits that are inputs.
  std::optional<std::size_t> clearance_limit;
  std::vector<RodNodes> rods;  ///< rods of those limbs that have a rod

  // The following members describe masses, drive forces and reactions.

  std::vector<ArmNodes> arms;
  std::vector<BodyNodes> bodies;
  std::vector<MassCheck> masses;
  std::optional<std::array<Node, 3>> wrench_point;  ///< point of the platform at which a wrench acts
  std::optional<EquationNodes> equations;           ///< present if there are bodies
  std::vector<Node> jacobian;                       ///< EquationNodes::J, also computed for models without bodies
  std::optional<JointedBodies> jointed;             ///< present if the file describes all joints
  /// Minimum and maximum tension [N] of the cable that drives a joint, by joint; std::nullopt: it is no cable.
  std::vector<std::optional<std::array<Node, 2>>> tensions;
  std::optional<BalanceNodes> balance;  ///< present if there are cables
  /// How redundant drives share a load, and the force or torque by which that of each drive is divided in the norm that
  /// is minimised, by joint; empty: equal for all drives.
  ForceSharing sharing = ForceSharing::least_norm;
  std::vector<Node> force_scales;
  /// Peak force or torque of each drive [N, N m], by joint; empty if the file defines none.
  std::vector<std::optional<Node>> peak_forces;
  std::string why_no_reactions, why_no_elasticity;
  std::vector<std::string> mass_models;  ///< names of the mass models; the first one is the default
  std::string mass_model;                ///< name of the mass model in use
  /// Builds the same mechanism with another mass model.
  std::function<std::shared_ptr<const Mechanism>(const std::string& mass_model)> with_masses;

  limbs::Term term(Node node) { return {graph, node}; }
  /// The node of a coordinate's value.
  Node coordinate(std::size_t i) { return graph.input(inputs.coordinate(i), Inputs::coordinate_group(i)); }
};

}  // namespace pkm::generic
