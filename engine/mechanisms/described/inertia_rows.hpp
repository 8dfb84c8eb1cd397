// Inertia at the joints for the samples of a survey, 64 poses at a time: everything that depends on a swept coordinate
// is computed in rows.
#pragma once

#include <optional>

#include "engine/graph/rows.hpp"
#include "engine/mechanisms/described/evaluation.hpp"

namespace pkm::described {

/// What a worker overwrites.
struct InertiaRoom {
  std::vector<double> registers, found;
  graph::Rows rows, M_q, indices;
  std::size_t count = 0;  ///< poses that wait
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

 private:
  AxisMatrix<double> one_by_one(std::size_t pose, const InertiaRoom& room) const;

  struct Coordinate {
    std::size_t number;
    std::uint32_t slot;
  };
  std::size_t n_;
  std::vector<double> rotors_;
  graph::Program program_;
  std::optional<graph::RowStage> stage_;
  std::vector<Coordinate> coordinates_;  ///< swept ones that the program uses
  std::vector<graph::Operand> J_, M_X_;
};

}  // namespace pkm::described
