#include "engine/core/team.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace pkm {
namespace {

constexpr std::uint64_t kNoPiece = 0xffffffff;  // in the lower half of next_: none can be taken
constexpr auto kSpin = std::chrono::microseconds(100);

thread_local Team* lent = nullptr;

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Waits until the value is another one: awake for a moment, then asleep.
void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  constexpr int kLooks = 64;  // between two looks at the clock
  const auto end = std::chrono::steady_clock::now() + kSpin;
  do {
    for (int i = 0; i < kLooks; ++i) {
      if (value.load(std::memory_order_acquire) != old) return;
      pause();
    }
  } while (std::chrono::steady_clock::now() < end);
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

int team_size(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Team::Team(int threads) : next_(kNoPiece) {
  for (int i = 1; i < team_size(threads); ++i) helpers_.emplace_back([this, i] { help(static_cast<std::size_t>(i)); });
}

Team::~Team() {
  ends_.store(true, std::memory_order_relaxed);
  jobs_.fetch_add(1, std::memory_order_release);
  jobs_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Team::share(std::size_t pieces, WorkRef work) {
  if (pieces == 0) return;
  const std::uint64_t job = (next_.load(std::memory_order_relaxed) >> 32) + 1;
  object_.store(work.object_, std::memory_order_release);
  call_.store(work.call_, std::memory_order_release);
  pieces_.store(static_cast<std::uint32_t>(pieces), std::memory_order_release);
  done_.store(0, std::memory_order_release);
  next_.store(job << 32, std::memory_order_release);
  if (!helpers_.empty()) {
    jobs_.fetch_add(1, std::memory_order_release);
    jobs_.notify_all();
  }
  Team* const mine = lent;
  lent = nullptr;
  take_pieces(0);
  lent = mine;
  for (std::uint32_t done = done_.load(std::memory_order_acquire); done != pieces;
       done = done_.load(std::memory_order_acquire))
    await_change(done_, done);
  next_.store((job << 32) | kNoPiece, std::memory_order_relaxed);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// Works on pieces until none is left.
void Team::take_pieces(std::size_t worker) {
  for (std::uint64_t next = next_.load(std::memory_order_acquire);;) {
    const WorkRef work(object_.load(std::memory_order_acquire), call_.load(std::memory_order_acquire));
    const std::uint32_t pieces = pieces_.load(std::memory_order_acquire);
    const auto begin = static_cast<std::uint32_t>(next);
    if (begin == kNoPiece || begin >= pieces) return;
    const std::uint32_t count = std::max(1u, (pieces - begin) / (2 * static_cast<std::uint32_t>(threads())));
    if (!next_.compare_exchange_weak(next, next + count, std::memory_order_acquire, std::memory_order_acquire))
      continue;
    try {
      work(begin, begin + count, worker);
    } catch (...) {
      const std::lock_guard lock(failing_);
      if (!failure_) failure_ = std::current_exception();
    }
    if (done_.fetch_add(count, std::memory_order_release) + count == pieces) done_.notify_one();
    next = next_.load(std::memory_order_acquire);
  }
}

void Team::help(std::size_t worker) {
  for (std::uint32_t seen = 0;;) {
    await_change(jobs_, seen);
    seen = jobs_.load(std::memory_order_acquire);
    if (ends_.load(std::memory_order_relaxed)) return;
    take_pieces(worker);
  }
}

LentTeam::LentTeam(Team& team) : before_(lent) { lent = &team; }
LentTeam::~LentTeam() { lent = before_; }

bool has_team() { return lent && lent->threads() > 1; }

std::size_t workers() { return lent ? static_cast<std::size_t>(lent->threads()) : 1; }

void share_pieces(std::size_t pieces, WorkRef work) {
  if (lent)
    lent->share(pieces, work);
  else if (pieces > 0)
    work(0, pieces, 0);
}

}  // namespace pkm
