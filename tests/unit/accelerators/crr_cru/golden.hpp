// The golden data of (3CRR/R)&CRU and the Quadrupteron, read once, and designs made from it or at random.
#pragma once

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/accelerators/crr_cru/masses.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/generic/files.hpp"

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

/// The mechanism of the catalogue, with its accelerators.
inline const Mechanism& mechanism(const std::string& name) {
  return **std::ranges::find(all_mechanisms(), name, &MechanismEntry::name);
}
/// The same mechanism without them.
inline const Mechanism& generic_engine(const std::string& name) { return *test::described(name); }

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

inline std::map<std::string, double> by_name(const NamedValues& values) { return {values.begin(), values.end()}; }

/// The quantities of a pose, whether or not it assembles.
inline std::map<std::string, double> quantities(const std::string& name, const std::vector<double>& p,
                                                const pkm::Pose<double>& pose, const std::string& mode) {
  const MechanismInfo& info = mechanism(name).info();
  const auto values = mechanism(name).quantities(p, mode, no_limits(info), {.pose = pose});
  std::map<std::string, double> named;
  for (std::size_t i = 0; i < values.size(); ++i) named[info.quantities[i].name] = values[i];
  return named;
}

/// The links by name, as capsules; empty where the pose does not assemble.
inline std::map<std::string, Capsule<double>> links(const std::string& name, const std::vector<double>& p,
                                                    const pkm::Pose<double>& pose, const std::string& mode) {
  std::map<std::string, Capsule<double>> named;
  for (const PlacedLink& link : mechanism(name).links()->place(p, pose, mode)) named[link.name] = link.body;
  return named;
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

/// The plan that fixes coordinate `held` at `value`.
inline WorkspacePlan plan(const std::variant<ColumnOptions, VoxelOptions>& method, int held, double value,
                          const LimitSpec& limits) {
  return {.method = method,
          .fixed = {{.coordinate = held, .kind = FixedCoordinate::Kind::value, .value = value}},
          .limits = limits};
}

template <class S>
WorkspaceResult<S> survey(const std::string& name, const std::vector<S>& p, const WorkspacePlan& plan,
                          const FieldRequest& request = {}) {
  WorkspaceResult<S> result;
  evaluate_once<S>(*prepare_workspace(mechanism(name), plan, request), p, result);
  return result;
}

}  // namespace pkm::testing::crr
