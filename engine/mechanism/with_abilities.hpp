// A mechanism that has the abilities it is derived from.
#pragma once

#include <type_traits>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

template <class... Abilities>
class MechanismWith : public Mechanism, public Abilities... {
 public:
  const Voxels* voxels() const final { return as<Voxels>(); }
  const Columns* columns() const final { return as<Columns>(); }
  const RigorousBounds* bounds() const final { return as<RigorousBounds>(); }
  const Size* size() const final { return as<Size>(); }
  const DesignTests* design_tests() const final { return as<DesignTests>(); }
  const PoseMargins* pose_margins() const final { return as<PoseMargins>(); }
  const Velocities* velocities() const final { return as<Velocities>(); }
  const ForwardKinematics* forward() const final { return as<ForwardKinematics>(); }
  const Links* links() const final { return as<Links>(); }
  const Dynamics* dynamics() const final { return as<Dynamics>(); }
  const JointReactions* reactions() const final { return as<JointReactions>(); }

 private:
  template <class Ability>
  const Ability* as() const {
    if constexpr (std::is_base_of_v<Ability, MechanismWith>) return this;
    return nullptr;
  }
};

}  // namespace pkm
