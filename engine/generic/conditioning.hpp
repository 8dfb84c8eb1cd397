// Conditioning of a mechanism: inverse condition number of the Jacobian with respect to the platform's twist, made
// homogeneous in units by characteristic lengths.
#pragma once

#include "engine/generic/pose_batch.hpp"

namespace pkm::generic {

/// The characteristic length, which scales rotations of the platform, and the characteristic radius, which scales
/// revolute drives if there are also prismatic ones; std::nullopt if the mechanism file does not define it.
template <class S>
struct CharacteristicLengths {
  std::optional<S> length, radius;
};
template <class S>
CharacteristicLengths<S> characteristic_lengths(const Evaluation& evaluation, std::span<const S> parameters) {
  return {evaluation.of_design<S>(evaluation.length, parameters),
          evaluation.of_design<S>(evaluation.radius, parameters)};
}

/// Throws DesignError with a message if the conditioning needs a length that is not a positive number.
void check_lengths(const Evaluation& evaluation, std::span<const double> parameters);

/// The conditioning at a pose. S is double or Dual4.
/// @param J  joints x coordinates: derivatives of the joint positions with respect to the coordinates
/// @return std::nullopt if a characteristic length that is needed is not defined, or if J is not finite
template <class S>
std::optional<S> conditioning_of(const Model& model, const CharacteristicLengths<S>& lengths, const Pose<S>& pose,
                                 const AxisMatrix<S>& J);

/// Scratch memory of SampleConditioning.
template <class S>
struct ConditioningScratch {
  /// A sample with its Jacobian.
  struct Sample {
    Pose<S> pose;
    AxisMatrix<S> J;
    S conditioning;
  };
  CharacteristicLengths<S> lengths;
  std::vector<S> registers;
  /// The last sample of the design: successive samples often have the same Jacobian, which seldom depends on all
  /// coordinates.
  std::optional<Sample> last;
};

/// Evaluates the conditioning at the samples of a workspace analysis.
class SampleConditioning {
 public:
  SampleConditioning(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode)
      : e_(evaluation), batch_(evaluation.model, evaluation.model.jacobian, swept, mode) {}

  /// Evaluates, for one design, the characteristic lengths and what does not depend on the swept coordinates.
  template <class S>
  void start(std::span<const S> parameters, const std::vector<S>& inputs, ConditioningScratch<S>& scratch) const {
    scratch.lengths = characteristic_lengths(e_, parameters);
    batch_.start<S>(inputs, scratch.registers);
    scratch.last.reset();
  }
  /// Conditioning at a pose: a value of the field kConditioning. If J is not finite, the value is that of a singular
  /// pose.
  template <class S>
  S at(const Pose<S>& pose, ConditioningScratch<S>& scratch) const;

 private:
  const Evaluation& e_;
  PoseBatch batch_;
};

}  // namespace pkm::generic
