// Measure of sets of orientations in the rotation group SO(3), which counts every orientation once.
//
// Three angles a, b, c of a platform describe the orientation R = R_i(a) R_j(b) R_k(c), i, j, k = x, y or z. With the
// angular velocity w = E (da/dt, db/dt, dc/dt), the Haar measure is |det E| da db dc, where |det E| = |cos b| or, if
// the first and the third axis are the same, |sin b|. In the unit sr rad (a direction times an angle about it) all
// orientations together have the measure 8 pi^2. Every orientation has two triples: (a, b, c) and (a + pi, pi - b, c +
// pi) or, if the first and the third axis are the same, (a + pi, -b, c + pi).
//
// Reference: G. S. Chirikjian, A. B. Kyatkin, "Engineering Applications of Noncommutative Harmonic Analysis", CRC
// Press, 2001, chapter 5.
#pragma once

#include "engine/generic/model.hpp"
#include "engine/mechanism/orientations.hpp"

namespace pkm::generic {

class HaarMeasure final : public Orientations {
 public:
  /// The reason why the orientations of a mechanism have no measure: its platform does not rotate by three coordinates
  /// about axes of which adjacent ones differ. Empty if they have a measure.
  static Unsupported refusal(const Model& model);
  /// @param model  a model for which refusal() is empty
  explicit HaarMeasure(const Model& model);

  const std::vector<int>& angles() const override { return angles_; }
  Box principal_ranges() const override;
  double measure(const VoxelMap& map) const override;

 private:
  /// Integral of |det E| over the middle angle from 0 to a value in [-pi, pi].
  double antiderivative(double middle_angle) const;
  bool is_principal(double middle_angle) const;
  /// The second triple of angles that describes the same orientation as `angles`.
  std::array<double, 3> equivalent(const std::array<double, 3>& angles) const;

  std::vector<int> angles_;
  bool is_proper_euler_;  ///< the first and the third axis are the same
};

}  // namespace pkm::generic
