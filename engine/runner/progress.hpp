// Progress display of a running study.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace pkm {

/// The state of a run after a generation.
struct ProgressReport {
  std::size_t stage = 0, stages = 1;
  std::string optimiser;
  std::int64_t generation = 0;
  std::int64_t evaluations = 0;       ///< evaluations of the stage so far
  std::int64_t evaluation_limit = 0;  ///< limit of the stage; 0: none
  double evaluations_per_second = 0;  ///< average of this run
  std::optional<double> left = {};    ///< estimated maximum remaining time [s], if known
  double seconds = 0;                 ///< wall time of this run
  bool has_best = false;              ///< the best design so far is feasible
  double best = 0;                    ///< its (first) objective
  std::string objective;              ///< name of the (first) objective; "": none
  std::size_t front = 0;              ///< several objectives: size of the front, shown instead of `best`
  double hypervolume = 0;             ///< NaN: not computed
  double violation = 0;               ///< smallest constraint violation of any design, while none is feasible
  double feasible_share = 0;          ///< share of the population, in [0, 1]
};

/// Interface of progress displays; the default implementation displays nothing.
class Progress {
 public:
  virtual ~Progress() = default;
  /// Called after each generation.
  virtual void generation(const ProgressReport&) {}
  /// Called after the last generation, if a final step has taken a second. May be called on any thread.
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
  double last_ = -1;   ///< ProgressReport::seconds of the last report shown
  bool open_ = false;  ///< the terminal shows a line without line break
};

/// @return the report as one line of text
std::string progress_line(const ProgressReport& report);

/// @return a progress bar and the report, in at most `width` columns: the least important items are omitted first
std::string progress_bar_line(const ProgressReport& report, std::size_t width);

/// "1 h 02 min", "3 min 20 s", "12.3 s", "45 ms", "4.5 us".
std::string duration_text(double seconds);

}  // namespace pkm
