// The golden data of the hybrid robot, read once, and designs made from it or at random.
#pragma once

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/math/random.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/hybrid/forward.hpp"
#include "engine/mechanisms/hybrid/influence.hpp"

namespace pkm::testing::hybrid {

using namespace pkm::hybrid;

inline constexpr double kNear = 1e-12;  // golden values, and what is found in two ways

inline const nlohmann::json& golden() {
  static const nlohmann::json data = nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/2t1r-p-hybrid.json"));
  return data;
}

inline const Mechanism& mechanism() {
  return **std::ranges::find_if(all_mechanisms(), [](const auto& m) { return m->info().name == "2t1r-p-hybrid"; });
}

/// All parameters of a design of the golden data: the fields are named as they are, but for the arrays' indices.
inline std::vector<double> design_from(const nlohmann::json& fields) {
  std::vector<double> p;
  for (const Parameter& parameter : parameters()) {
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
  for (const Parameter& parameter : parameters()) p.push_back(parameter.nominal);
  return p;
}

inline Geometry<double> geometry_of(const std::vector<double>& p) { return geometry(std::span<const double>(p)); }

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

inline Vector<double, 4> vector_of(const nlohmann::json& x) { return {{x[0], x[1], x[2], x[3]}}; }

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
