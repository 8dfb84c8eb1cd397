// Facts about a design of a mechanism file: joint ranges, masses of bodies, and drives.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/design_facts.hpp"

namespace pkm::generic {

std::vector<std::optional<std::array<double, 2>>> joint_ranges(const Evaluation& e, std::span<const double> parameters);
std::vector<std::pair<std::string, double>> body_masses(const Evaluation& e, std::span<const double> parameters);

/// Finds joint, point, axis and position of each drive of a design at a pose that assembles. Immutable.
class DrivePlaces {
 public:
  /// @param e     must outlive this object
  /// @param mode  index in MechanismInfo::modes
  DrivePlaces(const Evaluation& e, std::span<const double> parameters, std::size_t mode);
  std::vector<PlacedDrive> operator()(const Pose<double>& pose) const;

 private:
  std::size_t coordinates_;                ///< index of the first coordinate among the inputs of the graph
  std::vector<const JointNodes*> driven_;  ///< joints with drives; joints of parallel rods may share a drive
  expression::Program program_;            ///< outputs: point, axis and position of each driven joint
  std::vector<double> inputs_;  ///< values of the graph's inputs for the design; those of the coordinates are 0
};

}  // namespace pkm::generic
