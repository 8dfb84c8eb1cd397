// A monitor that prints nothing and never stops the optimiser.
#pragma once

#include "engine/optimisers/optimiser.hpp"

namespace pkm::benchmarks {

class SilentMonitor final : public Monitor {
 public:
  bool generation(const Generation&) override { return true; }
  void warn(const std::string&) override {}
};

}  // namespace pkm::benchmarks
