#include "engine/mechanism/orientations.hpp"

#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {
namespace {

const WithOrientations* find_orientations(const Mechanism& mechanism) {
  return dynamic_cast<const WithOrientations*>(&without_drive_trains(mechanism));
}

}  // namespace

std::unique_ptr<const Orientations> orientations_of(const Mechanism& mechanism) {
  const WithOrientations* const found = find_orientations(mechanism);
  return found ? found->orientations() : nullptr;
}

Unsupported why_no_orientations(const Mechanism& mechanism) {
  if (const WithOrientations* const found = find_orientations(mechanism)) return found->why_no_orientations();
  return "the orientations of mechanism " + mechanism.info().name + " need a mechanism file";
}

}  // namespace pkm
