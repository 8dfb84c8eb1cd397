// Decides when a running study writes its next checkpoint.
//
// Without a fixed period, checkpoints may cost 2 % of the run time, whatever they cost today: with c the last one's
// cost and s the sum of all so far, the next is due at
//
//     max(end of the last + c / 0.02, start + (s + c) / 0.02).
//
// The second term makes up for checkpoints that came out dearer than foreseen, because the file grows.
#pragma once

#include <functional>
#include <optional>

namespace pkm {

/// [s] from any origin, by the system's steady clock.
double steady_seconds();

class CheckpointClock {
 public:
  static constexpr double kShare = 0.02;  ///< of the run time

  /// @param every  fixed period [s] instead, >= 0
  /// @param now    as steady_seconds(), the default
  explicit CheckpointClock(std::optional<double> every = {}, std::function<double()> now = {});

  /// The study's first write: its cost is the first estimate, but it does not count.
  void first(const std::function<void()>& write);
  bool due() const;
  /// Writes a checkpoint and counts its cost. What `write` throws passes through.
  void checkpoint(const std::function<void()>& write);

  /// Counted cost over the time since the first write; 0 before.
  double share() const;

 private:
  std::optional<double> every_;
  std::function<double()> now_;
  double start_ = 0;  ///< end of the first write
  double last_ = 0;   ///< end of the last write
  double cost_ = 0;   ///< of the last write
  double spent_ = 0;  ///< by counted writes
};

}  // namespace pkm
