// A mechanism as described by its file: names, and all formulas as nodes of one expression graph. The structs whose
// names end in Nodes hold such nodes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/generic/limbs/limb.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::generic {

using expression::Graph;
using expression::Groups;
using expression::Node;

/// Layout of the graph's inputs, in this order: parameters, thresholds of limits and signs of the working mode (one
/// group); coordinates (one group each); joints, as variables of the loop-closure equations; rates of the coordinates;
/// extra inputs, on which only quantities depend, and their rates; accelerations of the coordinates and of the extra
/// inputs.
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
  std::size_t count() const { return extra_acceleration(kMaxExtras); }
};

/// A named value of a pose or of a design.
struct Result {
  std::string name;
  std::string unit;
  Node node{};
  std::string consequence{};  ///< of a domain: what its violation means, such as "limb1 cannot reach the pose"
};

/// Margins [first, first + count) of a model that are reported as a single margin: the value of `shown` if there is
/// one, otherwise their minimum.
struct ReportedMargin {
  std::string name;
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
  bool is_minimum;    ///< false: the threshold is the maximum
};

/// Name of the limit on the clearance of links.
inline constexpr const char* kClearanceLimit = "clearance_min";

/// A link as a capsule: the ends of its axis and its radius.
struct LinkNodes {
  std::string name, part;
  std::array<Node, 3> from, to;
  Node radius;
  std::vector<std::string> groups;  ///< the clearance of links with a common group is not tested
  bool has_clearance = true;        ///< false: the link is only drawn
};

/// The terms of limbs::CrankRange, and the constraints of poses that are equivalent to it.
struct CrankRangeNodes {
  Node at_min, at_max, after_min, before_max, half_turn, reach, branch;
  std::vector<Node> constraints;
};

/// The two surfaces of limbs::Annulus, and the constraints of poses that are equivalent to it.
struct AnnulusNodes {
  std::array<Node, 2> surfaces;
  std::vector<Node> constraints;
  std::optional<std::size_t> crank_range;  ///< index in Model::crank_ranges of that of the same limb
};

/// The terms of limbs::RodAndPath, the range of the joint, and the constraints of poses that are equivalent to both.
struct RodAndPathNodes {
  bool is_circle;
  std::array<Node, 3> v, axis, zero;
  Node crank, rod, branch, from, to;
  std::vector<Node> constraints;
};

/// The ends C and B of the rod or telescope of a limb. C is fixed for given joints; B is fixed to the platform, or
/// given by a formula.
struct RodNodes {
  std::array<Node, 3> C, B;
};

/// Size of the mechanism, for the objective workspace-ratio.
struct SizeNodes {
  Node node;
  std::string unit, meaning;
};

/// The vectors of limbs::Arm, and the end B of its rod.
struct ArmNodes {
  std::array<Node, 3> arm, axis, rod, B;
  std::optional<Node> joint;  ///< the joint coordinate, if the arm is driven
};

/// A rigid body. Twice its kinetic energy is the sum of the terms below; ' is the time derivative.
struct BodyNodes {
  /// weight f' . g'
  struct Product {
    std::array<Node, 3> f, g;
    Node weight;
  };
  /// weight q'^2 for the angle q of an arm
  struct ArmRotation {
    std::size_t arm;
    Node weight;
  };
  /// weight |d x d'|^2 / |d|^4, for a slender body along d that does not spin about d
  struct LineRotation {
    std::array<Node, 3> d;
    Node weight;
  };
  std::string name;
  Node mass;
  std::array<Node, 3> centre;  ///< of mass
  std::vector<Product> products;
  std::vector<ArmRotation> arm_rotations;
  std::vector<LineRotation> line_rotations;
  /// Principal moments about the centre of mass: of a slender body along and across its line, of the platform about the
  /// axes of its frame.
  std::optional<std::array<Node, 3>> inertia{};
  std::string part_of{};  ///< the body to which this one is rigidly attached; "": none
};

/// An elastic beam that is clamped at `near` and loaded at `far`.
struct BeamNodes {
  std::array<Node, 3> near, far;
  Node EA, EI, GJ;  ///< axial [N], bending and torsional stiffness [N m^2]
  Node area;        ///< of the cross-section [m^2]
};

/// A free body of the Newton-Euler equations.
struct SolidNodes {
  std::string name;
  std::vector<std::size_t> bodies{};                   ///< bodies of the model that it consists of; empty: massless
  double share = 1;                                    ///< fraction of their inertia: 1/2 for one of two parallel rods
  std::array<Node, 3> point;                           ///< a point of the body
  std::optional<std::array<Node, 3>> line{};           ///< the body rotates with this direction, without spin about it
  std::optional<std::array<Node, 3>> centre_offset{};  ///< of its centre of mass from that of its bodies
  bool with_platform = false;                          ///< the body rotates with the platform

  /// An elastic body, loaded by all of its joints but one.
  struct Beam : BeamNodes {
    std::size_t near_joint;  ///< index of the joint that holds it
    bool is_rod;             ///< pinned at both ends; false: a crank
  };
  std::optional<Beam> beam{};  ///< std::nullopt: rigid
};

/// A joint between two solids, or between a solid and the base.
struct JointNodes {
  /// The couples that the joint transmits: about its `axes`, or about all directions normal to them.
  enum class Couples { along, all_but_about };
  struct Drive {
    std::size_t joint;
    std::array<Node, 3> axis;
    bool turns = false;                  ///< true: revolute; false: prismatic
    std::optional<std::size_t> slide{};  ///< body (a point mass) that moves with the drive
    std::optional<Node> compliance{};    ///< [m/N or rad/(N m)]; std::nullopt: rigid
    std::optional<BeamNodes> ram{};      ///< elastic slide, loaded by all joints with this drive
  };
  std::string name;
  std::array<Node, 3> point;
  std::size_t on;                   ///< index of one solid
  std::optional<std::size_t> from;  ///< index of the other solid; std::nullopt: the base
  Couples couples;
  std::vector<std::array<Node, 3>> axes;
  std::optional<Drive> drive{};
  /// Of a universal joint: its axis on the body that carries the rod, and the index of the rod's solid.
  struct Universal {
    std::array<Node, 3> axis;
    std::size_t rod;
  };
  std::optional<Universal> universal{};
  /// The platform is a pin, a point that several rods rotate about, and this joint makes it part of its rod: its own
  /// rotation, without effect, would be undetermined.
  bool holds_pin = false;
};

/// All bodies and joints, for reactions in the joints and for the mobility of the platform.
struct JointedBodies {
  std::vector<SolidNodes> solids;
  std::vector<JointNodes> joints;
};

/// A mass or an inertia, which has to be positive.
struct MassCheck {
  std::string name;  ///< "the mass of rod 11"
  std::string unit;
  Node node;
  bool may_vanish;
};

/// The members of PoseDynamics as functions of the coordinates and their rates; matrices row-major.
struct EquationNodes {
  std::vector<Node> J, J_rate_X, M_X, h_X, G_X, J_wrench;
};

/// All constraints are satisfied if >= 0. Vectors are in the base frame.
struct Model {
  MechanismInfo info;
  Graph graph;
  Inputs inputs;
  std::vector<std::vector<double>> signs;  ///< by working mode

  // kinematics
  std::vector<Node> joints, closures;  ///< joint coordinates as functions of the pose; loop-closure equations
  std::vector<Result> domains;         ///< constraints under which the pose assembles
  std::vector<Result> margins;         ///< constraints of a feasible pose
  std::vector<Node> defined;           ///< 0 times a formula: satisfied if the formula is finite
  std::string margin_unit;             ///< common unit of domains and margins that depend on the pose; "": they differ
  std::vector<ReportedMargin> reported_margins;
  std::vector<CrankRangeNodes> crank_ranges;
  std::vector<AnnulusNodes> annuli;
  std::vector<RodAndPathNodes> paths;
  std::vector<Node> quantities;  ///< in the order of MechanismInfo::quantities
  std::vector<ReportLimit> report_limits;
  std::vector<Node> joint_errors;  ///< bounds that the quantity `accuracy` assumes, by joint [m, rad]; or empty
  std::vector<Result> angles;      ///< of passive joints

  // platform frame
  std::array<Node, 3> origin;
  std::array<std::array<Node, 3>, 3> rotation;               ///< rotation matrix, by rows
  std::vector<std::optional<std::size_t>> rotation_axes;     ///< by coordinate: axis of a rotation, 0 to 2
  std::vector<std::array<Node, 3>> rotation_directions;      ///< by coordinate: that axis as a unit vector, or 0
  std::vector<std::optional<std::size_t>> translation_axes;  ///< by coordinate: axis of a translation, 0 to 2

  // design
  std::vector<JointRange> ranges;
  std::vector<Result> required;  ///< constraints that a design has to satisfy to describe a mechanism
  std::vector<DesignMarginInfo> tests;
  std::vector<Node> test_nodes;
  std::optional<SizeNodes> size;
  std::optional<Node> length, radius;                        ///< characteristic length and radius of the conditioning
  std::vector<std::size_t> conditioning_coordinates;         ///< those that the conditioning includes; empty: all
  std::vector<std::optional<Node>> derived;                  ///< by limit: threshold derived from the design
  std::vector<std::optional<std::size_t>> limit_parameters;  ///< by limit: parameter of its name, the default threshold

  // workspace analysis, by coordinate
  std::vector<std::optional<std::array<Node, 2>>> box;    ///< range that is searched
  std::vector<std::optional<std::array<Node, 2>>> reach;  ///< range outside of which no pose is feasible
  std::vector<std::optional<Node>> default_values;        ///< of a fixed coordinate

  // links
  std::vector<LinkNodes> links;
  std::vector<LinkPair> link_pairs;            ///< pairs whose clearance is tested
  std::vector<std::size_t> moving_links;       ///< links whose clearance from obstacles is tested
  std::optional<std::size_t> clearance_limit;  ///< index among the limits, after those that are inputs of the graph
  std::vector<RodNodes> rods;                  ///< of the limbs that have one

  // dynamics
  std::vector<ArmNodes> arms;
  std::vector<BodyNodes> bodies;
  std::vector<MassCheck> masses;
  std::optional<std::array<Node, 3>> wrench_point;  ///< where a wrench acts on the platform
  std::optional<EquationNodes> equations;           ///< present if there are bodies
  std::vector<Node> jacobian;                       ///< EquationNodes::J, present without bodies, too
  std::optional<JointedBodies> jointed;             ///< present if the file describes all joints
  std::vector<std::optional<Node>> peak_forces;     ///< of the drives, by joint [N, N m]; or empty
  std::string why_no_reactions, why_no_elasticity;
  std::vector<std::string> mass_models;  ///< the first is the default
  std::string mass_model;                ///< the selected one
  /// Builds the same mechanism with another mass model.
  std::function<std::shared_ptr<const Mechanism>(const std::string& mass_model)> with_masses;

  limbs::Term term(Node node) { return {graph, node}; }
};

}  // namespace pkm::generic
