#include "engine/mechanism/ordered_margins.hpp"

#include "engine/mechanism/with_drive_trains.hpp"

namespace pkm {

const OrderedMargins* find_ordered_margins(const Mechanism& mechanism) {
  return dynamic_cast<const OrderedMargins*>(&without_drive_trains(mechanism));
}

}  // namespace pkm
