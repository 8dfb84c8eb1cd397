#include "engine/generic/newton_euler.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/generic/dynamics.hpp"

namespace pkm::generic {
namespace {

using Vec = Vector<double, 3>;
using Mat = Matrix<double, 3, 3>;
using VectorNodes = std::array<Node, 3>;

/// A point or vector with its first and second derivatives with respect to time.
struct MovingVector {
  Vec x, v, a;
};

Mat outer(const Vec& a, const Vec& b) { return a * transpose(b); }
Vec unit(const Vec& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// The axial vector w of a skew-symmetric matrix: skew u = w x u.
Vec axial(const Mat& skew) { return {{skew(2, 1), skew(0, 2), skew(1, 0)}}; }

class System {
 public:
  System(const Evaluation& e, std::span<const double> parameters, std::size_t mode, const MotionState<double>& state,
         const AxisVector<double>& acceleration)
      : model_(e.model) {
    std::vector<Taylor> design(parameters.begin(), parameters.end());
    std::vector<Taylor> inputs = e.inputs<Taylor>(design, no_limits(model_.info), mode);
    for (std::size_t i = 0; i < model_.inputs.coordinates; ++i)
      inputs[model_.inputs.coordinate(i)] = {state.pose[i], state.velocity[i], acceleration[i]};
    const std::vector<Node> nodes = needed();
    const std::vector<Taylor> values = outputs_of(expression::Program(model_.graph, nodes), inputs);
    for (std::size_t i = 0; i < nodes.size(); ++i) value_.emplace(nodes[i], values[i]);
  }

  NewtonEuler newton_euler(const Wrench<double>& wrench) const {
    NewtonEuler system;
    for (const SolidNodes& solid : model_.jointed->solids) system.bodies.push_back(body_of(solid));
    for (const JointNodes& joint : model_.jointed->joints) system.joints.push_back(joint_of(joint));
    const auto found = std::ranges::find(model_.jointed->solids, true, &SolidNodes::is_platform);
    RigidBody& platform = system.bodies[static_cast<std::size_t>(found - model_.jointed->solids.begin())];
    apply(platform, at(*model_.wrench_point).x, Vec{{wrench[0], wrench[1], wrench[2]}},
          Vec{{wrench[3], wrench[4], wrench[5]}});
    for (const JointNodes& joint : model_.jointed->joints)
      if (joint.holds_pin) {  // a moment about the axis of the pin does no work for any motion of the coordinates
        const Vec axis = unit(at(joint.axes[0]).x);
        platform.moment = platform.moment - axis * dot(axis, platform.moment);
      }
    return system;
  }

 private:
  std::vector<Node> needed() const {
    std::vector<Node> nodes;
    const auto add = [&nodes](const VectorNodes& point) { nodes.insert(nodes.end(), point.begin(), point.end()); };
    add(*model_.wrench_point);
    for (const BodyNodes& body : model_.bodies) {
      add(body.centre);
      nodes.push_back(body.mass);
      if (body.inertia) add(*body.inertia);
      if (body.axes)
        for (const VectorNodes& row : *body.axes) add(row);
    }
    for (const SolidNodes& solid : model_.jointed->solids) {
      add(solid.point);
      if (solid.rotation)
        for (const VectorNodes& row : *solid.rotation) add(row);
      if (solid.line) add(*solid.line);
      if (solid.centre_offset) add(*solid.centre_offset);
    }
    for (const JointNodes& joint : model_.jointed->joints) {
      add(joint.point);
      for (const VectorNodes& axis : joint.axes) add(axis);
      if (joint.drive) add(joint.drive->axis);
    }
    return nodes;
  }

  double number(Node node) const { return value_.at(node).a; }
  MovingVector at(const VectorNodes& point) const {
    MovingVector moving;
    for (std::size_t k = 0; k < 3; ++k) {
      const Taylor& value = value_.at(point[k]);
      moving.x[k] = value.a;
      moving.v[k] = value.d;
      moving.a[k] = value.dd;
    }
    return moving;
  }

  /// A rotation matrix R and its first and second derivatives with respect to time.
  struct MovingRotation {
    Mat R, first, second;
  };
  MovingRotation at(const std::array<VectorNodes, 3>& rows) const {
    MovingRotation moving;
    for (std::size_t i = 0; i < 3; ++i) {
      const MovingVector row = at(rows[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        moving.R(i, k) = row.x[k];
        moving.first(i, k) = row.v[k];
        moving.second(i, k) = row.a[k];
      }
    }
    return moving;
  }

  /// The rigid body of a solid with its position and motion, but without mass.
  RigidBody massless(const SolidNodes& solid) const {
    RigidBody body;
    body.name = solid.name;
    body.centre = at(solid.point).x;
    if (solid.rotation) {  // omega x = R' R^T, epsilon x = R'' R^T + R' R'^T
      const auto [R, first, second] = at(*solid.rotation);
      body.omega = axial(first * transpose(R));
      body.epsilon = axial(second * transpose(R) + first * transpose(first));
    } else if (solid.line) {
      // omega = d x d' / |d|^2, which has no component along the body's direction d; and its time derivative
      const MovingVector d = at(*solid.line);
      const double square = dot(d.x, d.x);
      body.omega = cross(d.x, d.v) * (1 / square);
      body.epsilon = cross(d.x, d.a) * (1 / square) - body.omega * (2 * dot(d.x, d.v) / square);
    }
    return body;
  }

  /// Inertia of one of the bodies of a solid about its own centre of mass, in the base frame.
  Mat inertia_of(const SolidNodes& solid, const BodyNodes& body) const {
    Mat inertia;
    if (!body.inertia) return inertia;
    if (body.axes) {
      for (std::size_t k = 0; k < 3; ++k) inertia(k, k) = number((*body.inertia)[k]);
      const Mat R = at(*body.axes).R;
      return R * inertia * transpose(R);
    }
    if (!solid.line) return inertia;  // the body does not rotate, so that its inertia has no effect
    const Vec u = unit(at(*solid.line).x);
    return (Mat::identity() - outer(u, u)) * number((*body.inertia)[1]);
  }

  RigidBody body_of(const SolidNodes& solid) const {
    RigidBody body = massless(solid);
    Vec first_moment, inertia_force;
    for (const std::size_t i : solid.bodies) {
      const double mass = number(model_.bodies[i].mass) * solid.share;
      const MovingVector of = at(model_.bodies[i].centre);
      body.mass += mass;
      first_moment += of.x * mass;
      inertia_force += of.a * mass;
    }
    if (body.mass > 0) {
      body.centre = first_moment * (1 / body.mass);
      body.a = inertia_force * (1 / body.mass);
    }
    for (const std::size_t i : solid.bodies) {
      const BodyNodes& part = model_.bodies[i];
      body.inertia += inertia_of(solid, part) * solid.share +
                      point_inertia(number(part.mass) * solid.share, at(part.centre).x - body.centre);
    }
    if (solid.centre_offset) body.centre += at(*solid.centre_offset).x;
    return body;
  }

  Joint joint_of(const JointNodes& nodes) const {
    Joint joint{nodes.name, at(nodes.point).x, nodes.on, nodes.from, {}, {}};
    std::vector<Vec> axes;
    for (const VectorNodes& axis : nodes.axes) axes.push_back(unit(at(axis).x));
    if (nodes.holds_pin) axes.clear();
    joint.couples = nodes.couples == JointNodes::Couples::along ? axes : normal_to(axes);
    if (const auto& drive = nodes.drive) {
      joint.actuator = Actuator{.joint = drive->joint, .axis = unit(at(drive->axis).x), .turns = drive->turns};
      if (drive->slide) {
        const BodyNodes& slide = model_.bodies[*drive->slide];
        const Vec needed = at(slide.centre).a + Vec{{0, 0, kGravity}};
        joint.actuator->on_slide = dot(needed, joint.actuator->axis) * number(slide.mass);
      }
    }
    return joint;
  }

  /// Orthonormal basis of the orthogonal complement of the axes (Gram-Schmidt).
  static std::vector<Vec> normal_to(const std::vector<Vec>& axes) {
    // Vectors whose component normal to the axes is shorter count as parallel to the axes.
    constexpr double kParallel = 1e-9;
    std::vector<Vec> span, complement;
    const auto normal_part = [&](Vec v) {
      for (const auto* const list : {&span, &complement})
        for (const Vec& u : *list) v = v - u * dot(u, v);
      return v;
    };
    for (const Vec& axis : axes)
      if (const Vec v = normal_part(axis); dot(v, v) > kParallel * kParallel) span.push_back(unit(v));
    while (span.size() + complement.size() < 3) {
      Vec longest;
      for (std::size_t k = 0; k < 3; ++k) {
        Vec e;
        e[k] = 1;
        if (const Vec v = normal_part(e); dot(v, v) > dot(longest, longest)) longest = v;
      }
      complement.push_back(unit(longest));
    }
    return complement;
  }

  const Model& model_;
  std::map<Node, Taylor> value_;
};

}  // namespace

NewtonEuler newton_euler(const Evaluation& e, std::span<const double> parameters, std::size_t mode,
                         const MotionState<double>& state, const AxisVector<double>& acceleration,
                         const Wrench<double>& wrench) {
  check_masses(e, parameters);
  return System(e, parameters, mode, state, acceleration).newton_euler(wrench);
}

}  // namespace pkm::generic
