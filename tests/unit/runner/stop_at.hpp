// Interrupts a run (SIGINT) after a given number of generations.
#pragma once

#include <csignal>

#include "engine/runner/progress.hpp"

namespace pkm::testing {

/// Raises SIGINT at the n-th progress report (0-based), i.e. after the n-th generation of the run.
class StopAt final : public Progress {
 public:
  explicit StopAt(int n) : left_(n) {}
  void generation(const ProgressReport&) override {
    if (left_-- == 0) std::raise(SIGINT);
  }

 private:
  int left_;
};

}  // namespace pkm::testing
