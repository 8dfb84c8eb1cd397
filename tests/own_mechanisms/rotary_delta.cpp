// Rotary Delta robot: three driven cranks on the base, connected by parallelograms of rods to a translating platform.
#include "tests/own_mechanisms/all.hpp"
#include "tests/own_mechanisms/from_inverse.hpp"

namespace pkm::test {
namespace {

enum { kBase, kPlatform, kCrank, kRod };  // indices of the parameters

MechanismInfo delta_info() {
  MechanismInfo i;
  i.name = "rotary-delta";
  i.title = "three cranks on the base and parallelograms to a translating platform";
  i.source = "Clavel: Delta, a fast robot with parallel geometry";
  i.parameters = {{"R", "m", 0.2, 0.01, 10, "distance of the cranks' axes from the base centre"},
                  {"r", "m", 0.05, 0.01, 10, "distance of the rods' joints from the platform centre"},
                  {"l_1", "m", 0.2, 0.01, 10, "length of the cranks"},
                  {"l_2", "m", 0.45, 0.01, 10, "length of the rods"}};
  i.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}};
  i.joints = {{"q1", "rad"}, {"q2", "rad"}, {"q3", "rad"}};  // 0: crank horizontal, outwards; > 0: downwards
  i.modes = {"outwards"};
  i.sweeps = all_sweeps(i.coordinates, {0, 1, 2});
  i.characteristic_length = "l_1";
  return i;
}

/// Sine and cosine of the polar angle of the vertical plane in which crank i rotates.
SinCosOf<double> plane(std::size_t i) { return sincos(static_cast<double>(i) * 2 * kPi / 3); }

/// Position of the platform joint relative to the axis of crank i (outwards, sideways, upwards), and cosine of the
/// angle between the crank and the projection of that vector onto the plane of the crank.
template <class S>
struct Leg {
  S out, side, up, cosine;
};
template <class S>
Leg<S> leg(Parameters p, const Vector<S, 3>& at, std::size_t i) {
  const auto [sine, cosine] = plane(i);
  Leg<S> l{at[0] * cosine + at[1] * sine + S(p[kPlatform] - p[kBase]), at[1] * cosine - at[0] * sine, at[2], {}};
  const S in_plane = l.out * l.out + l.up * l.up;
  l.cosine =
      (in_plane + l.side * l.side + (p[kCrank] * p[kCrank] - p[kRod] * p[kRod])) / (sqrt(in_plane) * 2 * p[kCrank]);
  return l;
}

class RotaryDelta final : public FromInverse<RotaryDelta, 3>, Links {
 public:
  RotaryDelta() : FromInverse(delta_info()) {}
  const Links* links() const override { return this; }

  template <class S>
  Vector<S, 3> joints(Parameters p, const Vector<S, 3>& at, const std::string&) const {
    Vector<S, 3> q;
    for (std::size_t i = 0; i < 3; ++i) {
      const Leg<S> l = leg(p, at, i);
      q[i] = atan2(S(-l.up), l.out) - acos(l.cosine);
    }
    return q;
  }
  NamedValues margins(Parameters p, const Pose<double>& pose, const AxisVector<double>&, const LimitSpec&) const {
    NamedValues all = {{"below the base", -pose[2]}};
    for (std::size_t i = 0; i < 3; ++i)
      all.emplace_back("reach " + std::to_string(i + 1), 1 - std::fabs(leg(p, fixed<3>(pose), i).cosine));
    return all;
  }
  double length(Parameters p) const { return p[kCrank]; }
  std::optional<std::vector<std::array<double, 2>>> ranges(Parameters p) const override {
    // At a horizontal distance d, one of the three rods leaves the plane of its crank by at least sqrt(3/4) d.
    const double lateral = p[kRod] / std::sqrt(0.75);
    return {{{-lateral, lateral}, {-lateral, lateral}, {-p[kCrank] - p[kRod], 0}}};
  }
  std::optional<double> default_value(Parameters p, int coordinate) const override {
    return coordinate == 2 ? -p[kRod] : 0;
  }

 private:
  std::vector<PlacedLink> place(Parameters p, const Pose<double>& pose, const std::string& mode) const override {
    const AxisVector<double> q = joints(p, fixed<3>(pose), mode);
    if (!std::isfinite(q[0] + q[1] + q[2])) return {};
    std::vector<PlacedLink> all;
    const Point3<double> base_centre = {0, 0, 0}, platform_centre = {pose[0], pose[1], pose[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto point = [direction = plane(i)](const Point3<double>& from, double out, double up) {
        return Point3<double>{from[0] + out * direction.cos, from[1] + out * direction.sin, from[2] + up};
      };
      const auto [down, out] = sincos(q[i]);
      const Point3<double> axis = point(base_centre, p[kBase], 0),
                           elbow = point(axis, p[kCrank] * out, -p[kCrank] * down),
                           joint = point(platform_centre, p[kPlatform], 0);
      const std::string number = std::to_string(i + 1), limb = "limb " + number;
      all.push_back({"base", kFramePart, {{base_centre, axis}, 0.01}});
      all.push_back({"platform", kPlatformPart, {{platform_centre, joint}, 0.01}});
      all.push_back({"crank " + number, limb, {{axis, elbow}, 0.01}});
      all.push_back({"rod " + number, limb, {{elbow, joint}, 0.01}});
    }
    return all;
  }
};

}  // namespace

std::shared_ptr<const Mechanism> make_rotary_delta() { return std::make_shared<RotaryDelta>(); }

}  // namespace pkm::test
