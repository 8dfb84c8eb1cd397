// The search box of a design for coordinates without [survey] box: interval contraction of the constraints of a pose,
// rounded outward to decimal numbers. No feasible pose lies outside. The box follows the design in small steps.
#pragma once

#include <mutex>

#include "engine/generic/model.hpp"
#include "engine/workspace/bounds/feasible_hull.hpp"

namespace pkm::generic {

/// Finds the search box of a design by interval contraction. Thread-safe; stores the most recent results.
class ContractedBox {
 public:
  /// @param inputs  enclosures of the values of the model's inputs for all designs
  ContractedBox(const Model& model, const std::vector<Interval>& inputs);

  /// Whether a design lies in the enclosures that the constructor was called with.
  bool covers(const std::vector<Interval>& inputs) const;
  /// @param inputs  values of the model's inputs for a design; those of the coordinates are ignored
  /// @param start   ranges of the coordinates in which feasible poses are searched; unbounded for unknown ones
  /// @return a box that contains all feasible poses, with infinite sides where none are proven
  bounds::IntervalBox find(const std::vector<Interval>& inputs, const bounds::IntervalBox& start) const;
  /// Bounds of the contracted coordinates for the default design; they are not tight, but infinite where those of
  /// find() are.
  bounds::IntervalBox bound(const Model& model) const;

 private:
  double scale_of(const std::vector<Interval>& inputs) const;
  bounds::IntervalBox search(const std::vector<Interval>& inputs, const bounds::IntervalBox& start) const;

  std::vector<Interval> designs_;
  std::vector<bool> turns_;           ///< by coordinate, true: the coordinate is an angle
  std::vector<std::size_t> lengths_;  ///< indices of the parameters that are lengths
  bounds::FeasibleHull hull_;

  struct Known {
    std::vector<double> key;
    bounds::IntervalBox result;
  };
  mutable std::mutex mutex_;
  mutable std::vector<Known> recent_;
  mutable std::size_t next_ = 0;  ///< index in `recent_` of the result that is replaced next
};

/// Values of the model's inputs for all designs between the minimum and maximum of every parameter.
std::vector<Interval> inputs_of_all_designs(const Model& model);
/// Range in which a contracted coordinate is searched unless the mechanism file gives its reach: a full rotation for an
/// angle, all numbers for other coordinates.
Interval widest_range(const Model& model, std::size_t coordinate);
/// Advice for an error message: what the user can write in the file if a coordinate has no search box.
std::string advice_for_box(const std::string& coordinate);

}  // namespace pkm::generic
