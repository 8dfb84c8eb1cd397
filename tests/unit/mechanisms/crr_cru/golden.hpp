// The golden data of (3CRR/R)&CRU and the Quadrupteron, read once, and designs made from it or at random.
#pragma once

#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/math/random.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm::testing::crr {

using namespace pkm::crr_cru;
using crr_cru::Pose;  // not pkm::Pose, to which it converts

inline constexpr double kRoundoff = 1e-12;
inline constexpr double kGoldenAccuracy = 1e-10;  // of the largest entry

inline const nlohmann::json& golden() {
  static const nlohmann::json data =
      nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/3crr-r-cru-and-quadrupteron.json"));
  return data;
}

inline const Mechanism& mechanism(const std::string& name) {
  return **std::ranges::find_if(all_mechanisms(), [&](const auto& m) { return m->info().name == name; });
}

inline const std::vector<std::string>& both() {
  static const std::vector<std::string> names = {"3crr-r-cru", "quadrupteron"};
  return names;
}

inline Platform platform(const std::string& name) {
  return name == "quadrupteron" ? Platform::rigid : Platform::jointed;
}

inline std::vector<double> nominal() {
  std::vector<double> p;
  for (const Parameter& parameter : mechanism("quadrupteron").info().parameters) p.push_back(parameter.nominal);
  return p;
}

inline Geometry<double> geometry_of(const std::string& name, const std::vector<double>& p) {
  return geometry(platform(name), std::span<const double>(p));
}

/// All parameters of a golden case: its own "params", else the nominal ones.
inline std::vector<double> design_of(const nlohmann::json& entry) {
  const auto& from = entry.contains("params") ? entry["params"] : golden()["nominal"];
  std::vector<double> p = nominal();
  for (std::size_t i = 0; i < 4; ++i) {
    p[kL11 + 2 * i] = from["l1"][i];
    p[kL12 + 2 * i] = from["l2"][i];
  }
  for (std::size_t i = 0; i < 3; ++i) p[kBeta1 + i] = from["beta"][i];
  p[kR] = from["r"];
  p[kH] = from["h"];
  p[kL] = from["l"];
  p[kRails] = from["L"];
  p[kRhoMin] = from["rho_min"];
  p[kRhoMax] = from["rho_max"];
  for (std::size_t i = 0; i < 4; ++i) {
    p[kRodMass + 2 * i] = from["mr1"][i];
    p[kRodMass + 2 * i + 1] = from["mr2"][i];
    p[kRodInertia + 2 * i] = from["Ir1"][i];
    p[kRodInertia + 2 * i + 1] = from["Ir2"][i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    p[kInertia + i] = from["I"][i];
    p[kInertia1 + i] = from["I1"][i];
  }
  p[kMass] = from["m"];
  p[kMass1] = from["m1"];
  p[kCentre] = from["c"];
  return p;
}

inline AxisVector<double> vector_of(const nlohmann::json& x) { return {x[0], x[1], x[2], x[3]}; }

inline Pose<double> pose_of(const nlohmann::json& x) { return {x[0], x[1], x[2], x[3]}; }

inline WorkingMode mode_of(const nlohmann::json& sigma) { return {sigma[0], sigma[1], sigma[2], sigma[3]}; }

/// "-,-,+,-"
inline std::string mode_name(const WorkingMode& mode) {
  std::string name;
  for (const int sign : mode) name += (name.empty() ? "" : ",") + std::string(sign > 0 ? "+" : "-");
  return name;
}

/// Uniform random numbers, the same on every platform.
class Uniform {
 public:
  explicit Uniform(int seed) : stream_(static_cast<std::uint64_t>(seed), 0, 0, Stream::Use::start) {}
  double operator()(double lower, double upper) { return lower + (upper - lower) * stream_.u01(); }

 private:
  Stream stream_;
};

/// Every length and angle up to `share` off its nominal value; the rails' range too.
inline std::vector<double> random_design(Uniform& uniform, double share) {
  std::vector<double> p = nominal();
  for (double& value : p) value *= 1 + uniform(-share, share);
  p[kRhoMin] = uniform(-0.02, 0.05);
  return p;
}

inline LimitSpec limit_spec(double s_min, double c_min, std::optional<double> clearance_min = {}) {
  return {{s_min, c_min, clearance_min}, {false, false, false}};
}

/// The plan that holds coordinate `held` at `value`.
inline SurveyPlan plan(const std::variant<ColumnOptions, VoxelOptions>& method, int held, double value,
                       const LimitSpec& limits) {
  return {.method = method,
          .held = {{.coordinate = held, .kind = HeldCoordinate::Kind::value, .value = value}},
          .limits = limits};
}

template <class S>
Survey<S> survey(const std::string& name, const std::vector<S>& p, const SurveyPlan& plan, const Demand& demand = {}) {
  Survey<S> result;
  survey_once<S>(*prepare_survey(mechanism(name), plan, demand), p, result);
  return result;
}

}  // namespace pkm::testing::crr
