// Measure of sets of orientations of a platform.
#pragma once

#include <memory>
#include <vector>

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/workspace_result.hpp"

namespace pkm {

/// Unit of the Haar measure of orientations: a solid angle of directions times an angle about them. All orientations
/// have the measure 8 pi^2.
inline constexpr const char* kOrientationUnit = "sr rad";

/// Three coordinates that are the angles of the platform's orientation, and the measure of sets of orientations.
/// Immutable and thread-safe.
class Orientations {
 public:
  virtual ~Orientations() = default;
  /// The three angles that describe an orientation, as indices of coordinates.
  virtual const std::vector<int>& angles() const = 0;
  /// The principal ranges of the angles, which contain every orientation once.
  virtual Box principal_ranges() const = 0;
  /// Haar measure [sr rad] of the feasible cells of a map whose axes are the angles, each within [-pi, pi]. An
  /// orientation that two cells contain counts once.
  virtual double measure(const VoxelMap& map) const = 0;
};

/// Interface of mechanisms that can measure sets of orientations of the platform if three angles describe it.
class WithOrientations {
 public:
  virtual ~WithOrientations() = default;
  /// The reason if orientations() is null; empty otherwise.
  virtual Unsupported why_no_orientations() const = 0;
  virtual std::unique_ptr<const Orientations> orientations() const = 0;
};

/// The orientations of a mechanism, which may have been wrapped by with_drive_trains(); null if there are none.
std::unique_ptr<const Orientations> orientations_of(const Mechanism& mechanism);
/// The reason why orientations_of() is null; empty otherwise.
Unsupported why_no_orientations(const Mechanism& mechanism);

}  // namespace pkm
