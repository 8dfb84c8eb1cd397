// The mechanisms of the papers, built in and as files.
#pragma once

#include <gtest/gtest.h>

#include "tests/unit/contracts/everything.hpp"

namespace pkm::test {

inline const auto kPapers = ::testing::Values("4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid");

class PaperPair : public ::testing::TestWithParam<std::string> {
 protected:
  const Mechanism& own() const {
    return **std::ranges::find_if(all_mechanisms(), [](const auto& m) { return m->info().name == GetParam(); });
  }
  const Mechanism& file() const { return *test::described(GetParam()); }

  /// The file's signs as the built-in mechanism calls the mode.
  static std::string own_mode(const std::string& signs) {
    if (GetParam() == "4ppa-2par") {
      const auto word = [](char sign) { return std::string(sign == '+' ? "lower" : "upper"); };
      return word(signs[0]) + "," + word(signs[2]);
    }
    if (GetParam() == "2t1r-p-hybrid") return signs.substr(0, 5) + (signs[6] == '+' ? "" : "/-");
    return signs;
  }
  std::vector<double> of_file(const std::vector<double>& design) const {
    std::vector<double> same;
    for (const Parameter& p : file().info().parameters)
      same.push_back(design[static_cast<std::size_t>(find_named(own().info().parameters, p.name) -
                                                     own().info().parameters.data())]);
    return same;
  }
  LimitSpec of_file(const LimitSpec& limits) const {
    LimitSpec same = no_limits(file().info());
    for (std::size_t i = 0; i < own().info().limits.size(); ++i) {
      const LimitInfo* const limit = find_named(file().info().limits, own().info().limits[i].name);
      if (!limit) continue;
      const auto at = static_cast<std::size_t>(limit - file().info().limits.data());
      same.given[at] = limits.given[i];
      same.derived[at] = limits.derived[i];
    }
    return same;
  }
  LimitSpec without_clearance(LimitSpec limits) const {
    for (std::size_t i = 0; i < limits.given.size(); ++i)
      if (own().info().limits[i].group == "clearance") limits.given[i] = kNoClearance;
    return limits;
  }
};

}  // namespace pkm::test
