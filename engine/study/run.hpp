// One run of one study: its stages one after the other, checkpoints on the way, and what is worked out at the end. A
// stage always starts from nothing, and recorded evaluations are served before new ones are made.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/ranks.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/checkpoint_clock.hpp"
#include "engine/study/progress.hpp"
#include "engine/study/run_outcome.hpp"
#include "engine/study/study_output.hpp"
#include "engine/study/timed_evaluator.hpp"

namespace pkm {

class Run final : public Monitor {
 public:
  /// @param contents  of the study so far, which the run repeats and goes on with
  /// @param output  null on ranks that write nothing
  Run(const Study& study, StudyContents contents, StudyOutput* output, const RunOptions& options, Progress& progress);

  /// A new study's file precedes its first evaluation.
  void begin();
  /// By one team for all stages. Collective. Throws StorageError, UnwrittenOutcome and ReplayMismatch.
  RunOutcome operator()();

  bool generation(const Generation& generation) override;
  bool goes_on() override;
  void warn(const std::string& sentence) override;

 private:
  void run_stages();
  /// False when the run has to stop.
  bool run_stage(std::size_t index);
  StageInput input_of(std::size_t index);
  void take_best(const EvaluationTable& table, std::int64_t row);

  /// Rank 0 alone: shows the generation, stops the run, writes a checkpoint.
  void decide(const Generation& generation);
  /// What rank 0 has decided becomes everyone's, and everyone has what rank 0 has.
  void agree(const Generation& generation);
  ProgressReport report_of(const Generation& generation);

  /// What the run comes to, on rank 0.
  RunOutcome outcome();
  RunOutcome measures() const;
  void finish();
  /// By a signal or the time limit. On any thread.
  bool is_asked_to_stop() const;
  /// So long ago that evaluations under way are left: they are made again when the run is resumed.
  bool is_overdue();
  void write(StudyState state);
  /// Out of memory: the generations that are complete become a checkpoint, in the memory that the run gives back.
  [[noreturn]] void keep_what_is_whole();

  double seconds() const { return steady_seconds() - start_; }

  const Study& study_;
  StudyOutput* output_;
  RunOptions options_;
  Progress& progress_;
  CheckpointClock clock_;
  TimedEvaluator evaluator_;
  StudyContents contents_;
  std::vector<StageRecord> recorded_;
  double earlier_seconds_;
  double start_ = steady_seconds();
  std::size_t stage_ = 0;
  std::int64_t limit_ = 0;                          ///< evaluations of the stage at work, at most
  std::int64_t made_ = 0;                           ///< evaluations up to the last generation
  std::function<std::vector<StartAhead>()> ahead_;  ///< of the stage at work
  bool replaying_;                                  ///< nothing that the file does not hold is there yet
  std::optional<std::size_t> whole_rows_;  ///< of the stage at work, up to its last generation; none while it is taken
  std::string stopped_;
  std::exception_ptr failure_;                                           ///< of rank 0, which ends the run on all
  bool failed_ = false;                                                  ///< rank 0 has one
  std::atomic<double> asked_ = std::numeric_limits<double>::infinity();  ///< when a signal was first seen [s]
  std::optional<TimeLeft> left_;                                         ///< on rank 0
  int threads_ = 0;                                                      ///< of all ranks
  double exchanged_ = ranks::seconds_in_exchange();
  std::vector<std::string> warnings_;
};

}  // namespace pkm
