// Satisfaction counts of margins over a set of samples (designs or poses): how many samples satisfy each margin, and
// each pair of margins. They show which requirements exclude each other.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/problem/diagnosis.hpp"

namespace pkm {

class MarginTally {
 public:
  /// Adds one sample, given by the names and values of its margins. A NaN margin is unknown and not counted.
  void add(const std::vector<std::pair<std::string, double>>& margins);

  std::size_t samples() const { return samples_; }
  /// At most four reasons: the margins that no sample satisfies; if there are none, the pairs that no sample satisfies
  /// together; otherwise how often each margin is violated, most frequent first.
  /// @param kind    Reason::kind of the reasons
  /// @param sample  phrase for one sample, beginning with its noun: "design", "pose sampled for the best-ranked design"
  std::vector<Reason> reasons(const std::string& kind, const std::string& sample) const;

 private:
  struct Count {
    std::string name;
    std::size_t known = 0, satisfied = 0;
    double closest = 0;  ///< maximum of the negative values of the margin, i.e. the smallest violation
    /// For each margin with a lower index in `counts_`, the number of samples in which both margins are known.
    std::vector<std::size_t> known_with = {};
    /// For each margin with a lower index in `counts_`, the number of samples that satisfy both margins.
    std::vector<std::size_t> satisfied_with = {};
  };
  /// Index of a margin in `counts_`; added if it is new.
  std::size_t index_of(const std::string& name);

  std::size_t samples_ = 0;
  std::vector<Count> counts_;
};

}  // namespace pkm
