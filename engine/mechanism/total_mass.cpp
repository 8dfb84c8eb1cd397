#include "engine/mechanism/total_mass.hpp"

#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {

const TotalMass* find_total_mass(const Mechanism& mechanism) {
  return mechanism.dynamics() ? dynamic_cast<const TotalMass*>(&without_drive_trains(mechanism)) : nullptr;
}

}  // namespace pkm
