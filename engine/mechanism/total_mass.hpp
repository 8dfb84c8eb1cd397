// Total mass of the moving bodies of a mechanism.
#pragma once

#include <span>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Computes the total mass of the moving bodies under the selected mass model [kg], without drive trains. Throws
/// DesignError if a mass is not positive.
class TotalMass {
 public:
  virtual ~TotalMass() = default;
  virtual double total_mass(std::span<const double> parameters) const = 0;
  virtual Dual4 total_mass(std::span<const Dual4> parameters) const = 0;
};

/// Finds the interface TotalMass of a mechanism, which may have been wrapped by with_drive_trains(); null if the
/// mechanism has no masses, or does not list its bodies.
const TotalMass* find_total_mass(const Mechanism& mechanism);

}  // namespace pkm
