// A mechanism as its file describes it: names, and one expression graph from which everything is computed.
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

/// Positions of the graph's inputs, and the groups that they form: parameters, thresholds and signs of the working mode
/// (one group); each coordinate; the joints, as variables of the loop-closure equations; the rates of coordinates;
/// extra inputs, on which quantities alone depend, and their rates; the accelerations of both.
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

/// A named number of a pose or of a design.
struct Result {
  std::string name;
  std::string unit;
  Node node{};
  std::string consequence{};  ///< of a violated domain: "limb1 cannot reach the pose"
};

/// Margins that are reported as one: the value of `shown`, else the minimum of margins [first, first + count).
struct ReportedMargin {
  std::string name;
  std::size_t first = 0, count = 1;
  std::optional<Node> shown{};
};

/// The range of a joint, which is empty for some designs.
struct JointRange {
  std::string joint, unit;
  Node from{}, to{};
};

/// The name of the limit of the links' clearance.
inline constexpr const char* kClearanceLimit = "clearance_min";

struct LinkNodes {
  std::string name, part;
  std::array<Node, 3> from, to;
  Node radius;
  std::vector<std::string> groups;  ///< links of one group need not keep clear of each other
  bool has_clearance = true;        ///< false: it is drawn only
};

/// limbs::CrankRange, and the conditions that it stands for in a survey.
struct CoveredRange {
  Node at_min, at_max, after_min, before_max, half_turn, reach, branch;
  std::vector<Node> conditions;
};

/// limbs::Folds, and the conditions that they stand for in a survey.
struct CoveredFolds {
  std::array<Node, 2> surfaces;
  std::vector<Node> conditions;
  std::optional<std::size_t> crank_range;  ///< of the same limb
};

/// The rod or telescope of a limb. For given joints C is fixed; B is fixed in the platform, or stated by a formula.
struct RodNodes {
  std::array<Node, 3> C, B;
};

/// What the design's size is, for workspace-ratio.
struct SizeNodes {
  Node node;
  std::string unit, meaning;
};

/// limbs::Arm, whose rates equations of motion take from there. B is the rod's other end.
struct ArmNodes {
  std::array<Node, 3> arm, axis, rod, B;
  std::optional<Node> joint;  ///< where the turn is a joint
};

/// A rigid body by twice its kinetic energy: the sum of these.
struct BodyNodes {
  /// weight f' . g'
  struct Product {
    std::array<Node, 3> f, g;
    Node weight;
  };
  /// weight turn'^2
  struct ArmTurn {
    std::size_t arm;
    Node weight;
  };
  /// weight |d x d'|^2 / |d|^4: a line turns with d, without spin about it.
  struct LineTurn {
    std::array<Node, 3> d;
    Node weight;
  };
  std::string name;
  Node mass;
  std::array<Node, 3> centre;  ///< of mass
  std::vector<Product> products;
  std::vector<ArmTurn> arm_turns;
  std::vector<LineTurn> line_turns;
  std::optional<std::array<Node, 3>> inertia{};  ///< about the centre: along and across a line, or of the platform
  std::string part_of{};                         ///< the body that it turns with as one; "": it is one itself
};

/// One body of Newton's and Euler's equations.
struct SolidNodes {
  std::string name;
  std::vector<std::size_t> bodies{};            ///< of the model, that it is made of; none: it has no mass
  double share = 1;                             ///< of their masses and inertias: half for one of two rods
  std::array<Node, 3> place;                    ///< a point of it
  std::optional<std::array<Node, 3>> line{};    ///< that it turns with, without spin about it
  std::optional<std::array<Node, 3>> beside{};  ///< where its centre lies beside that of its bodies
  bool with_platform = false;                   ///< it turns with the platform
};

/// A joint of two of them, or of one and the base.
struct JointNodes {
  enum class Couples { along, all_but_about };
  struct Drive {
    std::size_t joint;
    std::array<Node, 3> axis;
    bool turns = false;
    std::optional<std::size_t> slide{};  ///< a point mass of the model that it moves, too
  };
  std::string name;
  std::array<Node, 3> point;
  std::size_t on;                   ///< solid
  std::optional<std::size_t> from;  ///< none: the base
  Couples couples;                  ///< that it carries: along some axes, or all but those about the axes it turns on
  std::vector<std::array<Node, 3>> axes;
  std::optional<Drive> drive{};
};

/// All bodies and joints, where a file describes them enough for the forces in the joints.
struct JointedBodies {
  std::vector<SolidNodes> solids;
  std::vector<JointNodes> joints;
};

/// A number that has to be positive for a design to have masses.
struct MassCheck {
  std::string name;  ///< "the mass of rod 11"
  std::string unit;
  Node node;
  bool may_vanish;
};

/// What the equations of motion are made of, by coordinates and their rates (PoseDynamics); matrices by rows.
struct EquationNodes {
  std::vector<Node> J, J_rate_X, M_X, h_X, G_X, J_wrench;
};

struct Model {
  MechanismInfo info;
  Graph graph;
  Inputs inputs;
  std::vector<std::vector<double>> signs;  ///< by mode
  std::vector<Node> joints, closures;
  std::vector<Result> domains;  ///< >= 0 where the pose assembles
  std::vector<Result> margins;  ///< >= 0 where it is feasible
  std::string margin_unit;      ///< of all domains and margins that depend on the pose; "": they differ
  std::vector<ReportedMargin> reported_margins;
  std::vector<JointRange> ranges;
  std::vector<Result> required;  ///< of the design alone: >= 0, or it describes no mechanism
  std::vector<Node> quantities;  ///< of MechanismInfo::quantities
  std::vector<Result> angles;    ///< of passive joints
  std::vector<Node> defined;     ///< >= 0 where formulas have a value: 0 times them
  std::vector<CoveredRange> crank_ranges;
  std::vector<CoveredFolds> folds;
  std::vector<LinkNodes> links;
  std::vector<LinkPair> link_pairs;            ///< those that have to keep clear
  std::vector<std::size_t> moving_links;       ///< which keep clear of obstacles
  std::optional<std::size_t> clearance_limit;  ///< where there are some: its place among the limits, behind those of
                                               ///< the graph
  std::vector<DesignMarginInfo> tests;
  std::vector<Node> test_nodes;
  std::optional<SizeNodes> size;
  std::optional<Node> length, radius;                     ///< characteristic: of conditioning
  std::vector<std::size_t> conditioned;                   ///< coordinates that count in the conditioning; empty: all
  std::vector<std::optional<Node>> derived;               ///< thresholds, by limit
  std::vector<std::optional<std::size_t>> replaced;       ///< by limit: the parameter of its name, whose value it takes
  std::vector<std::optional<std::array<Node, 2>>> box;    ///< by coordinate
  std::vector<std::optional<std::array<Node, 2>>> reach;  ///< by coordinate: outside it no pose is feasible
  std::vector<std::optional<Node>> middle;                ///< by coordinate: where a survey holds it
  std::vector<std::optional<std::size_t>> turns_about;    ///< by coordinate: the axis of a rotation, 0 to 2
  std::vector<std::array<Node, 3>> turn_axes;             ///< by coordinate: the same in the base's frame; 0: none
  std::vector<std::optional<std::size_t>> moves_along;    ///< by coordinate: the axis of a translation, 0 to 2
  std::array<Node, 3> origin;                             ///< of the platform's frame, in the base's
  std::array<std::array<Node, 3>, 3> turn;                ///< rotation matrix of the platform, by rows
  std::vector<RodNodes> rods;                             ///< of the limbs that have one
  std::vector<ArmNodes> arms;
  std::vector<BodyNodes> bodies;
  std::vector<MassCheck> masses;
  std::optional<std::array<Node, 3>> wrench_point;  ///< where a wrench acts on the platform
  std::optional<EquationNodes> equations;           ///< where there are bodies
  std::vector<Node> jacobian;                       ///< EquationNodes::J, with bodies or without
  std::optional<JointedBodies> jointed;             ///< where there are bodies, and joints for them
  std::string why_no_reactions;
  std::vector<std::string> mass_models;  ///< alternatives of the file; the first is the default
  std::string mass_model;                ///< the one in force
  /// The same mechanism with the masses of another alternative.
  std::function<std::shared_ptr<const Mechanism>(const std::string& mass_model)> with_masses;

  limbs::Term term(Node node) { return {graph, node}; }
};

}  // namespace pkm::generic
