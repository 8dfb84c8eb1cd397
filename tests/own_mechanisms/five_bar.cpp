// Planar five-bar mechanism (5R): two driven cranks on the base and two rods that are joined at the tool.
#include "tests/own_mechanisms/all.hpp"
#include "tests/own_mechanisms/from_inverse.hpp"

namespace pkm::test {
namespace {

enum { kBase, kCrank, kRod };  // indices of the parameters

MechanismInfo five_bar_info() {
  MechanismInfo i;
  i.name = "five-bar";
  i.title = "two cranks on the base and two rods joined at the tool";
  i.source = "Liu, Wang, Pritschow: Kinematics, singularity and workspace of planar 5R symmetrical parallel mechanisms";
  i.parameters = {{"b", "m", 0.2, 0.01, 10, "distance of the cranks' axes"},
                  {"l_1", "m", 0.25, 0.01, 10, "length of the cranks"},
                  {"l_2", "m", 0.35, 0.01, 10, "length of the rods"}};
  i.coordinates = {{"x", "m"}, {"y", "m"}};
  i.joints = {{"q1", "rad"}, {"q2", "rad"}};
  i.modes = {"+,-", "+,+", "-,-", "-,+"};  // sign of the angle from the line to the tool to each crank
  i.sweeps = all_sweeps(i.coordinates, {0, 1});
  i.limits = {{"sin_rods_min", "1", 0, 0, 1, "singularity-margin", "", "minimum sine of the angle between the rods"}};
  i.characteristic_length = "l_1";
  return i;
}

/// x coordinate of the axis of crank 0 or 1.
double axis(Parameters p, std::size_t i) { return (i == 0 ? -0.5 : 0.5) * p[kBase]; }
Vector<double, 2> elbow(Parameters p, const AxisVector<double>& q, std::size_t i) {
  const auto [sine, cosine] = sincos(q[i]);
  return {{axis(p, i) + p[kCrank] * cosine, p[kCrank] * sine}};
}

class FiveBar final : public FromInverse<FiveBar, 2>, ForwardKinematics, Links {
 public:
  FiveBar() : FromInverse(five_bar_info()) {}
  const ForwardKinematics* forward() const override { return this; }
  const Links* links() const override { return this; }

  template <class S>
  Vector<S, 2> joints(Parameters p, const Vector<S, 2>& at, const std::string& mode) const {
    Vector<S, 2> q;
    for (std::size_t i = 0; i < 2; ++i) {
      const S x = at[0] - S(axis(p, i)), y = at[1], square = x * x + y * y;
      const S crank_angle =
          acos(S((square + (p[kCrank] * p[kCrank] - p[kRod] * p[kRod])) / (sqrt(square) * 2 * p[kCrank])));
      q[i] = atan2(y, x) + crank_angle * (mode[2 * i] == '+' ? 1.0 : -1.0);
    }
    return q;
  }
  NamedValues margins(Parameters p, const Pose<double>& pose, const AxisVector<double>& q,
                      const LimitSpec& limits) const {
    NamedValues all = {{"above the base", pose[1]}};
    for (std::size_t i = 0; i < 2; ++i) {
      const double distance = std::hypot(pose[0] - axis(p, i), pose[1]);
      const std::string number = std::to_string(i + 1);
      all.emplace_back("stretched " + number, p[kCrank] + p[kRod] - distance);
      all.emplace_back("folded " + number, distance - std::fabs(p[kCrank] - p[kRod]));
    }
    if (!std::isfinite(q[0] + q[1])) return all;
    const Vector<double, 2> a = elbow(p, q, 0), b = elbow(p, q, 1);
    const double cross = (pose[0] - a[0]) * (pose[1] - b[1]) - (pose[1] - a[1]) * (pose[0] - b[0]);
    all.emplace_back("sin_rods", cross / (p[kRod] * p[kRod]) - limits.given[0].value_or(0));
    return all;
  }
  double length(Parameters p) const { return p[kCrank]; }
  std::optional<std::vector<std::array<double, 2>>> ranges(Parameters p) const override {
    const double reach = p[kCrank] + p[kRod];
    return {{{-reach, reach}, {0, reach}}};
  }
  std::optional<double> default_value(Parameters p, int coordinate) const override {
    return coordinate == 0 ? 0 : (p[kCrank] + p[kRod]) / 2;
  }

 private:
  std::vector<AssemblyMode> assemblies(Parameters p, const AxisVector<double>& q) const override {
    const Vector<double, 2> a = elbow(p, q, 0), b = elbow(p, q, 1), d = b - a;
    const double square = dot(d, d), height = std::sqrt(p[kRod] * p[kRod] / square - 0.25);
    std::vector<AssemblyMode> found;
    for (const double sign : {1.0, -1.0}) {
      const Pose<double> pose = {(a[0] + b[0]) / 2 - sign * height * d[1], (a[1] + b[1]) / 2 + sign * height * d[0]};
      if (std::isfinite(pose[0])) found.push_back({pose, sign > 0 ? "+" : "-"});
    }
    return found;
  }
  std::vector<PlacedLink> place(Parameters p, const Pose<double>& pose, const std::string& mode) const override {
    const AxisVector<double> q = joints(p, fixed<2>(pose), mode);
    if (!std::isfinite(q[0] + q[1])) return {};
    const auto link = [](std::string name, std::string part, double x, double y, double to_x, double to_y, double z) {
      return PlacedLink{std::move(name), std::move(part), {{{x, y, 0}, {to_x, to_y, z}}, 0.01}};
    };
    std::vector<PlacedLink> all = {link("base", kFramePart, axis(p, 0), 0, axis(p, 1), 0, 0),
                                   link("tool", kPlatformPart, pose[0], pose[1], pose[0], pose[1], -0.05)};
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector<double, 2> at = elbow(p, q, i);
      const std::string number = std::to_string(i + 1);
      all.push_back(link("crank " + number, "limb " + number, axis(p, i), 0, at[0], at[1], 0));
      all.push_back(link("rod " + number, "limb " + number, at[0], at[1], pose[0], pose[1], 0));
    }
    return all;
  }
};

}  // namespace

std::shared_ptr<const Mechanism> make_five_bar() { return std::make_shared<FiveBar>(); }

}  // namespace pkm::test
