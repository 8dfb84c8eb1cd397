// Constraints g >= 0 or g > 0 as functions of poses and of further variables, for example deviations of parameters:
// values and first derivatives, in interval arithmetic over boxes and in double precision at points.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/expression/program.hpp"

namespace pkm::bounds {

struct ParametricConstraint {
  std::string name;
  expression::Node node;
  bool is_strict = false;  ///< true: the constraint is g > 0; false: g >= 0
  /// For a constraint on a determinant: the matrix that has full rank where the constraint is not 0, with at least as
  /// many rows as columns, row by row. Empty: there is none.
  std::vector<expression::Node> matrix = {};
  std::size_t columns = 0;  ///< number of columns of the matrix
};

/// Constraints g >= 0 or g > 0 over poses and further variables. Immutable after the last call of add(), and then
/// thread-safe.
class ParametricConstraints {
 public:
  struct Gradient {
    Interval value;
    std::vector<Interval> by_axis;
    bool is_known = false;  ///< the constraint is continuous, and all partial derivatives are enclosed
  };
  /// Scratch memory of one worker thread.
  struct Scratch {
    std::vector<std::vector<Interval>> inputs;  ///< values of all inputs of each graph, as intervals
    std::vector<std::vector<double>> numbers;   ///< values of all inputs of each graph, in double precision
    std::vector<Interval> registers;
    std::vector<double> number_registers;
  };

  /// Adds constraints of one graph; identical ones are added once.
  /// @param axes    indices of the graph's inputs that are the axes, in the same order for all graphs
  /// @param inputs  values of all inputs of the graph; inputs that are not axes keep these values
  void add(expression::Graph graph, const std::vector<ParametricConstraint>& constraints,
           const std::vector<std::size_t>& axes, std::vector<Interval> inputs);

  std::size_t size() const { return all_.size(); }
  std::size_t axes() const { return graphs_.empty() ? 0 : graphs_.front().axes.size(); }
  const std::string& name(std::size_t k) const { return all_[k].name; }
  Scratch make_scratch() const;

  /// Whether an enclosure proves that constraint k is satisfied, or that it is violated, everywhere.
  bool is_satisfied(std::size_t k, const Interval& value) const {
    return value.is_certified_satisfied() && (!all_[k].is_strict || value.lower > 0);
  }
  bool is_violated(std::size_t k, const Interval& value) const {
    return value.is_certified_violated() || (all_[k].is_strict && value.upper <= 0);
  }
  /// True if a value in double precision means that constraint k is violated. NaN means a violation.
  bool is_violated(std::size_t k, double value) const { return !(all_[k].is_strict ? value > 0 : value >= 0); }

  /// Enclosure of the value of constraint k over a box; gradient() also encloses its derivatives.
  /// @param sides  side of the box along each axis
  Interval value(std::size_t k, std::span<const Interval> sides, Scratch& scratch) const;
  void gradient(std::size_t k, std::span<const Interval> sides, Gradient& to, Scratch& scratch) const;
  /// Whether the matrix of constraint k is continuous on a box and proved to have full rank there, so that the
  /// constraint has the same sign in the whole box; false if there is no matrix.
  bool has_one_sign(std::size_t k, std::span<const Interval> sides, Scratch& scratch) const;
  /// Value of constraint k at a point, in double precision; `by_axis` receives its derivatives with respect to the
  /// axes.
  double gradient(std::size_t k, std::span<const double> point, std::vector<double>& by_axis, Scratch& scratch) const;

 private:
  struct OfGraph {
    std::vector<std::size_t> axes;
    std::vector<Interval> inputs;
  };
  struct Constraint {
    std::string name;
    bool is_strict;
    std::size_t graph;
    expression::Program value, gradient;
    expression::Program matrix;  ///< entries of the matrix of a constraint on a determinant
    std::size_t columns;         ///< number of columns of the matrix; 0: there is none
  };

  std::vector<OfGraph> graphs_;
  std::vector<Constraint> all_;
};

}  // namespace pkm::bounds
