// Progress display of a running study.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace pkm {

/// The state of a run after a generation, which a progress display shows.
struct ProgressReport {
  std::size_t stage = 0, stages = 1;
  std::string optimiser;
  std::int64_t generation = 0;
  std::int64_t evaluations = 0;       ///< number of evaluations of the current stage so far
  std::int64_t evaluation_limit = 0;  ///< maximum number of evaluations of the current stage; 0: unlimited
  double evaluations_per_second = 0;  ///< average over this run
  std::optional<double> left = {};    ///< estimate of the maximum remaining time [s]; std::nullopt: unknown
  double seconds = 0;                 ///< wall time since the start of this run [s]
  bool has_best = false;              ///< true if the best design so far is feasible
  double best = 0;                    ///< value of the first objective of the best design
  std::string objective;              ///< name of the first objective; "": there is none
  /// Number of designs on the front, which is shown instead of `best` if there are several objectives; otherwise 0.
  std::size_t front = 0;
  double hypervolume = 0;     ///< hypervolume of the front; NaN: not computed
  double violation = 0;       ///< smallest constraint violation of all designs so far, as long as none is feasible
  double feasible_share = 0;  ///< share of the population that is feasible, in [0, 1]
};

/// Interface of progress displays; the default implementation displays nothing.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Called after each generation.
  virtual void generation(const ProgressReport&) {}
  /// Called after the last generation, if one step of the computation of final results has taken a second. May be
  /// called on any thread.
  virtual void step(const std::string& /*description*/) {}
  /// Called before other output is printed: removes the current line.
  virtual void finish() {}
};

/// On a terminal, shows one line with a progress bar, redrawn at most ten times per second; otherwise prints a line
/// every ten seconds.
class ScreenProgress final : public Progress {
 public:
  explicit ScreenProgress(std::FILE* out);
  /// Clears the progress line, so that subsequent output (such as an error message) begins on an empty line.
  ~ScreenProgress() override;
  ScreenProgress(const ScreenProgress&) = delete;
  ScreenProgress& operator=(const ScreenProgress&) = delete;
  void generation(const ProgressReport& report) override;
  void step(const std::string& description) override;
  void finish() override;

 private:
  std::FILE* out_;
  bool terminal_;
  double last_ = -1;   ///< ProgressReport::seconds of the report that was shown last; -1: none
  bool open_ = false;  ///< true while the terminal shows a line that has not been ended by a line break
};

/// Text of a report as one line.
std::string progress_line(const ProgressReport& report);

/// Progress bar and report as one line of at most `width` columns, from which the least important items are omitted
/// first.
std::string progress_bar_line(const ProgressReport& report, std::size_t width);

/// Text of a duration: "1 h 02 min", "3 min 20 s", "12.3 s", "45 ms", "4.5 us".
std::string duration_text(double seconds);

}  // namespace pkm
