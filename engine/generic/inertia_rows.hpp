// Inertia at the joints for the samples of a survey, 64 poses at a time.
#pragma once

#include "engine/generic/pose_rows.hpp"

namespace pkm::generic {

/// What a worker overwrites.
struct InertiaRoom {
  PoseRowsRoom poses;
  std::vector<double> found;
  expression::Rows M_q, indices;
  std::vector<Dual4> moving;  ///< registers with derivatives
};

class InertiaRows {
 public:
  /// @param evaluation  of a model with bodies
  /// @param rotors      Demand::rotors
  InertiaRows(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
              const std::vector<double>& rotors);

  /// Computes what no swept coordinate changes. @param inputs  of the design, with held coordinates
  void start(const std::vector<double>& inputs, InertiaRoom& room) const;
  /// Adds the pose's values to the fields of a survey, in the order of the poses, after the last one by finish().
  void add(const Pose<double>& pose, InertiaRoom& room, Survey<double>& to) const;
  void finish(InertiaRoom& room, Survey<double>& to) const;
  /// The same with derivatives, one by one.
  void start(const std::vector<Dual4>& inputs, InertiaRoom& room) const;
  void add(const Pose<Dual4>& pose, InertiaRoom& room, Survey<Dual4>& to) const;
  void finish(InertiaRoom&, Survey<Dual4>&) const {}

 private:
  /// @param output  [](std::size_t), of rows_
  template <class S, class OutputOf>
  AxisMatrix<S> one_by_one(const OutputOf& output) const;

  std::size_t n_;
  std::vector<double> rotors_;
  PoseRows rows_;
  std::vector<expression::Operand> J_, M_X_;
};

}  // namespace pkm::generic
