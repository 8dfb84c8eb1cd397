// A monitor that lets an optimiser run.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm::benchmarks {

class Silent final : public Monitor {
 public:
  bool generation(const Generation&) override { return true; }
  void warn(const std::string&) override {}
};

}  // namespace pkm::benchmarks
