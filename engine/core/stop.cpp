#include "engine/core/stop.hpp"

#include <ctime>
#include <utility>

namespace pkm {
namespace {

/// Monotonic time in s with a resolution of a few milliseconds. Reading it is four times as fast as CLOCK_MONOTONIC.
double coarse_seconds() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

StopScope::StopScope(std::function<bool()> is_requested, double seconds)
    : outer_(current_), is_requested_(std::move(is_requested)), deadline_(coarse_seconds() + seconds) {
  current_ = this;
}

SlowStepNotice::SlowStepNotice(std::function<void()> notify, double after)
    : notify_(std::move(notify)), deadline_(coarse_seconds() + after), scope_([this] {
        if (coarse_seconds() > deadline_ && !done_.load(std::memory_order_relaxed) && !done_.exchange(true)) notify_();
        return false;
      }) {}

bool StopScope::is_requested() const {
  return (is_requested_ && is_requested_()) || coarse_seconds() >= deadline_ || is_requested_by_outer_scope();
}

}  // namespace pkm
