// Conditions f >= 0 of coordinates over boxes of them: what certainly holds, what certainly fails, and how
// steep they are.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "engine/graph/program.hpp"
#include "engine/model/pose.hpp"

namespace pkm::bounds {

inline constexpr std::size_t kMostAxes = kMostCoordinates;

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
  graph::Node node;
};

/// Immutable, shared by threads.
class Conditions {
 public:
  /// Registers of all programs; for one worker.
  using Room = std::vector<Interval>;

  /// @param axes    positions of the inputs that the axes are
  /// @param inputs  of the graph: those that are no axes stay
  Conditions(graph::Graph graph, const std::vector<NamedCondition>& conditions, std::vector<std::size_t> axes,
             std::vector<Interval> inputs);

  std::size_t size() const { return all_.size(); }
  std::size_t axes() const { return axes_.size(); }
  const std::string& name(std::size_t k) const { return all_[k].name; }
  graph::Node node(std::size_t k) const { return all_[k].node; }  ///< of the graph that was given
  bool depends(std::size_t k, std::size_t axis) const { return all_[k].depends[axis]; }
  Room room() const { return start_; }

  Interval value(std::size_t k, const Place& place, Room& room) const;
  Slope slope(std::size_t k, const Place& place, Room& room) const;

 private:
  struct Part {
    graph::Program program;
    std::size_t first = 0;  ///< of its registers
  };
  struct Condition {
    std::string name;
    graph::Node node;
    Part value, slope;
    std::array<bool, kMostAxes> depends{};
  };

  std::span<Interval> run(const Part& part, const Place& place, Room& room) const;
  Part part_of(const graph::Graph& graph, const std::vector<graph::Node>& outputs, const std::vector<Interval>& inputs);

  std::vector<std::size_t> axes_;
  std::vector<Condition> all_;
  Room start_;
};

}  // namespace pkm::bounds
