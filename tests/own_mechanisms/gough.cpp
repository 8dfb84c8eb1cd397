// Gough platform: six legs of driven length.
#include "tests/own_mechanisms/all.hpp"
#include "tests/own_mechanisms/from_inverse.hpp"

namespace pkm::test {
namespace {

enum { kBase, kPlatform, kBasePair, kPlatformPair, kMinLength, kMaxLength, kMaxRotation };  // indices of the parameters

MechanismInfo gough_info() {
  MechanismInfo i;
  i.name = "gough";
  i.title = "a platform on six legs of driven length";
  i.source = "Gough, Whitehall: Universal tyre test machine; Merlet: Parallel robots";
  i.parameters = {{"R", "m", 0.5, 0.01, 10, "distance of the legs' joints from the base centre"},
                  {"r", "m", 0.3, 0.01, 10, "distance of the legs' joints from the platform centre"},
                  {"delta_R", "rad", 0.25, 0, 1, "half angle between the joints of a pair on the base"},
                  {"delta_r", "rad", 0.25, 0, 1, "half angle between the joints of a pair on the platform"},
                  {"l_min", "m", 0.6, 0.01, 10, "minimum length of the legs"},
                  {"l_max", "m", 1.1, 0.01, 10, "maximum length of the legs"},
                  {"turn_max", "rad", 1, 0.1, 1.5, "maximum rotation about each axis"}};
  i.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"alpha", "rad"}, {"beta", "rad"}, {"gamma", "rad"}};
  for (const char* name : {"l1", "l2", "l3", "l4", "l5", "l6"}) i.joints.push_back({name, "m"});
  i.modes = {"above"};
  i.sweeps = all_sweeps(i.coordinates, {0, 1, 2});
  i.characteristic_length = "r";
  return i;
}

/// Sine and cosine of the polar angle of a leg's joint. The two legs of a pair on the base end at different pairs on
/// the platform.
/// @param offset  half angle between the joints of a pair [rad]
SinCosOf<double> on_circle(std::size_t leg, double offset) {
  return sincos(static_cast<double>(leg / 2) * 2 * kPi / 3 + (leg % 2 ? offset : -offset));
}
Vector<double, 3> base_joint(Parameters p, std::size_t leg) {
  const auto [sine, cosine] = on_circle(leg, p[kBasePair]);
  return {{p[kBase] * cosine, p[kBase] * sine, 0}};
}
/// Joint of a leg on the platform, whose rotation is Rz(gamma) Ry(beta) Rx(alpha).
template <class S>
Vector<S, 3> platform_joint(Parameters p, const Vector<S, 6>& at, std::size_t leg) {
  const auto [sine, cosine] = on_circle(leg, kPi / 3 - p[kPlatformPair]);
  const double x = p[kPlatform] * cosine, y = p[kPlatform] * sine;
  const auto [sa, ca] = sincos(at[3]);
  const auto [sb, cb] = sincos(at[4]);
  const auto [sc, cc] = sincos(at[5]);
  return {{at[0] + cc * cb * x + (cc * sb * sa - sc * ca) * y, at[1] + sc * cb * x + (sc * sb * sa + cc * ca) * y,
           at[2] - sb * x + cb * sa * y}};
}

class Gough final : public FromInverse<Gough, 6>, Links {
 public:
  Gough() : FromInverse(gough_info()) {}
  const Links* links() const override { return this; }

  template <class S>
  Vector<S, 6> joints(Parameters p, const Vector<S, 6>& at, const std::string&) const {
    Vector<S, 6> lengths;
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector<S, 3> leg_vector = platform_joint(p, at, i) - base_joint(p, i);
      lengths[i] = sqrt(dot(leg_vector, leg_vector));
    }
    return lengths;
  }
  NamedValues margins(Parameters p, const Pose<double>& pose, const AxisVector<double>& lengths,
                      const LimitSpec&) const {
    NamedValues all = {{"above the base", pose[2]}};
    for (std::size_t i = 0; i < 6; ++i) {
      all.emplace_back("l" + std::to_string(i + 1) + " min", lengths[i] - p[kMinLength]);
      all.emplace_back("l" + std::to_string(i + 1) + " max", p[kMaxLength] - lengths[i]);
    }
    for (std::size_t i = 3; i < 6; ++i)
      all.emplace_back(info().coordinates[i].name, p[kMaxRotation] - std::fabs(pose[i]));
    return all;
  }
  double length(Parameters p) const { return p[kPlatform]; }
  std::optional<std::vector<std::array<double, 2>>> ranges(Parameters p) const override {
    const double l = p[kMaxLength], r = p[kMaxRotation];  // the centres are at most one leg length apart
    return {{{-l, l}, {-l, l}, {0, l}, {-r, r}, {-r, r}, {-r, r}}};
  }
  std::optional<double> default_value(Parameters p, int coordinate) const override {
    if (coordinate != 2) return 0;
    const double half = (p[kMinLength] + p[kMaxLength]) / 2, horizontal = joints(p, Vector<double, 6>(), "")[0];
    return half > horizontal ? std::sqrt(half * half - horizontal * horizontal) : 0;
  }

 private:
  std::vector<PlacedLink> place(Parameters p, const Pose<double>& pose, const std::string&) const override {
    std::vector<PlacedLink> all;
    const Point3<double> base_centre = {0, 0, 0}, platform_centre = {pose[0], pose[1], pose[2]};
    for (std::size_t i = 0; i < 6; ++i) {
      const Point3<double> from = base_joint(p, i).m, to = platform_joint(p, fixed<6>(pose), i).m;
      const std::string number = std::to_string(i + 1);
      all.push_back({"base", kFramePart, {{base_centre, from}, 0.01}});
      all.push_back({"platform", kPlatformPart, {{platform_centre, to}, 0.01}});
      all.push_back({"telescopic leg " + number, "limb " + number, {{from, to}, 0.02}});
    }
    return all;
  }
};

}  // namespace

std::shared_ptr<const Mechanism> make_gough() { return std::make_shared<Gough>(); }

}  // namespace pkm::test
