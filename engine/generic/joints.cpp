#include "engine/generic/joints.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/generic/dynamics.hpp"

namespace pkm::generic {
namespace {

using Vec = Vector<double, 3>;
using Mat = Matrix<double, 3, 3>;
using Place = std::array<Node, 3>;

/// A place that moves, or a direction.
struct Moving {
  Vec x, v, a;
};

Mat outer(const Vec& a, const Vec& b) { return a * transpose(b); }
Vec unit(const Vec& v) { return v * (1 / std::sqrt(dot(v, v))); }

/// w of the matrix that is w x.
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
    find_turn_of_platform();
  }

  NewtonEuler newton_euler(const Wrench<double>& wrench) const {
    NewtonEuler system;
    for (const SolidNodes& solid : model_.jointed->solids) system.bodies.push_back(body_of(solid));
    for (const JointNodes& joint : model_.jointed->joints) system.joints.push_back(joint_of(joint));
    const auto platform = std::ranges::find(model_.jointed->solids, true, &SolidNodes::with_platform);
    apply(system.bodies[static_cast<std::size_t>(platform - model_.jointed->solids.begin())],
          at(*model_.wrench_point).x, Vec{{wrench[0], wrench[1], wrench[2]}}, Vec{{wrench[3], wrench[4], wrench[5]}});
    return system;
  }

 private:
  std::vector<Node> needed() const {
    std::vector<Node> nodes;
    const auto add = [&nodes](const Place& place) { nodes.insert(nodes.end(), place.begin(), place.end()); };
    add(*model_.wrench_point);
    for (const Place& row : model_.turn) add(row);
    for (const BodyNodes& body : model_.bodies) {
      add(body.centre);
      nodes.push_back(body.mass);
      if (body.inertia) add(*body.inertia);
    }
    for (const SolidNodes& solid : model_.jointed->solids) {
      add(solid.place);
      if (solid.line) add(*solid.line);
      if (solid.beside) add(*solid.beside);
    }
    for (const JointNodes& joint : model_.jointed->joints) {
      add(joint.point);
      for (const Place& axis : joint.axes) add(axis);
      if (joint.drive) add(joint.drive->axis);
    }
    return nodes;
  }

  double number(Node node) const { return value_.at(node).a; }
  Moving at(const Place& place) const {
    Moving moving;
    for (std::size_t k = 0; k < 3; ++k) {
      const Taylor& value = value_.at(place[k]);
      moving.x[k] = value.a;
      moving.v[k] = value.d;
      moving.a[k] = value.dd;
    }
    return moving;
  }

  /// Of R: R' R^T = omega x, and its rate R'' R^T + R' R'^T = epsilon x.
  void find_turn_of_platform() {
    Mat rate, second;
    for (std::size_t i = 0; i < 3; ++i) {
      const Moving row = at(model_.turn[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        R_(i, k) = row.x[k];
        rate(i, k) = row.v[k];
        second(i, k) = row.a[k];
      }
    }
    omega_ = axial(rate * transpose(R_));
    epsilon_ = axial(second * transpose(R_) + rate * transpose(rate));
  }

  /// Without mass, in its turning.
  RigidBody turning(const SolidNodes& solid) const {
    RigidBody body;
    body.name = solid.name;
    body.centre = at(solid.place).x;
    if (solid.with_platform) {
      body.omega = omega_;
      body.epsilon = epsilon_;
    } else if (solid.line) {
      // omega = d x d' / |d|^2 has no component along d; and its rate
      const Moving d = at(*solid.line);
      const double square = dot(d.x, d.x);
      body.omega = cross(d.x, d.v) * (1 / square);
      body.epsilon = cross(d.x, d.a) * (1 / square) - body.omega * (2 * dot(d.x, d.v) / square);
    }
    return body;
  }

  /// Of one of the bodies that a solid is made of, about its own centre.
  Mat inertia_of(const SolidNodes& solid, const BodyNodes& body) const {
    Mat inertia;
    if (!body.inertia) return inertia;
    if (solid.with_platform) {
      for (std::size_t k = 0; k < 3; ++k) inertia(k, k) = number((*body.inertia)[k]);
      return R_ * inertia * transpose(R_);
    }
    if (!solid.line) return inertia;  // it does not turn
    const Vec u = unit(at(*solid.line).x);
    return (Mat::identity() - outer(u, u)) * number((*body.inertia)[1]);
  }

  RigidBody body_of(const SolidNodes& solid) const {
    RigidBody body = turning(solid);
    Vec centre, force;
    for (const std::size_t i : solid.bodies) {
      const double mass = number(model_.bodies[i].mass) * solid.share;
      const Moving of = at(model_.bodies[i].centre);
      body.mass += mass;
      centre += of.x * mass;
      force += of.a * mass;
    }
    if (body.mass > 0) {
      body.centre = centre * (1 / body.mass);
      body.a = force * (1 / body.mass);
    }
    for (const std::size_t i : solid.bodies) {
      const BodyNodes& part = model_.bodies[i];
      body.inertia += inertia_of(solid, part) * solid.share +
                      point_inertia(number(part.mass) * solid.share, at(part.centre).x - body.centre);
    }
    if (solid.beside) body.centre += at(*solid.beside).x;
    return body;
  }

  Joint joint_of(const JointNodes& described) const {
    Joint joint{described.name, at(described.point).x, described.on, described.from, {}, {}};
    std::vector<Vec> axes;
    for (const Place& axis : described.axes) axes.push_back(unit(at(axis).x));
    joint.couples = described.couples == JointNodes::Couples::along ? axes : normal_to(axes);
    if (const auto& drive = described.drive) {
      joint.actuator = Actuator{.joint = drive->joint, .axis = unit(at(drive->axis).x), .turns = drive->turns};
      if (drive->slide) {
        const BodyNodes& slide = model_.bodies[*drive->slide];
        const Vec needed = at(slide.centre).a + Vec{{0, 0, kGravity}};
        joint.actuator->on_slide = dot(needed, joint.actuator->axis) * number(slide.mass);
      }
    }
    return joint;
  }

  /// Unit vectors normal to each other and to all axes.
  static std::vector<Vec> normal_to(const std::vector<Vec>& axes) {
    constexpr double kParallel = 1e-9;
    std::vector<Vec> spanned, left;
    const auto beyond = [&](Vec v) {  // what of v is not spanned yet
      for (const auto* const list : {&spanned, &left})
        for (const Vec& u : *list) v = v - u * dot(u, v);
      return v;
    };
    for (const Vec& axis : axes)
      if (const Vec v = beyond(axis); dot(v, v) > kParallel * kParallel) spanned.push_back(unit(v));
    while (spanned.size() + left.size() < 3) {
      Vec farthest;
      for (std::size_t k = 0; k < 3; ++k) {
        Vec e;
        e[k] = 1;
        if (const Vec v = beyond(e); dot(v, v) > dot(farthest, farthest)) farthest = v;
      }
      left.push_back(unit(farthest));
    }
    return left;
  }

  const Model& model_;
  std::map<Node, Taylor> value_;
  Mat R_;
  Vec omega_, epsilon_;
};

}  // namespace

NewtonEuler newton_euler(const Evaluation& e, std::span<const double> parameters, std::size_t mode,
                         const MotionState<double>& state, const AxisVector<double>& acceleration,
                         const Wrench<double>& wrench) {
  check_masses(e, parameters);
  return System(e, parameters, mode, state, acceleration).newton_euler(wrench);
}

}  // namespace pkm::generic
