#include "engine/storage/checkpoint_clock.hpp"

#include <algorithm>
#include <chrono>

namespace pkm {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CheckpointClock::CheckpointClock(std::optional<double> every, std::function<double()> now)
    : every_(every), now_(now ? std::move(now) : steady_seconds), start_(now_()), last_end_(start_) {}

void CheckpointClock::first(const std::function<void()>& write) {
  checkpoint(write);
  start_ = last_end_;
  total_ = 0;
}

bool CheckpointClock::due() const {
  const double now = now_();
  if (every_) return now - last_end_ >= *every_;
  return now >= std::max(last_end_ + last_duration_ / kMaxShare, start_ + (total_ + last_duration_) / kMaxShare);
}

void CheckpointClock::checkpoint(const std::function<void()>& write) {
  const double begin = now_();
  write();
  last_end_ = now_();
  last_duration_ = last_end_ - begin;
  total_ += last_duration_;
}

double CheckpointClock::share() const {
  const double elapsed = now_() - start_;
  return elapsed > 0 ? total_ / elapsed : 0;
}

}  // namespace pkm
