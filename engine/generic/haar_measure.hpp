// Measure of sets of orientations in the rotation group SO(3), which counts every orientation once.
//
// Three angles a, b, c of a platform describe the orientation R = R_i(a) R_j(b) R_k(c), i, j, k = x, y or z. With the
// angular velocity w = E (da/dt, db/dt, dc/dt), the Haar measure is |det E| da db dc. In the unit sr rad (a direction
// times an angle about it) all orientations together have the measure 8 pi^2. Every orientation has two triples:
// (a, b, c) and (a + pi, pi - b, c + pi) or, if the first and the third axis are the same, (a + pi, -b, c + pi).
//
// Reference: G. S. Chirikjian, A. B. Kyatkin, "Engineering Applications of Noncommutative Harmonic Analysis", CRC
// Press, 2001, chapter 5.
#pragma once

#include "engine/generic/evaluation.hpp"
#include "engine/mechanism/orientations.hpp"

namespace pkm::generic {

class HaarMeasure final : public Orientations {
 public:
  /// The reason why the orientations of a mechanism have no measure: its platform does not rotate by three coordinates
  /// about axes of which adjacent ones differ. Empty if they have one.
  static Unsupported refusal(const Model& model);
  /// @param model  a model for which refusal() is empty
  explicit HaarMeasure(const Model& model);

  const std::vector<int>& angles() const override { return angles_; }
  Box principal_ranges() const override;
  double measure(const VoxelMap& map) const override;

 private:
  /// Measure [sr rad] of a cell with these ends of its sides.
  double measure_of_cell(const std::array<std::array<double, 2>, 3>& cell) const;
  bool is_principal(double middle_angle) const;
  /// The second triple of angles that describes the same orientation as `angles`.
  std::array<double, 3> equivalent(const std::array<double, 3>& angles) const;

  std::vector<int> angles_;
  bool is_proper_euler_ = false;    ///< the first and the third axis are the same
  expression::Program directions_;  ///< outputs: columns of E, which maps angle rates to the angular velocity
  std::array<std::size_t, 3> inputs_{};
  std::size_t count_ = 0;  ///< number of inputs of the model's graph
};

}  // namespace pkm::generic
