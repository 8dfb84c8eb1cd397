// Sign changes of constraints along a coordinate, by interval branch and prune: an interval is discarded if a
// constraint has one sign in it, has one change if the constraint is monotonic in it, and is bisected otherwise. No
// change is missed; where signs remain undecided, in intervals that are very short or after many bisections, their
// length is reported.
#pragma once

#include <vector>

#include "engine/expression/program.hpp"
#include "engine/generic/columns/endpoints.hpp"
#include "engine/math/interval.hpp"

namespace pkm::generic {

/// Indices of the registers of a constraint's value and of its derivative with respect to the coordinate.
struct WithDerivative {
  std::uint32_t value, derivative;
};

struct SignChange {
  double at;
  std::size_t constraint;  ///< index in the list of constraints given to find_sign_changes()
  bool falls;              ///< true: the constraint is satisfied below `at` and violated above it
};

/// Result and scratch memory of find_sign_changes().
struct SignChangeScratch {
  std::vector<SignChange> found;  ///< all sign changes, in no particular order
  double undecided = 0;           ///< total length of the intervals in which the sign of a constraint is unknown
  long evaluations = 0;           ///< number of intervals that the last search evaluated

  struct Part {
    double from, to;
    Signs undecided;  ///< set of the constraints whose sign in the interval is unknown
  };
  std::vector<Part> parts, halves;
  std::vector<Interval> registers;
};

/// Finds the sign changes in [from, to] of constraints that a stage of a program computes from a single coordinate.
/// @param stage            index of the stage
/// @param constraints      registers of at most kMaxSurfaces constraints
/// @param max_evaluations  limit on the number of evaluated intervals; it may be exceeded by a few
/// @param registers        values after all earlier stages; those of this stage are overwritten
void find_sign_changes(const expression::Program& program, std::size_t stage,
                       std::span<const WithDerivative> constraints, double from, double to, long max_evaluations,
                       std::span<double> registers, SignChangeScratch& scratch);

}  // namespace pkm::generic
