// Ctrl-C at a certain point of a run.
#pragma once

#include <csignal>

#include "engine/study/progress.hpp"

namespace pkm::testing {

/// Raises SIGINT in generation n.
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
