// Cooperative cancellation. Long computations call check_stop(), which throws Stopped as soon as an enclosing StopScope
// requests it.
//
// Scopes are nested and belong to the thread that opens them. The threads of a team inherit the scope of the thread
// whose work they execute (engine/core/team.hpp). There is no global state, so several computations in one process can
// be stopped independently.
#pragma once

#include <atomic>
#include <functional>
#include <limits>

namespace pkm {

/// Thrown by check_stop(). Not derived from std::exception, so that error handlers do not catch it.
struct Stopped {};

/// While an instance exists, check_stop() in this thread throws as soon as the condition of the instance is true or its
/// time limit is exceeded.
class StopScope {
 public:
  /// @param is_requested  returns true to stop; called frequently, by any thread of the team, possibly concurrently
  /// @param seconds       time limit from now [s]
  explicit StopScope(std::function<bool()> is_requested, double seconds = std::numeric_limits<double>::infinity());
  /// Opens a scope that has a time limit only [s].
  explicit StopScope(double seconds) : StopScope({}, seconds) {}
  ~StopScope() { current_ = outer_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

  /// Returns true if this scope or an enclosing one requests a stop.
  bool is_requested() const;
  /// Returns true if an enclosing scope requests a stop, so that the limits of this scope are not the cause.
  bool is_requested_by_outer_scope() const { return outer_ && outer_->is_requested(); }

  /// The innermost scope of this thread; null if this thread has none.
  static const StopScope* current() { return current_; }

  /// While an instance exists, check_stop() in this thread tests a scope that another thread has opened.
  class InheritedScope {
   public:
    explicit InheritedScope(const StopScope* scope) : previous_(current_) { current_ = scope; }
    ~InheritedScope() { current_ = previous_; }
    InheritedScope(const InheritedScope&) = delete;
    InheritedScope& operator=(const InheritedScope&) = delete;

   private:
    const StopScope* previous_;
  };

 private:
  static constinit inline thread_local const StopScope* current_ = nullptr;

  const StopScope* outer_;
  std::function<bool()> is_requested_;
  double deadline_;  ///< time on the monotonic clock at which the limit is exceeded [s]
};

/// While an instance exists: calls `notify` once if the computation of this thread, which must call check_stop(), takes
/// longer than a given time.
class SlowStepNotice {
 public:
  /// @param notify  may be called by any thread of the team
  /// @param after   time until the notification [s]
  explicit SlowStepNotice(std::function<void()> notify, double after = 1);

 private:
  std::function<void()> notify_;
  std::atomic<bool> done_ = false;  ///< true after `notify` has been called
  double deadline_;                 ///< time on the monotonic clock at which `notify` is due [s]
  StopScope scope_;
};

/// Returns true if a scope of this thread requests a stop.
inline bool stop_requested() { return StopScope::current() && StopScope::current()->is_requested(); }

/// Throws Stopped if a scope of this thread requests a stop. Takes 10 to 20 ns within a scope and 1 ns otherwise; to be
/// called in every loop that may take longer than a few milliseconds.
inline void check_stop() {
  if (stop_requested()) throw Stopped();
}

}  // namespace pkm
