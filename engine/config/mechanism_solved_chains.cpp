// Reads a limb that is a serial chain of joints without a closed form: its joint coordinates solve the loop-closure
// equations by Newton's method (engine/expression/implicit_system.hpp).
//
// The file describes the chain in its reference configuration, in which all joint coordinates are 0, and Newton's
// method starts from there. The position and rotation of the last link are products of exponentials (K. Lynch, F. Park,
// "Modern Robotics", 2017, section 4.1). A chain with a spherical joint is cut there, which leaves three equations.

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/config/mechanism_chains.hpp"
#include "engine/config/mechanism_solve.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/expression/program.hpp"
#include "engine/math/halton.hpp"

namespace pkm {
namespace {

using expression::Node;
using limbs::Rotation, limbs::Term, limbs::Vector3;

constexpr std::size_t kBody = 6;  // degrees of freedom of a rigid body
// Maximum residual of a constrained chain, relative to its length, or in rad. It only has to separate a solution from
// other configurations, in which the equations that are solved hold, but the chain is open.
constexpr double kMaxOpening = 0.01;

/// A revolute or prismatic axis. Universal and cylindrical joints have two of them, spherical joints none.
struct JointAxis {
  std::size_t joint;  ///< index of its joint in the chain
  bool turns;
  Vector3 direction;  ///< unit vector in the reference configuration
  std::string name;   ///< of its coordinate: "q2", or "q2_1" if the joint has two axes
  const char* unit() const { return turns ? "rad" : "m"; }
};

/// A chain in its reference configuration, and the platform at the present pose.
struct SerialChain {
  std::size_t joints;  ///< number of joints
  std::size_t cut;     ///< index of the spherical joint; `joints` if there is none
  std::vector<JointAxis> axes;
  std::vector<Vector3> links;  ///< from each joint to the next
  Vector3 A, B;                ///< first joint, on the base; last joint, on the platform
  Rotation platform;           ///< rotation of the platform from the reference configuration

  bool is_spherical_cut() const { return cut < joints; }
  /// Equations of a chain that does not constrain the body at its end.
  std::size_t equations() const { return is_spherical_cut() ? 3 : kBody; }
};

/// A chain with values of its joint coordinates.
struct PlacedChain {
  std::vector<Vector3> joints;  ///< positions of the joints; one that slides: of its moving part
  Vector3 opening;  ///< vector between the two parts at the cut, or from the end of the chain to the platform
  std::optional<Rotation> turn;  ///< rotation from the end of the chain to the platform; std::nullopt: spherical joint
};

PlacedChain placed(const SerialChain& chain, const std::vector<Term>& q) {
  const Term zero(q.front().graph(), 0.0), one(q.front().graph(), 1.0);
  const Vector3 origin{zero, zero, zero};
  std::vector<Vector3> joints(chain.joints, origin);
  // The part from the base to the cut.
  Rotation R = limbs::rotation_about(2, zero, one);
  Vector3 p = chain.A;
  for (std::size_t j = 0; j < chain.joints; ++j) {
    if (j > 0) p = p + R * chain.links[j - 1];
    if (j == chain.cut) break;
    for (std::size_t i = 0; i < q.size(); ++i)
      if (chain.axes[i].joint == j && chain.axes[i].turns)
        R = R * limbs::rotation_about(chain.axes[i].direction, q[i]);
      else if (chain.axes[i].joint == j)
        p = p + R * chain.axes[i].direction * q[i];
    joints[j] = p;
  }
  if (!chain.is_spherical_cut()) return {joints, chain.B - p, chain.platform * expression::transpose(R)};
  joints[chain.cut] = p;
  // The part from the platform back to the cut.
  Rotation S = chain.platform;
  Vector3 r = chain.B;
  for (std::size_t j = chain.joints; j-- > chain.cut + 1;) {
    joints[j] = r;
    for (std::size_t i = q.size(); i-- > 0;)
      if (chain.axes[i].joint == j && chain.axes[i].turns)
        S = S * limbs::rotation_about(chain.axes[i].direction, -q[i]);
      else if (chain.axes[i].joint == j)
        r = r - S * chain.axes[i].direction * q[i];
    r = r - S * chain.links[j - 1];
  }
  return {joints, r - p, {}};
}

/// The vector part sin(angle) axis of a rotation.
Vector3 vector_part(const Rotation& R) {
  return {(R[2][1] - R[1][2]) * 0.5, (R[0][2] - R[2][0]) * 0.5, (R[1][0] - R[0][1]) * 0.5};
}

/// Sum of the lengths of the links; 1 m if all are 0.
Term size_of(const SerialChain& chain, MechanismDraft& draft) {
  Term sum = draft.zero();
  for (const Vector3& link : chain.links) sum = sum + limbs::length(link);
  draft.scope.mark_as_defined(sum.node());
  return draft.scope.at_default(sum) > 0 ? sum : Term(draft.model.graph, 1.0);
}

/// The equations, as many as there are unknowns: if the chain constrains the platform, its opening is projected onto
/// the motions that the joints permit in the reference configuration.
std::vector<Node> equations_of(const SerialChain& chain, const PlacedChain& at, const Term& size) {
  const Vector3& e = at.opening;
  std::vector<Node> equations;
  const auto add = [&](const Vector3& v) {
    for (const Term& component : v) equations.push_back(component.node());
  };
  if (chain.axes.size() == chain.equations()) {
    add(e);
    if (at.turn) add(vector_part(*at.turn));
    return equations;
  }
  Vector3 end = chain.A;
  for (std::size_t j = 0; j + 1 < chain.joints && j < chain.cut; ++j) end = end + chain.links[j];
  for (const JointAxis& axis : chain.axes) {
    Vector3 joint = chain.A;
    for (std::size_t j = 0; j < axis.joint; ++j) joint = joint + chain.links[j];
    Term motion = dot(axis.turns ? cross(axis.direction, end - joint) : axis.direction, e);
    if (axis.turns && at.turn) motion = motion + dot(axis.direction, vector_part(*at.turn)) * size * size;
    equations.push_back(motion.node());
  }
  return equations;
}

SerialChain read_serial_chain(const LimbCopy& copy) {
  const Chain& limb = *copy.chain;
  const ConfigValue& table = copy.table;
  MechanismDraft& draft = copy.draft;
  const std::size_t n = limb.joints.size();
  if (std::ranges::count(limb.joints, 'S') > 1)
    throw limb.table.find("chain")->refusal(
        "two spherical joints do not determine the rotation of the links between them; expected at most one");
  const Rotation& of_base = copy.base.at.rotation;
  const auto placed_in = [&](const NamedFrame& frame, const ConfigValue& point) {
    return frame.at.origin + frame.at.rotation * (copy.turn * draft.scope.point_of_design(point, copy.group));
  };
  SerialChain chain{.joints = n,
                    .cut = std::min(limb.joints.find('S'), n),
                    .axes = {},
                    .links = {},
                    .A = placed_in(copy.base, copy.ends.at("base", "the position of the first joint [x, y, z]")),
                    .B = placed_in(copy.platform, copy.ends.at("platform", "the position of the last joint [x, y, z]")),
                    .platform = copy.platform.at.rotation * expression::transpose(of_base)};
  std::size_t count = 0;
  for (const char joint : limb.joints) count += joint == 'S' ? 0 : joint == 'U' ? 2 : 1;
  const std::string expected = "the directions of the " + std::to_string(count) +
                               " axes of the chain in its reference configuration, each [x, y, z]; U has two, C one";
  const ConfigValue list = table.at("axes", expected);
  const std::vector<ConfigValue> axes = list.elements(expected);
  std::size_t next = 0;
  for (std::size_t j = 0; j < n; ++j) {
    const char joint = limb.joints[j];
    if (joint == 'S') continue;
    const std::string name = "q" + std::to_string(j + 1);
    const bool is_single = joint == 'P' || joint == 'R';
    if (next + (joint == 'U' ? 2 : 1) > axes.size()) throw list.error(expected);
    const Vector3 first = copy.direction(axes[next]);
    chain.axes.push_back({j, joint == 'R' || joint == 'U', first, is_single ? name : name + "_1"});
    if (joint == 'C') chain.axes.push_back({j, true, first, name + "_2"});
    if (joint == 'U') {
      const Vector3 second = copy.direction(axes[++next]);
      const Vector3 normal = cross(first, second);
      if (draft.scope.at_default(dot(normal, normal)) < 1e-18)
        throw axes[next].refusal("the two axes of a universal joint must not be parallel");
      chain.axes.push_back({j, true, second, name + "_2"});
    }
    ++next;
  }
  if (next != axes.size()) throw list.error(expected);
  const std::string vectors = "the vectors from each of the " + std::to_string(n) +
                              " joints to the next in the reference configuration, each [x, y, z]";
  // Without a description: that of a key is the first one of its name among all drives, here that of lengths.
  const ConfigValue described = table.at("links", vectors);
  const SourceLocation place = described.place();
  const ConfigValue links(described.toml(), place.file, place.key);
  const std::vector<ConfigValue> elements = links.elements(vectors);
  if (elements.size() + 1 != n) throw links.error(vectors);
  for (const ConfigValue& link : elements)
    chain.links.push_back(of_base * (copy.turn * draft.scope.point_of_design(link, copy.group)));
  return chain;
}

/// Refuses keys that have no effect on a chain without a closed form.
void check_keys(const ConfigValue& table) {
  const std::vector<std::string> known = {"name",     "drive",      "chain",        "axes",           "links",  "base",
                                          "platform", "copies",     "base_in",      "platform_in",    "driven", "range",
                                          "radius",   "joint_name", "joint_ranges", "drive_stiffness"};
  for (const std::string& key : table.keys())
    if (!contains(known, key))
      throw table.find(key)->refusal("`" + key +
                                     "` has no effect on a chain whose joints are found by Newton's method");
}

/// Refuses a chain that has too many joints.
void check_joints(const LimbCopy& copy, const SerialChain& chain) {
  const ConfigValue list = *copy.chain->table.find("chain");
  const std::size_t count = chain.axes.size();
  if (count == 0 || count > chain.equations())
    throw list.refusal("the chain has " + std::to_string(count + kBody - chain.equations()) +
                       " degrees of freedom; expected at most 6, and at least one P or R");
}

/// Residuals of the solved chain at poses near the reference configuration, for the default parameters.
class PoseSamples {
 public:
  PoseSamples(const SerialChain& chain, MechanismDraft& draft, std::vector<Node> outputs)
      : draft_(draft), program_(draft.model.graph, outputs) {
    const generic::Model& model = draft.model;
    inputs_.assign(model.inputs.count(), 1);
    for (std::size_t i = 0; i < model.info.parameters.size(); ++i) inputs_[i] = model.info.parameters[i].nominal;
    for (std::size_t i = 0; i < model.inputs.limits; ++i)
      inputs_[model.inputs.limit(i)] = model.info.limits[i].inactive;
    for (std::size_t i = 0; i < model.info.coordinates.size(); ++i) inputs_[model.inputs.coordinate(i)] = 0;
    // The translations move the platform's joint to the end of the chain.
    Vector3 end = chain.A;
    for (const Vector3& link : chain.links) end = end + link;
    const Vector3 shift = end - chain.B;
    const std::vector<Node> components{shift[0].node(), shift[1].node(), shift[2].node()};
    const expression::Program difference(draft.model.graph, components);
    std::vector<double> registers;
    difference.run_all<double>(inputs_, registers);
    reference_ = inputs_;
    for (const PlatformMotion& motion : draft.motions)
      if (motion.coordinate && !motion.rotates)
        reference_[model.inputs.coordinate(*motion.coordinate)] = registers[difference.outputs()[motion.axis]];
  }
  /// Values of the outputs at a sample. @param range  of the translations [m]; that of the rotations is 0.1 rad
  std::vector<double> at(std::uint64_t sample, double range) {
    inputs_ = reference_;
    for (const PlatformMotion& motion : draft_.motions)
      if (motion.coordinate)
        inputs_[draft_.model.inputs.coordinate(*motion.coordinate)] +=
            (2 * halton(sample, *motion.coordinate) - 1) * (motion.rotates ? 0.1 : range);
    program_.run_all<double>(inputs_, registers_);
    std::vector<double> values;
    for (const std::uint32_t output : program_.outputs()) values.push_back(registers_[output]);
    return values;
  }

 private:
  MechanismDraft& draft_;
  expression::Program program_;
  std::vector<double> inputs_, reference_, registers_;
};

/// Refuses a chain that does not permit the motions of the platform.
void check_constraints(const LimbCopy& copy, const SerialChain& chain, Node status, const PlacedChain& at,
                       const Term& size) {
  constexpr int kSamples = 12;
  constexpr double kClosed = 1e-9;  // of a closed chain, relative to its length, or in rad
  MechanismDraft& draft = copy.draft;
  std::vector<Node> outputs{status, (limbs::length(at.opening) / size).node()};
  if (at.turn) outputs.push_back(limbs::length(vector_part(*at.turn)).node());
  const ConfigValue list = *copy.chain->table.find("chain");
  PoseSamples samples(chain, draft, outputs);
  int solved = 0;
  for (const double share : {0.1, 0.01})
    for (std::uint64_t k = 1; k <= kSamples; ++k) {
      const std::vector<double> values = samples.at(k, share * draft.scope.at_default(size));
      if (!(values[0] > 0)) continue;
      ++solved;
      if (std::max(values[1], values.back()) > kClosed)
        throw list.refusal("the chain has " + std::to_string(chain.axes.size() + kBody - chain.equations()) +
                           " degrees of freedom, which do not permit all motions of the " +
                           (copy.platform.name == kPlatformFrame ? "platform" : "frame " + copy.platform.name) +
                           " near the reference configuration; add joints, or coordinates with `follows`");
    }
  if (solved == 0)
    throw list.refusal(
        "the chain is singular in its reference configuration, or cannot reach a pose near it; expected links that "
        "lead from `base` to `platform` at a pose of the platform, parallel to the base");
}

/// Adds a constraint that follows from the equations, but is easier to contract: the links and the ranges of the slides
/// span the distance of the chain's ends. A slide without a range is unlimited.
void add_reach(const LimbCopy& copy, const SerialChain& chain) {
  MechanismDraft& draft = copy.draft;
  const auto ranges = copy.chain->table.find_table("joint_ranges");
  Term reach = draft.zero();
  for (const Vector3& link : chain.links) reach = reach + limbs::length(link);
  for (const JointAxis& axis : chain.axes) {
    if (axis.turns) continue;
    const auto range = axis.joint == copy.chain->driven ? copy.table.find("range")
                       : ranges                         ? ranges->find(axis.name)
                                                        : std::nullopt;
    if (!range) return;
    const auto [from, to] = read_range(*range, "m", copy.group, draft);
    reach = reach + call(expression::operation("max"), abs(from), abs(to));
  }
  const Vector3 v = chain.B - chain.A;
  draft.model.reach_constraints.push_back((reach * reach - dot(v, v)).node());
}

}  // namespace

void read_solved_limb(const LimbCopy& copy, const std::string& joint) {
  const Chain& limb = *copy.chain;
  MechanismDraft& draft = copy.draft;
  generic::Model& model = draft.model;
  check_keys(copy.table);
  const SerialChain chain = read_serial_chain(copy);
  check_joints(copy, chain);
  const std::size_t n = chain.axes.size();
  const auto driven =
      static_cast<std::size_t>(std::ranges::find(chain.axes, limb.driven, &JointAxis::joint) - chain.axes.begin());
  const Term q = add_joint_variable(copy.table, joint, chain.axes[driven].unit(), draft);

  std::vector<Term> unknowns;
  for (std::size_t i = 0; i < n; ++i) unknowns.push_back(unknown_of_equations(i, draft));
  const Term size = size_of(chain, draft);
  const std::vector<Node> solution = solve_equations(equations_of(chain, placed(chain, unknowns), size),
                                                     std::vector<Node>(n, draft.zero().node()), draft);
  std::vector<Term> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(model.term(solution[i + 1]));
  const PlacedChain at = placed(chain, values);
  model.domains.push_back({copy.name + " solved", "1", solution.front(),
                           copy.name + " cannot reach the pose, or only on another branch than that of its reference "
                                       "configuration"});
  if (n < chain.equations()) check_constraints(copy, chain, solution.front(), at, size);
  // Newton's method may find a configuration in which the end is rotated by half a revolution, or the chain is open.
  const std::string reason = copy.name + " cannot reach the pose from its reference configuration";
  if (at.turn) {
    const Rotation& E = *at.turn;
    model.domains.push_back({copy.name + " is aligned", "1",
                             (E[0][0] + E[1][1] + E[2][2] - (3 - kMaxOpening * kMaxOpening)).node(), reason});
  }
  if (n < chain.equations()) {
    const Term most = size * kMaxOpening;
    model.domains.push_back(
        {copy.name + " is closed", "m^2", (most * most - dot(at.opening, at.opening)).node(), reason});
  }

  std::vector<ChainCoordinate> coordinates;
  for (std::size_t i = 0; i < n; ++i)
    coordinates.push_back({chain.axes[i].name, chain.axes[i].unit(), values[i], i == driven});
  Term& drive = coordinates[driven].value;
  if (const auto range = copy.table.find("range"); range && chain.axes[driven].turns) {
    const auto [from, to] = read_range(*range, "rad", copy.group, draft);
    drive = wrapped(drive, (from + to) * 0.5);
  }
  draft.scope.add(copy.table, joint, drive.node());
  model.joints.push_back(drive.node());
  model.closures.push_back((drive - q).node());
  model.info.closed_forms.push_back("chain " + with_dashes(limb.joints) + ": " + std::to_string(n) +
                                    " equations, solved by Newton's method");
  add_range(copy.table, copy.group, joint, chain.axes[driven].unit(), drive, draft);
  name_chain_coordinates(copy, coordinates);

  add_reach(copy, chain);
  NamedLimb named{.name = copy.name,
                  .group = copy.group,
                  .points = {{"A", chain.A}, {"B", chain.B}},
                  .parts = {},
                  .joint = model.joints.size() - 1};
  for (std::size_t j = 0; j < chain.joints; ++j) named.points.emplace("J" + std::to_string(j + 1), at.joints[j]);
  for (const auto& [point, place] : named.points) draft.scope.add_member(copy.name + "." + point, place);
  if (const auto radius = copy.table.find("radius")) {
    const Term thickness = draft.scope.positive(*radius, "m", copy.name, true);
    for (std::size_t j = 1; j < chain.joints; ++j) {
      const Vector3& link = chain.links[j - 1];
      if (draft.scope.at_default(dot(link, link)) == 0) continue;  // two joints at the same position
      const bool slides =
          std::ranges::any_of(chain.axes, [&](const auto& axis) { return axis.joint == j && !axis.turns; });
      model.links.push_back({(slides ? "telescopic link " : "link ") + std::to_string(j) + " of " + copy.name,
                             copy.name,
                             nodes(at.joints[j - 1]),
                             nodes(at.joints[j]),
                             thickness.node(),
                             {copy.name}});
    }
  }
  draft.limbs.push_back(std::move(named));
}

}  // namespace pkm
