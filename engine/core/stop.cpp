#include "engine/core/stop.hpp"

#include <ctime>
#include <utility>

namespace pkm {
namespace {

/// To some milliseconds, which takes a quarter of the time of an exact reading.
double coarse_seconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

StopScope::StopScope(std::function<bool()> is_requested, double seconds)
    : outer_(current_), is_requested_(std::move(is_requested)), end_(coarse_seconds() + seconds) {
  current_ = this;
}

SlowStep::SlowStep(std::function<void()> say, double after)
    : say_(std::move(say)), slow_(coarse_seconds() + after), scope_([this] {
        if (coarse_seconds() > slow_ && !said_.load(std::memory_order_relaxed) && !said_.exchange(true)) say_();
        return false;
      }) {}

bool StopScope::is_requested() const {
  return (is_requested_ && is_requested_()) || coarse_seconds() >= end_ || is_requested_outside();
}

}  // namespace pkm
