// What a running study tells while it runs.
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
  std::int64_t evaluations = 0;       ///< of the stage
  std::int64_t evaluation_limit = 0;  ///< of the stage
  double evaluations_per_second = 0;  ///< of this run
  std::optional<double> left = {};    ///< s: what the run will still take, at most
  double seconds = 0;                 ///< of this run
  bool has_best = false;              ///< the best design so far is feasible
  double best = 0;                    ///< its (first) objective
  std::string objective;
  std::size_t front = 0;   ///< several objectives: designs on the front, shown instead of the best
  double hypervolume = 0;  ///< NaN: not worked out
  double violation = 0;    ///< of the least infeasible design, while none is feasible
  double feasible_share = 0;
};

class Progress {
 public:
  virtual ~Progress() = default;
  virtual void generation(const ProgressReport&) {}
  /// After the last generation: a step that has taken a second. On any thread.
  virtual void step(const std::string& /*what*/) {}
  /// The line is about to be used by something else.
  virtual void finish() {}
};

/// On a terminal one line with a bar, redrawn at most ten times a second; elsewhere a line every ten seconds.
class ScreenProgress final : public Progress {
 public:
  explicit ScreenProgress(std::FILE* out);
  /// Leaves the line, so that what follows (an error, say) has a line of its own.
  ~ScreenProgress() override;
  ScreenProgress(const ScreenProgress&) = delete;
  ScreenProgress& operator=(const ScreenProgress&) = delete;
  void generation(const ProgressReport& report) override;
  void step(const std::string& what) override;
  void finish() override;

 private:
  std::FILE* out_;
  bool terminal_;
  double last_ = -1;   ///< seconds of the report shown last
  bool open_ = false;  ///< a line without its end stands on the terminal
};

/// The report in one line.
std::string progress_line(const ProgressReport& report);

/// The report with a bar, in at most `width` columns: what matters least is left out first.
std::string progress_bar_line(const ProgressReport& report, std::size_t width);

/// "1 h 02 min", "3 min 20 s", "12.3 s", "45 ms", "4.5 us".
std::string duration_text(double seconds);

}  // namespace pkm
