// Where the structure of columns changes, guessed from their ends: two of them meet there.
#pragma once

#include "engine/mechanisms/described/columns/ends.hpp"

namespace pkm::described {

/// The distance of two ends is zero at the change: with a sign where they are ends of two surfaces, which go on beyond;
/// squared where they are both of one, which has them on one side only.
class ColumnEvent {
 public:
  /// Begins anew, with the labels of a column's ends below a change.
  void set_below(const std::vector<EndLabel>& corners);
  /// And with those above it; where they differ by more than two ends nothing is guessed.
  void set_above(const std::vector<EndLabel>& corners);
  /// What was seen at a place. @param ends  all of them, in order
  void take(double at, const Ends& ends, const std::vector<EndLabel>& corners);
  /// A place between two: the next of the secant method, else their middle.
  double guess(double low, double high, double near);

 private:
  struct Known {
    double at, distance;
  };

  bool is_known_ = false, is_square_ = false;
  EndLabel p_ = 0, q_ = 0;
  std::vector<EndLabel> below_, above_, different_;  ///< in order
  std::vector<Known> known_;
  int guesses_ = 0;
};

}  // namespace pkm::described
