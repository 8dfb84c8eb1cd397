// Constraints g >= 0 as interval programs: enclosures of their values and of their partial derivatives over boxes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/expression/program.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::bounds {

inline constexpr std::size_t kMaxAxes = kMaxCoordinates;

class ForceBalance;

/// Sides of a box by axis; elements beyond the number of axes are unused.
using IntervalBox = std::array<Interval, kMaxAxes>;

/// Enclosures of a constraint's value and partial derivatives over a box.
struct Derivatives {
  Interval value;
  std::array<Interval, kMaxAxes> by_axis;
  bool is_known = false;                  ///< the constraint is continuous, and all partial derivatives are enclosed
  bool is_last_derivative_known = false;  ///< the constraint is continuous, and `by_axis` of the last axis is enclosed
};

struct NamedConstraint {
  std::string name;
  expression::Node node;
};

/// Constraints g >= 0 that are compiled to an interval program. Immutable and thread-safe.
class Constraints {
 public:
  /// Registers of one worker. They cache results: program steps that do not depend on the last axis are evaluated once
  /// per box, and common subexpressions of several constraints are evaluated once.
  class Scratch {
    friend Constraints;
    std::vector<Interval> registers_;
    std::vector<std::uint64_t> versions_;   ///< for each register, the version of the inputs for which it was computed
    std::vector<std::uint64_t> evaluated_;  ///< for each subprogram, the version of the box for which its steps
                                            ///< that do not depend on the last axis were run
    std::uint64_t version_ = 0, box_version_ = 0, last_version_ = 0;
    Interval last_side_;  ///< side of the box along the last axis
    IntervalBox box_;     ///< sides of the box along the other axes
  };

  /// @param axes    indices of the graph's inputs that are the axes
  /// @param inputs  values of all inputs of the graph; inputs that are not axes keep these values
  Constraints(expression::Graph graph, const std::vector<NamedConstraint>& constraints, std::vector<std::size_t> axes,
              std::vector<Interval> inputs);

  /// Decides a constraint on boxes by the balance of forces, which it states; its formula is evaluated where that is
  /// undecided, and at single poses.
  /// @param node  node of the constraint in the graph passed to the constructor
  void decide_by_balance(expression::Node node, std::shared_ptr<const ForceBalance> balance);

  /// Number of distinct constraints: identical ones are merged.
  std::size_t size() const { return all_.size(); }
  std::size_t axes() const { return axes_.size(); }
  const std::string& name(std::size_t k) const { return all_[k].name; }
  expression::Node node(std::size_t k) const { return all_[k].node; }  ///< node in the graph passed to the constructor
  bool depends(std::size_t k, std::size_t axis) const { return all_[k].depends[axis]; }
  Scratch make_scratch() const { return initial_; }

  /// Sets the sides of all axes but the last one, whose side is an argument of value() and derivatives().
  void set_box(const IntervalBox& box, Scratch& scratch) const;
  /// Enclosure of the value of constraint k over the box. @param last_side  side of the box along the last axis
  Interval value(std::size_t k, const Interval& last_side, Scratch& scratch) const;
  Derivatives derivatives(std::size_t k, const Interval& last_side, Scratch& scratch) const;

 private:
  /// Those steps of the program that selected outputs depend on, for evaluating these outputs alone.
  struct Subprogram {
    std::vector<std::uint32_t> outputs;  ///< registers that hold these outputs
    std::vector<expression::Program::Step> outer_steps, last_steps;
    std::size_t index = 0;
  };
  struct Constraint {
    std::string name;
    expression::Node node;
    Subprogram value, derivatives;
    std::array<bool, kMaxAxes> depends{};
  };

  void run(const Subprogram& subprogram, const Interval& last_side, Scratch& scratch) const;
  Subprogram extract(std::size_t first_output, std::size_t count);

  expression::Program program_;
  std::vector<std::size_t> axes_;
  /// For each axis, the register of its input; std::nullopt: no constraint depends on the axis.
  std::vector<std::optional<std::uint32_t>> registers_;
  std::vector<Constraint> all_;
  std::shared_ptr<const ForceBalance> balance_;  ///< null if there is none
  std::size_t balanced_ = 0;                     ///< index of the constraint that `balance_` decides
  Scratch initial_;
};

}  // namespace pkm::bounds
