// Conditioning of a described mechanism's Jacobian, for numbers and for derivatives.
#pragma once

#include "engine/generic/pose_rows.hpp"

namespace pkm::generic {

/// Characteristic lengths of a design, where they are described: of the platform's turns, and of the drives'.
template <class S>
struct CharacteristicLengths {
  std::optional<S> length, radius;
};
template <class S>
CharacteristicLengths<S> characteristic_lengths(const Evaluation& evaluation, std::span<const S> parameters) {
  return {evaluation.of_design<S>(evaluation.length, parameters),
          evaluation.of_design<S>(evaluation.radius, parameters)};
}

/// Of the Jacobian by the twist, its turns in units of the characteristic length, turning drives of the radius. None
/// where they are needed and not described, or J is not finite. S is double or Dual4.
template <class S>
std::optional<S> conditioning_of(const Model& model, const CharacteristicLengths<S>& lengths, const Pose<S>& pose,
                                 const AxisMatrix<S>& J);

/// The conditioning of samples.
class SampleConditioning {
 public:
  template <class S>
  struct Room {
    CharacteristicLengths<S> lengths;
    std::vector<S> registers;
  };

  SampleConditioning(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode)
      : e_(evaluation), rows_(evaluation.model, evaluation.model.jacobian, swept, mode) {}

  /// Computes what no swept coordinate changes. @param inputs  of the design, with held coordinates
  template <class S>
  void start(std::span<const S> parameters, const std::vector<S>& inputs, Room<S>& room) const {
    room.lengths = characteristic_lengths(e_, parameters);
    rows_.start<S>(inputs, room.registers);
  }
  /// What a survey's field takes.
  template <class S>
  S at(const Pose<S>& pose, Room<S>& room) const;

 private:
  const Evaluation& e_;
  PoseRows rows_;
};

}  // namespace pkm::generic
