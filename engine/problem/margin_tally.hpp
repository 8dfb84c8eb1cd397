// How many of several things (designs, poses) keep each of their margins, and which margins none keeps together.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/problem/verdict.hpp"

namespace pkm {

class MarginTally {
 public:
  /// A thing's margins by name; NaN: not known.
  void add(const std::vector<std::pair<std::string, double>>& margins);

  std::size_t things() const { return things_; }
  /// Margins that nothing keeps; else pairs that nothing keeps together; else how often each is broken, the most broken
  /// first. A few at most.
  /// @param kind   of the reasons
  /// @param thing  "design", "pose of the least bad design"
  std::vector<Reason> reasons(const std::string& kind, const std::string& thing) const;

 private:
  struct Line {
    std::string name;
    std::size_t known = 0, kept = 0;
    double nearest = 0;                        ///< the greatest of the broken ones
    std::vector<std::size_t> known_with = {};  ///< of each earlier margin: how often both are known
    std::vector<std::size_t> kept_with = {};   ///< and kept
  };
  std::size_t number_of(const std::string& name);

  std::size_t things_ = 0;
  std::vector<Line> lines_;
};

}  // namespace pkm
