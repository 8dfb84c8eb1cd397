#include "engine/storage/checkpoint_clock.hpp"

#include <algorithm>
#include <chrono>

namespace pkm {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CheckpointClock::CheckpointClock(std::optional<double> every, std::function<double()> now)
    : every_(every), now_(now ? std::move(now) : steady_seconds), start_(now_()), last_(start_) {}

void CheckpointClock::first(const std::function<void()>& write) {
  checkpoint(write);
  start_ = last_;
  spent_ = 0;
}

bool CheckpointClock::due() const {
  const double now = now_();
  if (every_) return now - last_ >= *every_;
  return now >= std::max(last_ + cost_ / kShare, start_ + (spent_ + cost_) / kShare);
}

void CheckpointClock::checkpoint(const std::function<void()>& write) {
  const double begin = now_();
  write();
  last_ = now_();
  cost_ = last_ - begin;
  spent_ += cost_;
}

double CheckpointClock::share() const {
  const double elapsed = now_() - start_;
  return elapsed > 0 ? spent_ / elapsed : 0;
}

}  // namespace pkm
