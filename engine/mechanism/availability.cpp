#include "engine/mechanism/availability.hpp"

#include "engine/core/error.hpp"
#include "engine/geometry/mixed_units.hpp"

namespace pkm {

Unsupported why_no_conditioning(const MechanismInfo& info) {
  if (!info.characteristic_length.empty()) return {};
  const std::string what = "the conditioning of mechanism " + info.name + " is undefined: ";
  if (info.joints.size() < info.coordinates.size())
    return what + "its " + std::to_string(info.joints.size()) + " drives cannot determine its " +
           std::to_string(info.coordinates.size()) + " coordinates, so every pose is singular";
  std::vector<std::string> mixed, keys;
  if (mixes_units(info.coordinates)) {
    mixed.emplace_back("coordinates");
    keys.emplace_back("characteristic_length");
  }
  if (mixes_units(info.joints)) {
    mixed.emplace_back("drives");
    keys.emplace_back("characteristic_radius");
  }
  if (keys.empty()) return what + "it defines no characteristic length";
  return what + "its " + join(mixed, " and its ") + " include both lengths and angles; [platform] needs " +
         join(keys, " and ");
}

Unsupported why_unavailable(const Mechanism& mechanism, const PoseQuantity& quantity) {
  if (quantity.formula) return {};
  return quantity.needs_inertia() ? why_no_joint_forces(mechanism) : why_no_conditioning(mechanism.info());
}

}  // namespace pkm
