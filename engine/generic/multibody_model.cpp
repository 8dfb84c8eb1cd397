// Bodies and joints of Model::jointed at one pose. The spanning tree is a minimum one by the degrees of freedom of the
// joints (Kruskal's algorithm), with the drives first, so that the loops are closed at ball joints wherever possible.
#include "engine/generic/multibody_model.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <Eigen/Geometry>

#include "engine/generic/mechanism.hpp"
#include "engine/generic/newton_euler.hpp"
#include "engine/math/eigen_solvers.hpp"

namespace pkm::generic {
namespace {

using Eigen::Index, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d;
using VectorNodes = std::array<Node, 3>;
using Type = MultibodyModel::JointType;

constexpr double kParallelAxes = 1e-9;      // axes count as parallel if the sine of their angle is at most this
constexpr double kSameMotion = 1e-7;        // velocities whose relative difference is smaller are equal
constexpr double kRankOfVelocities = 1e-9;  // pivots that are smaller, relative to the largest pivot, count as 0

Vector3d eigen(const Vector<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// Velocity of a point of a rigid body, and the body's angular velocity, for a unit rate of each coordinate.
struct BodyMotion {
  Vector3d point;
  std::vector<Vector3d> v, omega;  ///< velocity of the point, and angular velocity; by coordinate
};

/// A joint between the bodies `from` and `on`, before it is known whether it belongs to the spanning tree.
struct Connection {
  std::string name;
  Type type;
  std::size_t from, on;
  Vector3d point;
  std::vector<Vector3d> axes{};  ///< axes of rotation; of a universal joint first the axis on `from`, then that on `on`
  std::optional<MultibodyModel::Drive> drive{};
};

/// A unit vector normal to `line`, as close to the direction `preferred` as possible.
Vector3d normal_to(const Vector3d& line, const Vector3d& preferred) {
  // If the sine of the angle between `line` and `preferred` is smaller, the x or y axis is used instead of `preferred`.
  constexpr double kOblique = 0.1;
  const Vector3d u = line.normalized();
  for (const Vector3d& wanted : {preferred, Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY())})
    if (const Vector3d across = wanted - u * u.dot(wanted); across.norm() > kOblique * wanted.norm())
      return across.normalized();
  return u.unitOrthogonal();
}

class MultibodyBuilder {
 public:
  MultibodyBuilder(const Evaluation& e, std::span<const double> parameters, const Pose<double>& pose, std::size_t mode)
      : e_(e), model_(e.model), of_(*e.model.jointed), design_(parameters.begin(), parameters.end()), mode_(mode) {
    std::vector<Taylor> at = inputs(pose);
    const std::vector<Node> nodes = needed();
    const expression::Program program(model_.graph, nodes);
    for (std::size_t j = 0; j < pose.size(); ++j) {
      at[model_.inputs.coordinate(j)].d = 1;
      rates_.push_back(values(program, nodes, at));
      at[model_.inputs.coordinate(j)].d = 0;
    }
    // Evaluate the nodes at a second pose nearby, at which axes that are parallel by chance are not. The formulas of
    // axes do not need a pose that assembles.
    constexpr double kStep = 0.1;
    for (std::size_t j = 0; j < pose.size(); ++j)
      at[model_.inputs.coordinate(j)].a += kStep * static_cast<double>(j + 1);
    nearby_ = values(program, nodes, at);
    for (const JointNodes& joint : of_.joints) size_ = std::max(size_, (at_pose(joint.point) - origin()).norm());
    if (size_ == 0) size_ = 1;
  }

  MultibodyModel build(const NewtonEuler& system) {
    MultibodyModel built;
    built.name = model_.info.name;
    built.bodies.push_back({.name = "base"});
    motions_.push_back({Vector3d::Zero(), zeros(), zeros()});
    for (std::size_t i = 0; i < of_.solids.size(); ++i) add_solid(i, system.bodies[i], built);
    for (const JointNodes& joint : of_.joints) add_joint(joint, built);
    check_motions();
    check_drives();
    check_mobility(built);
    built.platform = 1 + static_cast<std::size_t>(std::ranges::find(of_.solids, true, &SolidNodes::is_platform) -
                                                  of_.solids.begin());
    built.origin = origin();
    built.rotation = rotation();
    grow_tree(built);
    for (const LinkNodes& link : model_.links) draw(link, built);
    return built;
  }

 private:
  using Values = std::map<Node, Taylor>;

  std::vector<Taylor> inputs(const Pose<double>& pose) const {
    std::vector<Taylor> all = e_.inputs<Taylor>(design_, no_limits(model_.info), mode_);
    std::ranges::copy(pose, all.begin() + static_cast<std::ptrdiff_t>(model_.inputs.coordinate(0)));
    return all;
  }
  static Values values(const expression::Program& program, const std::vector<Node>& nodes,
                       const std::vector<Taylor>& at) {
    const std::vector<Taylor> outputs = outputs_of(program, at);
    Values found;
    for (std::size_t i = 0; i < nodes.size(); ++i) found.emplace(nodes[i], outputs[i]);
    return found;
  }
  std::vector<Node> needed() const {
    std::vector<Node> nodes = model_.joints;
    const auto add = [&nodes](const VectorNodes& point) { nodes.insert(nodes.end(), point.begin(), point.end()); };
    add(model_.origin);
    for (const VectorNodes& row : model_.rotation) add(row);
    for (const BodyNodes& body : model_.bodies) {
      add(body.centre);
      nodes.push_back(body.mass);
      if (body.inertia) add(*body.inertia);
    }
    for (const SolidNodes& solid : of_.solids) {
      add(solid.point);
      if (solid.line) add(*solid.line);
      if (solid.rotation)
        for (const VectorNodes& row : *solid.rotation) add(row);
      if (solid.centre_offset) add(*solid.centre_offset);
    }
    for (const JointNodes& joint : of_.joints) {
      add(joint.point);
      for (const VectorNodes& axis : joint.axes) add(axis);
      if (joint.drive) add(joint.drive->axis);
      if (joint.universal) add(joint.universal->axis);
    }
    for (const LinkNodes& link : model_.links) {
      add(link.from);
      add(link.to);
      nodes.push_back(link.radius);
    }
    for (const JointRange& range : model_.ranges) nodes.insert(nodes.end(), {range.from, range.to});
    for (const auto& force : model_.peak_forces)
      if (force) nodes.push_back(*force);
    return nodes;
  }

  double number(Node node) const { return rates_.front().at(node).a; }
  static Vector3d value(const Values& at, const VectorNodes& v) {
    return {at.at(v[0]).a, at.at(v[1]).a, at.at(v[2]).a};
  }
  Vector3d at_pose(const VectorNodes& v) const { return value(rates_.front(), v); }
  Vector3d rate(const VectorNodes& v, std::size_t coordinate) const {
    const Values& at = rates_[coordinate];
    return {at.at(v[0]).d, at.at(v[1]).d, at.at(v[2]).d};
  }
  Vector3d origin() const { return at_pose(model_.origin); }
  Matrix3d rotation() const {
    Matrix3d R;
    for (std::size_t i = 0; i < 3; ++i) R.row(static_cast<Index>(i)) = at_pose(model_.rotation[i]);
    return R;
  }
  std::vector<Vector3d> zeros() const { return std::vector<Vector3d>(rates_.size(), Vector3d::Zero()); }

  BodyMotion motion_of(const SolidNodes& solid) const {
    BodyMotion motion{at_pose(solid.point), zeros(), zeros()};
    if (solid.centre_offset) motion.point += at_pose(*solid.centre_offset);
    for (std::size_t j = 0; j < rates_.size(); ++j) {
      motion.v[j] = rate(solid.point, j);
      if (solid.centre_offset) motion.v[j] += rate(*solid.centre_offset, j);
      if (solid.rotation) {
        Matrix3d R, first;
        for (std::size_t i = 0; i < 3; ++i) {
          R.row(static_cast<Index>(i)) = at_pose((*solid.rotation)[i]);
          first.row(static_cast<Index>(i)) = rate((*solid.rotation)[i], j);
        }
        const Matrix3d spin = first * R.transpose();
        motion.omega[j] = {spin(2, 1), spin(0, 2), spin(1, 0)};
      } else if (solid.line) {
        const Vector3d d = at_pose(*solid.line);
        motion.omega[j] = d.cross(rate(*solid.line, j)) / d.squaredNorm();
      }
    }
    return motion;
  }

  void add_solid(std::size_t i, const RigidBody& body, MultibodyModel& built) {
    const SolidNodes& solid = of_.solids[i];
    MultibodyModel::Body& added = built.bodies.emplace_back();
    added.name = body.name;
    added.mass = body.mass;
    added.centre = eigen(body.centre);
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t k = 0; k < 3; ++k)
        added.inertia(static_cast<Index>(row), static_cast<Index>(k)) = body.inertia(row, k);
    // The body does not rotate, so that the equations of motion do not contain its inertia.
    if (!solid.rotation && !solid.line)
      for (const std::size_t part : solid.bodies)
        if (const auto& own = model_.bodies[part].inertia) added.inertia.diagonal() += at_pose(*own) * solid.share;
    motions_.push_back(motion_of(solid));
  }

  MultibodyModel::Drive drive_of(const JointNodes::Drive& nodes) const {
    MultibodyModel::Drive drive{nodes.joint, number(model_.joints[nodes.joint])};
    const auto range = std::ranges::find(model_.ranges, model_.info.joints[nodes.joint].name, &JointRange::joint);
    if (range != model_.ranges.end()) drive.range = {number(range->from), number(range->to)};
    if (!model_.peak_forces.empty() && model_.peak_forces[nodes.joint])
      drive.peak_force = number(*model_.peak_forces[nodes.joint]);
    return drive;
  }

  /// Index of the body that is the slide of a drive along a rail; adds the body with its driven joint if necessary.
  std::size_t slide_of(const JointNodes& joint, MultibodyModel& built) {
    const JointNodes::Drive& drive = *joint.drive;
    if (const auto found = slides_.find(drive.joint); found != slides_.end()) return found->second;
    const std::size_t index = slides_[drive.joint] = built.bodies.size();
    MultibodyModel::Body& slide = built.bodies.emplace_back();
    slide.name = "slide of " + model_.info.joints[drive.joint].name;
    slide.centre = at_pose(joint.point);
    BodyMotion motion{slide.centre, zeros(), zeros()};
    for (std::size_t j = 0; j < rates_.size(); ++j) motion.v[j] = rate(joint.point, j);
    if (drive.slide) {
      const BodyNodes& mass = model_.bodies[*drive.slide];
      slide.name = mass.name;
      slide.mass = number(mass.mass);
      slide.centre = at_pose(mass.centre);
    }
    motions_.push_back(motion);
    connections_.push_back({model_.info.joints[drive.joint].name,
                            Type::prismatic,
                            0,
                            index,
                            slide.centre,
                            {at_pose(drive.axis).normalized()},
                            drive_of(drive)});
    return index;
  }

  /// The axes about which a joint rotates; of several parallel axes only the first.
  std::vector<Vector3d> free_axes(const JointNodes& joint) const {
    std::vector<Vector3d> here, there;
    for (const VectorNodes& nodes : joint.axes) {
      const Vector3d axis = at_pose(nodes).normalized(), near = value(nearby_, nodes).normalized();
      const auto is_new = [](const std::vector<Vector3d>& known, const Vector3d& a) {
        return std::ranges::all_of(known, [&](const Vector3d& b) { return a.cross(b).norm() > kParallelAxes; });
      };
      if (!is_new(there, near)) continue;
      if (!is_new(here, axis))
        throw std::invalid_argument("two axes of the joint " + joint.name +
                                    " are parallel at this pose; choose another reference pose");
      here.push_back(axis);
      there.push_back(near);
    }
    return here;
  }

  void add_joint(const JointNodes& joint, MultibodyModel& built) {
    const bool is_rigid = joint.couples == JointNodes::Couples::all_but_about && joint.axes.empty();
    Connection added{joint.name, Type::ball, joint.from ? *joint.from + 1 : 0, joint.on + 1, at_pose(joint.point)};
    if (joint.drive && is_rigid) {
      added.name = model_.info.joints[joint.drive->joint].name;
      added.type = joint.drive->turns ? Type::revolute : Type::prismatic;
      added.axes = {at_pose(joint.drive->axis).normalized()};
      added.drive = drive_of(*joint.drive);
      connections_.push_back(added);
      return;
    }
    if (joint.drive) added.from = slide_of(joint, built);
    if (joint.couples == JointNodes::Couples::all_but_about) {
      if (!joint.holds_pin) added.axes = free_axes(joint);
      std::ranges::reverse(added.axes);  // the file lists the axis on `on` first, then the axis on `from`
      add_rotations(added);
    } else if (joint.universal) {
      const Vector3d of_carrier = at_pose(joint.universal->axis).normalized();
      const Vector3d of_rod = of_carrier.cross(at_pose(joint.axes[0])).normalized();
      const bool on_is_rod = joint.universal->rod == joint.on;
      added.axes = on_is_rod ? std::vector{of_carrier, of_rod} : std::vector{of_rod, of_carrier};
      add_rotations(added);
    } else if (!joint.axes.empty()) {  // the rod does not spin about its line: use two axes normal to it
      const Vector3d line = at_pose(joint.axes[0]);
      const Vector3d axis = normal_to(line, pivot_beside(added));
      const Vector3d other = axis.cross(line).normalized();
      const bool from_is_rod =
          added.from != 0 && added.from <= of_.solids.size() && of_.solids[added.from - 1].line &&
          at_pose(*of_.solids[added.from - 1].line).cross(line).norm() <= kParallelAxes * line.norm();
      added.axes = from_is_rod ? std::vector{other, axis} : std::vector{axis, other};
      add_rotations(added);
    } else {
      connections_.push_back(added);
    }
  }
  /// Direction of the axis of a crank if one of the two bodies of the joint is a crank; otherwise a horizontal
  /// direction.
  Vector3d pivot_beside(const Connection& joint) const {
    for (const Connection& other : connections_)
      if (other.type == Type::revolute && other.drive && (other.on == joint.from || other.on == joint.on))
        return other.axes[0];
    return Vector3d::UnitX();
  }
  /// Adds a joint whose type (revolute, universal, spherical) follows from the number of its rotation axes.
  void add_rotations(Connection joint) {
    constexpr double kOblique = 1e-9;  // maximum cosine of the angle between the axes of a universal joint
    if (joint.axes.size() == 2 && std::abs(joint.axes[0].dot(joint.axes[1])) > kOblique)
      throw std::invalid_argument("the two axes of the joint " + joint.name +
                                  " are not normal to each other, as those of a universal joint are");
    constexpr std::array kTypes = {Type::fixed, Type::revolute, Type::universal, Type::ball};
    joint.type = kTypes[std::min(joint.axes.size(), kTypes.size() - 1)];
    if (joint.type == Type::ball) joint.axes.clear();
    connections_.push_back(std::move(joint));
  }

  /// True if a point moves as if it were fixed to a body.
  bool is_carried(const VectorNodes& point, const BodyMotion& body) const {
    for (std::size_t j = 0; j < rates_.size(); ++j) {
      const Vector3d v = rate(point, j), carried = body.v[j] + body.omega[j].cross(at_pose(point) - body.point);
      if ((v - carried).norm() > kSameMotion * std::max(size_, 1.0)) return false;
    }
    return true;
  }
  /// Throws std::invalid_argument if the motion of the points of a body, as given by formulas, is not that of a rigid
  /// body.
  void check_motions() const {
    for (const JointNodes& joint : of_.joints) {
      const bool on_slide = joint.drive && slides_.contains(joint.drive->joint);
      for (const std::size_t body : {joint.on + 1, joint.from ? *joint.from + 1 : 0})
        if (!(on_slide && body == 0) && !(joint.drive && !joint.drive->turns && !on_slide) &&
            !is_carried(joint.point, motions_[body]))
          throw std::invalid_argument("by the formulas of the file, the joint " + joint.name + " does not move with " +
                                      (body ? of_.solids[body - 1].name : "the base"));
    }
  }

  /// Throws if a drive does not move like its joint coordinate, for example in the opposite direction.
  void check_drives() const {
    for (const Connection& joint : connections_) {
      if (!joint.drive) continue;
      const BodyMotion &on = motions_[joint.on], &from = motions_[joint.from];
      for (std::size_t j = 0; j < rates_.size(); ++j) {
        const auto v = [&](const BodyMotion& body) -> Vector3d {
          return body.v[j] + body.omega[j].cross(joint.point - body.point);
        };
        const Vector3d relative = joint.type == Type::prismatic ? v(on) - v(from) : on.omega[j] - from.omega[j];
        const double expected = rates_[j].at(model_.joints[joint.drive->joint]).d;
        if (std::abs(joint.axes[0].dot(relative) - expected) > kSameMotion * std::max(1.0, std::abs(expected)))
          throw std::invalid_argument("by the formulas of the file, the drive " + joint.name +
                                      " does not move as its joint; the positive direction is that of the first body " +
                                      "relative to the second");
      }
    }
  }

  /// Throws if the number of degrees of freedom of the bodies, with free drives, differs from the number of
  /// coordinates.
  void check_mobility(const MultibodyModel& built) const {
    const auto bodies = static_cast<Index>(built.bodies.size() - 1);
    MatrixXd A = MatrixXd::Zero(6 * static_cast<Index>(connections_.size()), 6 * bodies);
    for (Index row = 0; const Connection& joint : connections_) {
      const Vector3d p = (joint.point - origin()) / size_;
      Matrix3d cross, linear = Matrix3d::Identity(), angular = Matrix3d::Identity();
      cross << 0, -p[2], p[1], p[2], 0, -p[0], -p[1], p[0], 0;
      if (joint.type == Type::prismatic) linear -= joint.axes[0] * joint.axes[0].transpose();
      if (joint.type == Type::revolute) angular -= joint.axes[0] * joint.axes[0].transpose();
      if (joint.type == Type::universal) {
        const Vector3d couple = joint.axes[0].cross(joint.axes[1]);
        angular = couple * couple.transpose();
      }
      if (joint.type == Type::ball) angular.setZero();
      const auto add = [&](std::size_t body, double sign) {
        if (body == 0) return;
        const auto column = static_cast<Index>(6 * (body - 1));
        A.block<3, 3>(row, column) += sign * linear;
        A.block<3, 3>(row, column + 3) -= sign * linear * cross;
        A.block<3, 3>(row + 3, column + 3) += sign * angular;
      };
      add(joint.on, 1);
      add(joint.from, -1);
      row += 6;
    }
    Eigen::ColPivHouseholderQR<MatrixXd> decomposition;
    decomposition.setThreshold(kRankOfVelocities);
    decomposition.compute(A);
    const auto freedoms = static_cast<std::size_t>(A.cols() - decomposition.rank());
    if (freedoms == rates_.size()) return;
    throw std::invalid_argument("the joints of its file give the bodies " + std::to_string(freedoms) +
                                " degrees of freedom at this pose, but the platform has " +
                                std::to_string(rates_.size()) + " coordinates");
  }

  void grow_tree(MultibodyModel& built) const {
    std::vector<std::size_t> order(connections_.size()), group(built.bodies.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    for (std::size_t i = 0; i < group.size(); ++i) group[i] = i;
    std::ranges::stable_sort(
        order, {}, [&](std::size_t i) { return connections_[i].drive ? -1 : static_cast<int>(connections_[i].type); });
    std::vector<bool> in_tree(connections_.size());
    for (const std::size_t i : order) {
      const std::size_t a = group[connections_[i].from], b = group[connections_[i].on];
      if (a == b) continue;
      in_tree[i] = true;
      std::ranges::replace(group, b, a);
    }
    std::vector<std::size_t> reached = {0};
    std::vector<bool> used(connections_.size());
    for (std::size_t k = 0; k < reached.size(); ++k)
      for (std::size_t i = 0; i < connections_.size(); ++i) {
        const Connection& joint = connections_[i];
        if (!in_tree[i] || used[i] || (joint.from != reached[k] && joint.on != reached[k])) continue;
        used[i] = true;
        built.tree.push_back(oriented(joint, joint.from == reached[k]));
        reached.push_back(built.tree.back().child);
      }
    for (std::size_t i = 0; i < connections_.size(); ++i)
      if (!in_tree[i]) built.closures.push_back(oriented(connections_[i], true));
    for (const MultibodyModel::Joint& joint : built.closures)
      if (joint.drive || joint.type == Type::prismatic)
        throw std::invalid_argument("the joint " + joint.name + " closes a loop of slides or drives only");
    if (reached.size() != built.bodies.size())
      throw std::invalid_argument("its bodies are not all connected to the base by joints");
  }
  static MultibodyModel::Joint oriented(const Connection& joint, bool from_is_parent) {
    MultibodyModel::Joint made{joint.name, joint.type, joint.from, joint.on, joint.point, joint.axes, joint.drive};
    if (from_is_parent) return made;
    std::swap(made.parent, made.child);
    std::ranges::reverse(made.axes);
    if (joint.type == Type::revolute || joint.type == Type::prismatic) made.axes[0] = -made.axes[0];
    return made;
  }

  /// Adds the capsule of a link to the body with which it moves. The capsule of a leg is divided between its two
  /// bodies, and the capsule in the middle of a pair of rods is added to both rods.
  void draw(const LinkNodes& link, MultibodyModel& built) const {
    const Vector3d from = at_pose(link.from), to = at_pose(link.to);
    const double radius = number(link.radius);
    bool is_pair = false;
    for (std::size_t i = 0; i < of_.solids.size(); ++i) {
      const SolidNodes& solid = of_.solids[i];
      if (!solid.centre_offset || (at_pose(solid.point) - from).norm() > kSameMotion * size_ || !solid.line ||
          (at_pose(*solid.line) - (to - from)).norm() > kSameMotion * size_)
        continue;
      const Vector3d beside = at_pose(*solid.centre_offset);
      built.bodies[i + 1].shapes.push_back({from + beside, to + beside, radius});
      is_pair = true;
    }
    if (is_pair) return;
    const auto carrier = [&](const VectorNodes& a, const VectorNodes& b) {
      return static_cast<std::size_t>(
          std::ranges::find_if(motions_,
                               [&](const BodyMotion& body) { return is_carried(a, body) && is_carried(b, body); }) -
          motions_.begin());
    };
    if (const std::size_t body = carrier(link.from, link.to); body < built.bodies.size()) {
      built.bodies[body].shapes.push_back({from, to, radius});
      return;
    }
    for (const MultibodyModel::Joint& slide : built.tree) {  // from the cylinder of a leg to its piston
      if (slide.type != Type::prismatic || !is_carried(link.from, motions_[slide.parent]) ||
          !is_carried(link.to, motions_[slide.child]))
        continue;
      const Vector3d middle = (from + to) / 2;
      built.bodies[slide.parent].shapes.push_back({from, middle, radius});
      built.bodies[slide.child].shapes.push_back({middle, to, radius});
      return;
    }
    built.notes.push_back("The link '" + link.name + "' is not drawn, because it moves with none of the bodies.");
  }

  const Evaluation& e_;
  const Model& model_;
  const JointedBodies& of_;
  std::vector<Taylor> design_;
  std::size_t mode_;
  /// For each coordinate, the values of all nodes and their derivatives with respect to it.
  std::vector<Values> rates_;
  Values nearby_;
  double size_ = 0;
  std::vector<BodyMotion> motions_;  ///< motion of each body, by body
  std::vector<Connection> connections_;
  std::map<std::size_t, std::size_t> slides_;  ///< index of the slide's body for each drive that has one, by drive
};

}  // namespace

std::string why_no_multibody_model(const Mechanism& mechanism) {
  if (!evaluation_of(mechanism)) return "its bodies and joints are not described by a mechanism file";
  return mechanism.why_no_reactions();
}

MultibodyModel multibody_model(const Mechanism& mechanism, std::span<const double> parameters, const Pose<double>& pose,
                               const std::string& mode) {
  if (const std::string why = why_no_multibody_model(mechanism); !why.empty()) throw std::invalid_argument(why);
  const MechanismInfo& info = mechanism.info();
  const PoseReport report = mechanism.inspect(parameters, pose, mode, no_limits(info));
  if (!report.assembles) throw std::invalid_argument("its reference pose does not assemble: " + report.reason);
  const Evaluation& e = *evaluation_of(mechanism);
  const std::size_t index = mode_index(info, mode);
  const std::size_t n = info.coordinates.size();
  const NewtonEuler system =
      newton_euler(e, parameters, index, {pose, AxisVector<double>(n)}, AxisVector<double>(n), {});
  MultibodyModel built = MultibodyBuilder(e, parameters, pose, index).build(system);
  for (std::size_t i = 0; i < n; ++i) built.pose.emplace_back(info.coordinates[i].name, pose[i]);
  if (const DriveTrains* const trains = mechanism.drive_trains())
    for (MultibodyModel::Joint& joint : built.tree)
      if (joint.drive) {
        const DriveTrain& train = (*trains)[joint.drive->joint];
        joint.drive->inertia = train.reflected();
        joint.drive->viscous = train.viscous;
        joint.drive->coulomb = train.coulomb;
      }
  return built;
}

}  // namespace pkm::generic
