// The mechanisms of the papers: as the catalogue has them, with accelerators, and by the generic engine alone.
#pragma once

#include <gtest/gtest.h>

#include "tests/unit/contracts/catalogue_problem.hpp"

namespace pkm::test {

inline const auto kPapers = ::testing::Values("4ppa-2par", "3crr-r-cru", "quadrupteron", "2t1r-p-hybrid");

class PaperPair : public ::testing::TestWithParam<std::string> {
 protected:
  const Mechanism& accelerated() const {
    return **std::ranges::find(all_mechanisms(), GetParam(), &MechanismEntry::name);
  }
  const Mechanism& generic() const { return *test::described(GetParam()); }
};

}  // namespace pkm::test
