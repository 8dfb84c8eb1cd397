#include "engine/study/run_study.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <new>

#include "engine/core/instruction_set.hpp"
#include "engine/core/ranks.hpp"
#include "engine/problem/order.hpp"
#include "engine/problem/replay.hpp"
#include "engine/problem/row_exchange.hpp"
#include "engine/storage/checkpoint_clock.hpp"
#include "engine/study/machine.hpp"
#include "engine/study/records.hpp"
#include "engine/study/starts.hpp"

namespace pkm {
namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Mean over the variables of the population's standard deviation, in units of the variable's range.
double diversity(const DesignSpace& space, const EvaluationTable& table, const std::vector<std::int64_t>& population) {
  if (population.empty() || space.dimension() == 0) return 0;
  const std::size_t members = population.size(), dimension = space.dimension();
  const auto n = static_cast<double>(members);
  std::vector<double> units(members * dimension);  // a copy side by side: the table's rows lie far apart
  const auto gather = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto design = table.design(static_cast<std::size_t>(population[i]));
      for (std::size_t v = 0; v < dimension; ++v) units[v * members + i] = space.to_unit(v, design[v]);
    }
  };
  constexpr std::size_t kWorthSharing = 10'000;
  if (members < kWorthSharing)
    gather(0, members);
  else
    share_pieces(members, gather);
  double sum = 0;
  for (std::size_t v = 0; v < dimension; ++v) {
    const std::span unit = std::span(units).subspan(v * members, members);
    double mean = 0, square = 0;
    for (const double u : unit) mean += u / n;
    for (const double u : unit) square += (u - mean) * (u - mean) / n;
    sum += std::sqrt(square);
  }
  return sum / static_cast<double>(dimension);
}

double feasible_share(const EvaluationTable& table, const std::vector<std::int64_t>& population) {
  if (population.empty()) return 0;
  std::size_t feasible = 0;
  for (const auto row : population) feasible += table.status[static_cast<std::size_t>(row)] == Status::feasible;
  return static_cast<double>(feasible) / static_cast<double>(population.size());
}

/// Whether certain bounds of a design were left before they came to their gap.
bool is_cut_short(const FinalRecord& final) {
  const auto cut = [](const std::optional<DesignRecord>& design) {
    return design && design->certain && design->certain->stopped;
  };
  return cut(final.best) || cut(final.rounded) || cut(final.baseline);
}

/// One run of one study into one file.
class Run final : public Monitor {
 public:
  /// @param existing  what becomes of a file that is there at the first write
  /// @param lock  null on ranks that write nothing
  Run(const Study& study, StudyContents contents, std::string path, const StudyLock* lock, Existing existing,
      const RunOptions& options, Progress& progress)
      : study_(study),
        path_(std::move(path)),
        lock_(lock),
        existing_(existing),
        options_(options),
        progress_(progress),
        clock_(study.checkpoint_every),
        evaluator_(options.threads > 0 ? options.threads : ranks::threads()),
        contents_(std::move(contents)),
        recorded_(std::move(contents_.stages)),
        earlier_seconds_(contents_.seconds),
        start_(now()) {
    contents_.stages.clear();
    contents_.best = {};
    contents_.final.reset();
    contents_.program_version = options.program.version;
    contents_.program_revision = options.program.revision;
    contents_.algorithms = kAlgorithms;
  }

  /// A new study's file precedes its first evaluation.
  void begin() {
    clock_.first([&] {
      if (recorded_.empty()) write(StudyState::running);
    });
  }

  /// By one team for all stages. Collective.
  RunOutcome run() {
    const std::vector<std::string> threads = ranks::all_gather(std::to_string(evaluator_.threads()));
    for (const std::string& each : threads) threads_ += std::stoi(each);
    RunOutcome result;
    try {
      with_team(evaluator_.threads(), [&] {
        run_stages();
        if (failure_) std::rethrow_exception(failure_);
        if (ranks::rank() == 0) result = outcome();
      });
    } catch (const std::bad_alloc&) {
      if (ranks::size() == 1) keep_what_is_whole();
      ranks::abandon("out of memory");
    }
    return result;
  }

  bool generation(const Generation& g) override {
    whole_rows_.reset();
    const EvaluationTable& table = *g.table;
    StageRecord& stage = contents_.stages.back();
    const std::size_t index = static_cast<std::size_t>(g.number);
    const StageRecord* record = stage_ < recorded_.size() ? &recorded_[stage_] : nullptr;
    // A generation that an evaluation limit had cut short is reported again, complete.
    GenerationRecords& list = stage.generations;
    if (index < list.size()) truncate(stage, index);
    list.first_row.push_back(static_cast<std::int64_t>(g.first_row));
    if (g.starts && g.starts->size() != stage.starts.size()) stage.starts = *g.starts;
    ahead_ = g.ahead;
    list.best_row.push_back(g.best_row);
    if (g.front) record_front(stage, *g.front);
    list.feasible_share.push_back(feasible_share(table, *g.population));
    list.diversity.push_back(diversity(study_.problem->space(), table, *g.population));
    list.population_first.push_back(static_cast<std::int64_t>(list.population.size()));
    list.population.insert(list.population.end(), g.population->begin(), g.population->end());
    replaying_ = record && evaluator_.made == made_;
    const bool timed = replaying_ && index < record->generations.size();
    list.seconds.push_back(timed ? record->generations.seconds[index] : seconds());
    made_ = evaluator_.made;
    whole_rows_ = table.size();
    // A solver's starts are points of a front: of them only the stage's end says which stands for all.
    if (g.front || study_.problem->objectives().size() < 2) take_best(table, g.best_row);
    if (ranks::rank() == 0) {
      try {
        decide(g);
      } catch (...) {  // told to the others before it is told to the user
        if (ranks::size() == 1 || g.alone) throw;
        failure_ = std::current_exception();
      }
    }
    if (ranks::size() > 1 && !g.alone) agree(g);
    return stopped_.empty() && !failed_;
  }

  bool goes_on() override {
    if (ranks::rank() != 0) return true;
    if (const int signal = StopRequest::signal())
      stopped_ = StopRequest::name(signal);
    else if (options_.time_limit && now() - start_ >= *options_.time_limit)
      stopped_ = "time limit";
    return stopped_.empty();
  }

  void warn(const std::string& sentence) override {
    const std::string note = "stage " + std::to_string(stage_ + 1) + ": " + sentence;
    contents_.notes.push_back(note);
    warnings_.push_back(note);
  }

 private:
  void run_stages() {
    try {
      for (std::size_t i = 0; i < study_.stages.size(); ++i)
        if (!run_stage(i)) break;
    } catch (const ReplayMismatch&) {  // on every rank
      throw;
    } catch (const std::exception& error) {  // the others would wait for this one
      if (ranks::size() > 1) ranks::abandon(message_of(error));
      throw;
    }
  }

  RunOutcome outcome() {
    RunOutcome outcome;
    std::optional<std::string> unwritten;
    outcome.stopped = stopped_;
    outcome.evaluations = evaluator_.made;
    if (ranks::size() > 1) {  // starts of solvers were made elsewhere, too
      outcome.evaluations = contents_.evaluations();
      for (const StageRecord& stage : recorded_) outcome.evaluations -= static_cast<std::int64_t>(stage.table.size());
    }
    outcome.warnings = warnings_;
    outcome.parallel_efficiency = evaluator_.wall > 0 ? evaluator_.busy / (evaluator_.wall * threads_) : 0;
    outcome.exchange_share = ranks::size() > 1 ? (ranks::seconds_in_exchange() - exchanged_) / (now() - start_) : 0;
    outcome.team = team();
    if (!stopped_.empty() && replaying_) {
      contents_ = read_study(path_);  // stopped before it came to anything new: the file holds more than this run
    } else {
      if (ranks::size() > 1 && outcome.evaluations > 0) note_ranks(outcome);
      if (stopped_.empty()) {
        contents_.final = final_record(study_, contents_);
        if (is_cut_short(*contents_.final) && !goes_on()) contents_.final.reset();
        outcome.stopped = stopped_;
      }
      try {
        write(stopped_.empty() ? StudyState::finished : StudyState::interrupted);
      } catch (const StorageError& failure) {
        unwritten = failure.what();
      }
    }
    outcome.contents = std::move(contents_);
    outcome.seconds = now() - start_;
    outcome.checkpoint_share = clock_.share();
    if (unwritten) throw UnwrittenOutcome(*unwritten, std::move(outcome));
    return outcome;
  }

  /// Rank 0 alone.
  void decide(const Generation& g) {
    report(g, contents_.stages.back().optimiser);
    if (goes_on() && !replaying_ && clock_.due()) clock_.checkpoint([&] { write(StudyState::running); });
  }

  /// What rank 0 has decided becomes everyone's, and everyone has what rank 0 has.
  void agree(const Generation& g) {
    constexpr char kDecision = 'd', kFailed = '!';
    const std::uint64_t own = hash_of_rows(*g.table, g.first_row, g.table->size());
    std::string message(1, kDecision);
    message.append(reinterpret_cast<const char*>(&own), sizeof own) += failure_ ? std::string(1, kFailed) : stopped_;
    ranks::broadcast(message);
    std::uint64_t hash = 0;
    if (message.size() > sizeof hash) std::memcpy(&hash, message.data() + 1, sizeof hash);
    if (message.front() != kDecision || hash != own)
      ranks::abandon("what was evaluated in generation " + std::to_string(g.number) + " of stage " +
                     std::to_string(stage_ + 1) + " differs from that of rank 0 on " + ranks::host(0) +
                     ": the same program with the same libraries has to run on every host");
    stopped_ = message.substr(1 + sizeof hash);
    failed_ = stopped_.starts_with(kFailed);
  }

  /// "2 threads", "4 ranks x 16 threads".
  std::string team() const {
    const int ranks = ranks::size(), own = evaluator_.threads();
    const auto words = [](int threads) { return std::to_string(threads) + (threads == 1 ? " thread" : " threads"); };
    if (ranks == 1) return words(own);
    if (ranks * own == threads_) return std::to_string(ranks) + " ranks x " + words(own);
    return std::to_string(ranks) + " ranks with " + words(threads_) + " in all";
  }

  void note_ranks(const RunOutcome& outcome) {
    std::vector<std::string> hosts;
    for (int rank = 0; rank < ranks::size(); ++rank)
      if (std::ranges::find(hosts, ranks::host(rank)) == hosts.end()) hosts.push_back(ranks::host(rank));
    const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
    contents_.notes.push_back(std::to_string(outcome.evaluations) + " evaluations by " + outcome.team + " on " +
                              join(hosts) + ": parallel efficiency " + percent(outcome.parallel_efficiency) + ", " +
                              percent(outcome.exchange_share) + " of the time in messages between ranks");
  }

  /// Adds up what parallel efficiency is made of.
  class TimedEvaluator final : public Evaluator {
   public:
    explicit TimedEvaluator(int threads) : inner_(threads) {}
    void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override {
      count(1);
      inner_.evaluate(problem, table, first);
      count(-1);
      const std::lock_guard guard(mutex_);
      made += static_cast<std::int64_t>(table.size() - first);
      // A single row is each rank's own work.
      const int ranks = table.size() - first == 1 ? ranks::size() : 1;
      for (std::size_t row = first; row < table.size(); ++row) busy += ranks * static_cast<double>(table.seconds[row]);
    }
    int threads() const { return inner_.threads(); }
    /// Gives back what it has reserved for evaluations.
    void forget() { inner_ = ParallelEvaluator(inner_.threads()); }
    double wall = 0, busy = 0;           ///< s; wall: while anything was being evaluated
    std::atomic<std::int64_t> made = 0;  ///< evaluations

   private:
    /// Of the calls at work.
    void count(int more) {
      const std::lock_guard guard(mutex_);
      if (calls_ == 0) begin_ = now();
      calls_ += more;
      if (calls_ == 0) wall += now() - begin_;
    }

    ParallelEvaluator inner_;
    std::mutex mutex_;
    int calls_ = 0;
    double begin_ = 0;
  };

  /// The front as it is now, and its indicators at the end of their series.
  static void record_front(StageRecord& stage, const Front& front) {
    if (!stage.front) stage.front.emplace();
    stage.front->rows = front.rows;
    stage.front->reference = front.reference;
    stage.front->hypervolume.push_back(front.hypervolume);
    stage.front->spread.push_back(front.spread);
    stage.front->igd_plus.push_back(front.igd_plus);
  }

  static void truncate(StageRecord& stage, std::size_t size) {
    GenerationRecords& list = stage.generations;
    if (stage.front)
      for (auto* series : {&stage.front->hypervolume, &stage.front->spread, &stage.front->igd_plus})
        series->resize(size);
    list.population.resize(static_cast<std::size_t>(list.population_first[size]));
    for (auto* column : {&list.first_row, &list.best_row, &list.population_first}) column->resize(size);
    for (auto* column : {&list.feasible_share, &list.diversity, &list.seconds}) column->resize(size);
  }

  double seconds() const { return earlier_seconds_ + (now() - start_); }

  /// False when the run has to stop.
  bool run_stage(std::size_t index) {
    stage_ = index;
    whole_rows_ = 0;
    const Stage& stage = study_.stages[index];
    const bool again = index < recorded_.size();
    StageInput input{.problem = *study_.problem,
                     .evaluator = evaluator_,
                     .monitor = *this,
                     .seed = stage_seed(index),
                     .starts = start_designs(study_, stage, contents_),
                     .known_front = known_front(study_, contents_)};
    if (again) {
      input.recorded = &recorded_[index].table;
      input.recorded_starts = recorded_[index].starts;
      input.recorded_ahead = recorded_[index].ahead;
    }
    contents_.stages.push_back({stage.entry->name, option_lines(stage.options),
                                EvaluationTable(study_.problem->shape(stage.optimiser->detail()))});
    StageRecord& record = contents_.stages.back();
    limit_ = stage.optimiser->evaluation_limit(*study_.problem);
    const StageResult result = stage.optimiser->minimise(input, record.table);
    record.starts = result.starts;
    record.ahead = result.ahead;
    ahead_ = {};
    if (failed_) return false;
    if (result.reason != StopReason::interrupted) take_best(record.table, result.best_row);
    if (result.reason == StopReason::interrupted) return false;
    const bool restarted = !warnings_.empty();  // a start that left its recorded path may have become shorter
    if (again && !restarted && record.table.size() < recorded_[index].table.size())
      throw ReplayMismatch("stage " + std::to_string(index + 1) + " ended after " +
                           std::to_string(record.table.size()) + " of " +
                           std::to_string(recorded_[index].table.size()) + " recorded evaluations");
    stopped_.clear();  // the stage came to its own end in the same generation
    record.finished = true;
    record.stop = words(result.reason);
    record.best_row = result.best_row;
    if (result.front && !record.front)
      record.front = {.rows = result.front->rows, .reference = result.front->reference};
    if (record.table.shape().detail == Detail::derivatives) record.optimality = optimality_record(study_, record);
    return true;
  }

  /// Every stage has streams of its own.
  std::uint64_t stage_seed(std::size_t index) const {
    return contents_.seed + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(index);
  }

  void take_best(const EvaluationTable& table, std::int64_t row) {
    if (row < 0 || study_.problem->objectives().empty()) return;
    const auto stage = static_cast<std::int64_t>(stage_);
    const bool first = contents_.best.row < 0 || contents_.best.stage == stage;
    if (!first) {
      // Earlier stages win ties, so that a stage that finds nothing better changes nothing.
      const auto& objectives = study_.problem->objectives();
      const Ranked before =
          ranked(objectives, contents_.best_stage().table, static_cast<std::size_t>(contents_.best.row));
      const Ranked candidate = ranked(objectives, table, static_cast<std::size_t>(row));
      // Of several objectives the best is a stage's compromise; the last one that is as feasible stands.
      if (objectives.size() > 1 ? candidate.status > before.status : !better(candidate, before)) return;
    }
    contents_.best = {stage, row};
  }

  void report(const Generation& g, const std::string& optimiser) {
    ProgressReport r{.stage = stage_,
                     .stages = study_.stages.size(),
                     .optimiser = optimiser,
                     .generation = g.number,
                     .evaluations = static_cast<std::int64_t>(g.table->size()),
                     .evaluation_limit = limit_,
                     .seconds = now() - start_};
    r.evaluations_per_second = r.seconds > 0 ? static_cast<double>(made_) / r.seconds : 0;
    r.feasible_share = contents_.stages.back().generations.feasible_share.back();
    if (!study_.problem->objectives().empty() && g.best_row >= 0) {
      const auto row = static_cast<std::size_t>(g.best_row);
      r.objective = study_.problem->objectives()[0].name;
      r.has_best = g.table->status[row] == Status::feasible;
      if (r.has_best)
        r.best = g.table->objective_row(row)[0];
      else
        r.violation = violation(g.table->margin_row(row));
    }
    if (g.front && r.has_best) {
      r.front = g.front->rows.size();
      r.hypervolume = g.front->hypervolume;
    }
    progress_.generation(r);
  }

  void write(StudyState state) {
    if (!lock_) return;
    if (ahead_) contents_.stages.back().ahead = ahead_();
    contents_.state = state;
    contents_.seconds = seconds();
    contents_.updated = utc_now();
    if (!lock_->held()) keep_elsewhere();
    write_study(path_, contents_, existing_);
    existing_ = Existing::replaced;
  }

  /// Out of memory: the generations that are complete become a checkpoint, in the memory that the run gives back.
  [[noreturn]] void keep_what_is_whole() {
    evaluator_.forget();
    recorded_ = {};
    ahead_ = {};
    std::string kept = "what it held before";
    if (!replaying_ && whole_rows_) try {
        if (!contents_.stages.empty()) {
          StageRecord& stage = contents_.stages.back();
          if (!stage.finished) stage.table.truncate(*whole_rows_);
          stage.ahead.clear();
          if (stage.table.size() == 0) contents_.stages.pop_back();
        }
        contents_.final.reset();
        write(StudyState::interrupted);
        kept = "what is complete, " + std::to_string(contents_.evaluations()) + " evaluations,";
      } catch (const std::bad_alloc&) {  // then the last checkpoint stands
      }
    throw StorageError(path_ + ": out of memory in stage " + std::to_string(stage_ + 1) + "; the file keeps " + kept +
                       " and can be resumed, with fewer threads or more memory");
  }

  /// Another process may have the study by now: its file is left alone, and nothing of this run is lost.
  [[noreturn]] void keep_elsewhere() {
    const std::filesystem::path path(path_);
    const std::string name = path.stem().string() + "-kept-" + std::to_string(::getpid()) + path.extension().string();
    const std::string kept = (path.parent_path() / name).string();
    write_study(kept, contents_, Existing::refused);
    throw StorageError(path_ + ": its lock was removed while the study ran, so another process may write it; what " +
                       "this run has found is in " + kept + ", and can be resumed there");
  }

  const Study& study_;
  std::string path_;
  const StudyLock* lock_;
  Existing existing_;
  RunOptions options_;
  Progress& progress_;
  CheckpointClock clock_;
  TimedEvaluator evaluator_;
  StudyContents contents_;
  std::vector<StageRecord> recorded_;
  double earlier_seconds_;
  double start_;
  std::size_t stage_ = 0;
  std::int64_t limit_ = 0;
  std::int64_t made_ = 0;
  std::function<std::vector<StartAhead>()> ahead_;  ///< of the stage at work
  bool replaying_ = !recorded_.empty();             ///< nothing that the file does not hold is there yet
  std::optional<std::size_t> whole_rows_;  ///< of the stage at work, up to its last generation; none while it is taken
  std::string stopped_;
  std::exception_ptr failure_;  ///< of rank 0, which ends the run on all
  bool failed_ = false;         ///< rank 0 has one
  int threads_ = 0;             ///< of all ranks
  double exchanged_ = ranks::seconds_in_exchange();
  std::vector<std::string> warnings_;
};

/// The first byte of what rank 0 broadcasts between runs.
constexpr char kTakePart = 'r', kDismissed = 'q';

/// What a rank has to know for a run: what follows the study is one number each.
std::string invitation(const StudyContents& contents, const RunOptions& options) {
  if (ranks::size() == 1) return "";
  return kTakePart + options.program.version + '\n' + options.program.revision + '\n' +
         std::to_string(options.threads) + '\n' + std::to_string(static_cast<int>(instruction_set())) + '\n' +
         pack_study(contents);
}

/// Rank 0's part of a run; the others' is take_part().
RunOutcome run_with_ranks(const Study& study, StudyContents contents, const std::string& path, const StudyLock& lock,
                          Existing existing, const RunOptions& options, Progress& progress) {
  std::string others = invitation(contents, options);
  Run run(study, std::move(contents), path, &lock, existing, options, progress);
  run.begin();
  ranks::broadcast(others);
  return run.run();
}

}  // namespace

int take_part(const Catalogues& catalogues, const ProgramVersion& program) {
  const StopRequest listen;  // rank 0 decides what a signal to all of them does
  Progress silent;
  while (true) {
    std::string message;
    ranks::broadcast(message);
    const char kind = message.empty() ? '\0' : message.front();
    if (kind == kDismissed) return std::stoi(message.substr(1));
    if (kind != kTakePart)
      ranks::abandon("this rank has ended a run in which rank 0 on " + ranks::host(0) +
                     " goes on: the same program with the same libraries has to run on every host");
    std::size_t at = 1;
    const auto line = [&] {
      const std::size_t begin = at, end = message.find('\n', at);
      at = end + 1;
      return message.substr(begin, end - begin);
    };
    RunOptions options;
    options.program.version = line();
    options.program.revision = line();
    if (options.program.version != program.version || options.program.revision != program.revision)
      ranks::abandon("pkmopt " + program.version + " (" + program.revision + ") here, but " + options.program.version +
                     " (" + options.program.revision + ") as rank 0 on " + ranks::host(0) +
                     ": the same program has to run on every host");
    options.threads = std::stoi(line());
    use_instruction_set(std::min(static_cast<InstructionSet>(std::stoi(line())), widest_instruction_set()));
    try {
      StudyContents contents = parse_study(message.substr(at), kStudySchema);
      Study study = study_of(contents, catalogues);
      apply_extensions(study, contents.extensions);
      Run(study, std::move(contents), "", nullptr, Existing::refused, options, silent).run();
    } catch (const ReplayMismatch&) {  // rank 0 tells
    } catch (const std::exception& error) {
      ranks::abandon(message_of(error));
    }
  }
}

void dismiss_ranks(int exit_code) {
  std::string message = kDismissed + std::to_string(exit_code);
  ranks::broadcast(message);
}

Study study_of(const StudyContents& contents, const Catalogues& catalogues, const StudyChanges& changes) {
  Study study = read_study_toml(contents.toml, contents.toml_file, catalogues, contents.description, changes);
  if (const Refusal difference = text_against_record(study, contents))
    throw StorageError("the study's text and what is recorded of it disagree: " + *difference);
  study.seed = contents.seed;
  return study;
}

RunOutcome run_study(const Study& study, const std::string& path, bool overwrite, const RunOptions& options,
                     Progress& progress) {
  const StopRequest listen;
  const StudyLock lock(path);
  std::error_code unseen;  // the attempt to write tells
  if (!overwrite && std::filesystem::exists(path, unseen))
    throw StorageError(path + " exists already; resume it with --resume, or overwrite it with --force");
  return run_with_ranks(study, new_contents(study), path, lock, if_forced(overwrite), options, progress);
}

namespace {

/// Results of our own code have the same bits everywhere; those of the libraries that we call may not.
void note_processor(StudyContents& contents) {
  const std::string here = describe_processor();
  if (contents.machine.starts_with(here + ",")) return;
  const std::string note = "begun on " + contents.machine + ", went on on " + describe_machine() +
                           ": stages of ipopt and isres and motions given as formulas may differ in their last bits "
                           "from a run on one processor";
  if (std::ranges::find(contents.notes, note) == contents.notes.end()) contents.notes.push_back(note);
}

}  // namespace

RunOutcome resume_study(HeldStudy& held, const Catalogues& catalogues, const ExtensionRequest& extension,
                        const RunOptions& options, Progress& progress) {
  const std::string& path = held.path;
  StudyContents& contents = held.contents;
  if (contents.algorithms != kAlgorithms)
    throw StorageError(path + " was written by pkmopt " + contents.program_version + " (" + contents.program_revision +
                       "), whose algorithms have version " + std::to_string(contents.algorithms) +
                       "; this program has version " + std::to_string(kAlgorithms) + " and would not repeat it");
  Study study = study_of(contents, catalogues);
  try {
    contents.problem = continued_problem(study, contents.problem);
  } catch (const std::invalid_argument& change) {
    throw StorageError(path + " cannot be continued: " + change.what());
  }
  if (extension.generations || extension.evaluations) {
    request_extension(study, contents, extension);
    contents.state = StudyState::interrupted;
    contents.final.reset();
    write_study(path, contents);  // so that the extension survives a stop while the past is replayed
  }
  apply_extensions(study, contents.extensions);
  note_processor(contents);
  try {
    return run_with_ranks(study, std::move(contents), path, held.lock, Existing::replaced, options, progress);
  } catch (const ReplayMismatch& mismatch) {
    throw StorageError(path + " cannot be continued: " + mismatch.what());
  }
}

}  // namespace pkm
