// Schedules the checkpoints of a running study.
//
// Unless a fixed period is given, the interval adapts to the time that writing takes, so that checkpoints cost 2 % of
// the run time. Let c be the duration of the last checkpoint and s the total duration of all checkpoints so far. The
// next checkpoint is due at
//
//     max(end of the last + c / 0.02, start + (s + c) / 0.02).
//
// The second term compensates for checkpoints that took longer than predicted, because the file grows.
#pragma once

#include <functional>
#include <optional>

namespace pkm {

/// Time of the system's steady clock [s]; its origin is arbitrary.
double steady_seconds();

class CheckpointClock {
 public:
  static constexpr double kMaxShare = 0.02;  ///< maximum share of the run time spent on checkpoints

  /// @param every  fixed time between checkpoints [s], >= 0; std::nullopt: adapted to the duration of checkpoints
  /// @param now    clock to use; default: steady_seconds()
  explicit CheckpointClock(std::optional<double> every = {}, std::function<double()> now = {});

  /// Performs the first write of the study. Its duration is the first estimate of the duration of a checkpoint, but is
  /// not part of the total duration of all checkpoints.
  void first(const std::function<void()>& write);
  /// @return true if it is time for the next checkpoint
  bool due() const;
  /// Writes a checkpoint and measures its duration. Exceptions of `write` are passed on.
  void checkpoint(const std::function<void()>& write);

  /// Share of the time since the first write that was spent on checkpoints; 0 before the first write.
  double share() const;

 private:
  std::optional<double> every_;
  std::function<double()> now_;
  double start_ = 0;          ///< time at the end of the first write [s]
  double last_end_ = 0;       ///< time at the end of the last write [s]
  double last_duration_ = 0;  ///< duration c of the last write [s]
  double total_ = 0;          ///< total duration s of all checkpoints [s]
};

}  // namespace pkm
