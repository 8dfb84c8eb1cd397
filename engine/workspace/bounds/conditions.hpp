// Conditions f >= 0 of coordinates over boxes of them: what certainly holds, what certainly fails, and how
// steep they are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/expression/program.hpp"
#include "engine/geometry/pose.hpp"

namespace pkm::bounds {

inline constexpr std::size_t kMostAxes = kMaxCoordinates;

/// By axis; what has fewer axes leaves the others alone.
using Place = std::array<Interval, kMostAxes>;

/// Values of a condition over a box, and its derivatives by the axes.
struct Slope {
  Interval value;
  std::array<Interval, kMostAxes> by;
  bool is_known = false;        ///< the condition is continuous there, and the derivatives hold all of its slopes
  bool is_known_along = false;  ///< the same of the last axis alone
};

struct NamedCondition {
  std::string name;
  expression::Node node;
};

/// Immutable, shared by threads.
class Conditions {
 public:
  /// Registers of one worker, who looks at one box of the axes but the last at a time: what depends on these alone is
  /// computed once for all ranges of the last axis, and what conditions share once for all of them.
  class Room {
    friend Conditions;
    std::vector<Interval> registers_;
    std::vector<std::uint64_t> since_;     ///< by register: when it was computed
    std::vector<std::uint64_t> computed_;  ///< by part: since when its outer steps are
    std::uint64_t now_ = 0, box_ = 0, along_since_ = 0;
    Interval along_;
  };

  /// @param axes    positions of the inputs that the axes are
  /// @param inputs  of the graph: those that are no axes stay
  Conditions(expression::Graph graph, const std::vector<NamedCondition>& conditions, std::vector<std::size_t> axes,
             std::vector<Interval> inputs);

  std::size_t size() const { return all_.size(); }
  std::size_t axes() const { return axes_.size(); }
  const std::string& name(std::size_t k) const { return all_[k].name; }
  expression::Node node(std::size_t k) const { return all_[k].node; }  ///< of the graph that was given
  bool depends(std::size_t k, std::size_t axis) const { return all_[k].depends[axis]; }
  Room room() const { return start_; }

  /// Goes to another box. @param place  the last axis is not looked at
  void enter(const Place& place, Room& room) const;
  /// Over the box that was entered last. @param along  the last axis
  Interval value(std::size_t k, const Interval& along, Room& room) const;
  Slope slope(std::size_t k, const Interval& along, Room& room) const;

 private:
  /// Some outputs of the program: the steps that lead to them.
  struct Part {
    std::vector<std::uint32_t> outputs;
    std::vector<expression::Program::Step> outer, last;
    std::size_t number = 0;
  };
  struct Condition {
    std::string name;
    expression::Node node;
    Part value, slope;
    std::array<bool, kMostAxes> depends{};
  };

  void run(const Part& part, const Interval& along, Room& room) const;
  Part part_of(const expression::Program& program, std::size_t first_output, std::size_t count);

  std::vector<std::size_t> axes_;
  std::vector<std::optional<std::uint32_t>> registers_;  ///< of the axes, as far as a condition uses them
  std::vector<Condition> all_;
  Room start_;
};

}  // namespace pkm::bounds
