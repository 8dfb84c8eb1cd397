// The golden data of the hybrid robot, read once, and designs made from it or at random.
#pragma once

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/accelerators/hybrid/forward.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/math/random.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::testing::hybrid {

using namespace pkm::hybrid;

inline constexpr double kNear = 1e-12;  // golden values, and what is found in two ways

inline const nlohmann::json& golden() {
  static const nlohmann::json data = nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/2t1r-p-hybrid.json"));
  return data;
}

/// The mechanism of the catalogue, with its accelerators.
inline const Mechanism& mechanism() {
  return **std::ranges::find(all_mechanisms(), "2t1r-p-hybrid", &MechanismEntry::name);
}
/// The same mechanism without them.
inline const Mechanism& generic_engine() { return *test::described("2t1r-p-hybrid"); }

/// All parameters of a design of the golden data: the fields are named as they are, but for the arrays' indices.
inline std::vector<double> design_from(const nlohmann::json& fields) {
  std::vector<double> p;
  for (const Parameter& parameter : mechanism().info().parameters) {
    const std::string& name = parameter.name;
    const bool indexed = name.starts_with("s_m");
    p.push_back(indexed ? fields[name.substr(0, 5)][static_cast<std::size_t>(name.back() - '1')] : fields[name]);
  }
  return p;
}

/// The design that an entry refers to.
inline std::vector<double> design_of(const nlohmann::json& entry) {
  if (entry.contains("design_inline")) return design_from(entry["design_inline"]);
  return design_from(golden()["designs"][entry["design"].get<std::size_t>()]);
}

inline std::vector<double> nominal() {
  std::vector<double> p;
  for (const Parameter& parameter : mechanism().info().parameters) p.push_back(parameter.nominal);
  return p;
}

inline Geometry<double> geometry_of(const std::vector<double>& p) { return geometry(std::span<const double>(p)); }

/// Inverse kinematics in closed form. In masks, bit 0 is limb A, bit 1 B, bit 2 C. For a limb out of reach n is 0, and
/// s is finite but meaningless.
template <class S>
struct Joints : Limbs<S> {
  std::array<S, 4> s;      ///< drives s1, s2, s3, s4 [m]
  unsigned unreached = 0;  ///< limbs out of reach
  unsigned serial = 0;     ///< limbs normal to their rail, n = 0: serially singular
  bool assembles() const { return unreached == 0; }
};

template <class S>
Joints<S> inverse(const Geometry<S>& g, const SchoenfliesPose<S>& pose, const WorkingMode& mode) {
  const auto [sin_b, cos_b] = sincos(pose.angle);
  Joints<S> j;
  const auto root = [&](const S& square, const S& L, std::size_t limb) {
    const double tolerance = kRoundoff * value_of(L) * value_of(L);
    const unsigned bit = 1u << limb;
    if (value_of(square) < -tolerance) j.unreached |= bit;
    if (std::fabs(value_of(square)) <= tolerance) j.serial |= bit;
    return value_of(square) > tolerance ? S(sqrt(square) * static_cast<double>(mode[limb])) : S(0.0);
  };
  static_cast<Limbs<S>&>(j) = limbs(g, pose.z, sin_b, cos_b, root);
  const S& x = pose.x;
  j.s = {x - g.a + g.b1 - j.n1, pose.y, x + g.a - g.b2 - j.n2, x - g.c - j.n3};
  return j;
}

/// The signs in a name such as "+,-,0".
inline std::vector<int> signs_of(const std::string& name) {
  std::vector<int> signs;
  for (std::size_t i = 0; i < name.size(); i += 2) signs.push_back(name[i] == '+' ? 1 : name[i] == '-' ? -1 : 0);
  return signs;
}

inline SchoenfliesPose<double> pose_of(const nlohmann::json& x) { return {x[0], x[1], x[2], x[3]}; }

inline WorkingMode mode_of(const nlohmann::json& wm) { return {wm[0], wm[1], wm[2]}; }

/// "+,-,-", with "/-" behind it where the branch N2 < 0 is required.
inline std::string mode_name(const WorkingMode& mode, int branch = 1) {
  std::string name;
  for (const int sign : mode) name += (name.empty() ? "" : ",") + std::string(sign > 0 ? "+" : "-");
  return branch > 0 ? name : name + "/-";
}

inline std::vector<WorkingMode> all_signs() {
  std::vector<WorkingMode> modes;
  for (const int w1 : {1, -1})
    for (const int w2 : {1, -1})
      for (const int w3 : {1, -1}) modes.push_back({w1, w2, w3});
  return modes;
}

inline AxisVector<double> vector_of(const nlohmann::json& x) { return {x[0], x[1], x[2], x[3]}; }

inline std::map<std::string, double> by_name(const NamedValues& values) { return {values.begin(), values.end()}; }

/// No thresholds but the design's own.
inline LimitSpec no_thresholds() { return no_limits(mechanism().info()); }

/// The quantities by name.
/// @param values  in the order of MechanismInfo::quantities
inline std::map<std::string, double> named_quantities(const std::vector<double>& values) {
  std::map<std::string, double> named;
  for (std::size_t i = 0; i < values.size(); ++i) named[mechanism().info().quantities[i].name] = values[i];
  return named;
}

/// The mechanism's inputs: the angle of the input shaft, the phase of the forks, the output angle that is wanted.
inline std::vector<InputSample> inputs_of(const InputSample& theta, double zeta = 0, double gamma_wanted = 0) {
  return {theta, {.value = zeta}, {.value = gamma_wanted}};
}

/// The quantities of a pose and its motion, in the default working mode, whether or not it assembles.
inline std::map<std::string, double> quantities(const std::vector<double>& p, const MotionSample& at) {
  return named_quantities(mechanism().quantities(p, mechanism().info().modes.front(), no_thresholds(), at));
}

/// Uniform random numbers, the same on every platform.
class Uniform {
 public:
  explicit Uniform(int seed) : stream_(static_cast<std::uint64_t>(seed), 0, 0, Stream::Use::start) {}
  double operator()(double lower, double upper) { return lower + (upper - lower) * stream_.u01(); }

 private:
  Stream stream_;
};

/// Every length up to 40 % off its nominal value, the assumed offsets and phase at random.
inline std::vector<double> random_design(Uniform& uniform) {
  std::vector<double> p = nominal();
  for (std::size_t i = kA; i <= kFp; ++i) p[i] *= 1 + uniform(-0.4, 0.4);
  p[kH1] = uniform(-0.03, 0.03);
  p[kH2] = uniform(-0.03, 0.03);
  p[kTheta0] = uniform(-3, 3);
  return p;
}

/// A pose whose limbs A and B reach, unless they are much longer or shorter than nominal; any rotation.
inline SchoenfliesPose<double> random_pose(Uniform& uniform) {
  return {uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-kPi, kPi)};
}

}  // namespace pkm::testing::hybrid
