// Cooperative cancellation: long computations call check_stop(), which throws Stopped once a scope around them asks for
// it.
//
// Scopes are nested and belong to the thread that opens them; a team's threads work under the scope of the thread whose
// work they share (engine/core/team.hpp). There is no other state, so several computations of one process can be
// stopped separately.
#pragma once

#include <atomic>
#include <functional>
#include <limits>

namespace pkm {

/// Thrown by check_stop(). Not a std::exception: a handler of errors must not take a stop for one.
struct Stopped {};

class StopScope {
 public:
  /// @param is_requested  whether to stop; called often, by any thread of the team, also by several at once
  /// @param seconds       from now on, after which to stop in any case
  explicit StopScope(std::function<bool()> is_requested, double seconds = std::numeric_limits<double>::infinity());
  /// A time limit alone.
  explicit StopScope(double seconds) : StopScope({}, seconds) {}
  ~StopScope() { current_ = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// Whether this scope asks to stop, or one around it.
  bool is_requested() const;
  /// Whether one around it does: what this one limits is then not at fault.
  bool is_requested_outside() const { return outer_ && outer_->is_requested(); }

  /// The innermost scope of this thread; null: none.
  static const StopScope* current() { return current_; }

  /// While it lives, this thread works under a scope of another thread.
  class Adopted {
   public:
    explicit Adopted(const StopScope* scope) : before_(current_) { current_ = scope; }
    ~Adopted() { current_ = before_; }
    Adopted(const Adopted&) = delete;
    Adopted& operator=(const Adopted&) = delete;

   private:
    const StopScope* before_;
  };

 private:
  static constinit inline thread_local const StopScope* current_ = nullptr;

  const StopScope* outer_;
  std::function<bool()> is_requested_;
  double end_;  ///< s, of the clock
};

/// While it lives: calls `say` once, if what this thread computes takes long and calls check_stop().
class SlowStep {
 public:
  /// @param say    may be called by any thread of the team
  /// @param after  [s]
  explicit SlowStep(std::function<void()> say, double after = 1);

 private:
  std::function<void()> say_;
  std::atomic<bool> said_ = false;
  double slow_;  ///< s, of the clock: when it has taken long
  StopScope scope_;
};

/// Whether a scope of this thread asks to stop.
inline bool stop_requested() { return StopScope::current() && StopScope::current()->is_requested(); }

/// Throws Stopped if a scope of this thread asks to stop. Takes 10 to 20 ns within a scope, else 1 ns: it belongs into
/// every loop that may take longer than some milliseconds.
inline void check_stop() {
  if (stop_requested()) throw Stopped();
}

}  // namespace pkm
