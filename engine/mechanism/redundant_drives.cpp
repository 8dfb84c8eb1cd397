#include "engine/mechanism/redundant_drives.hpp"

#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {
namespace {

constexpr const char* kNoTensions = "no tensions within their limits balance the load";

}  // namespace

const LimitedDrives* find_limited_drives(const Mechanism& mechanism) {
  return dynamic_cast<const LimitedDrives*>(&without_drive_trains(mechanism));
}

DriveLimits drive_limits(const Mechanism& mechanism, std::span<const double> parameters) {
  const LimitedDrives* const drives = find_limited_drives(mechanism);
  return drives ? drives->drive_limits(parameters) : no_drive_limits(mechanism.info().joints.size());
}

Unsupported why_no_drive_forces(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  if (!mechanism.dynamics() || info.joints.size() <= info.coordinates.size()) return why_no_joint_forces(mechanism);
  return {};
}

DistributedForces distributed_forces(const PoseDynamics<double>& d, const AxisVector<double>& acceleration,
                                     const Wrench<double>& wrench, const DriveLimits& limits) {
  if (is_rank_deficient(d.J)) return {{}, "the Jacobian is singular to working precision"};
  if (d.J.rows() == d.J.cols()) {
    const AxisVector<double> tau = drive_forces(d, acceleration, wrench);
    for (std::size_t i = 0; i < tau.size(); ++i)
      if (!(tau[i] >= limits.lower[i] && tau[i] <= limits.upper[i])) return {{}, kNoTensions};
    return {tau, ""};
  }
  const AxisVector<double> load = d.M_X * acceleration + d.h_X + d.G_X - transpose(d.J_wrench) * wrench;
  const auto tau = distribute_forces(d.J, load, limits);
  if (!tau) return {{}, kNoTensions};
  return {tau, ""};
}

}  // namespace pkm
