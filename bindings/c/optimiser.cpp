// Optimisers with an ask-and-tell interface: an optimiser runs on a thread of its own, whose evaluator hands each batch
// of designs to the caller and waits for the values. Either the caller or the optimiser runs, never both.
#include <algorithm>
#include <cmath>
#include <condition_variable>

#include "bindings/c/handles.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/runner/stage_starts.hpp"

namespace pkm::c {
namespace {

/// The caller's problem: it has variables, objectives and constraints, but only the caller can evaluate it.
class ToldProblem final : public Problem {
 public:
  ToldProblem(std::vector<Variable> variables, const int* maximise, std::size_t objectives, std::size_t margins)
      : space_(std::move(variables)) {
    for (std::size_t i = 0; i < objectives; ++i)
      objectives_.push_back({"f" + std::to_string(i + 1), "1", "objective",
                             maximise && maximise[i] ? Direction::maximise : Direction::minimise});
    for (std::size_t i = 0; i < margins; ++i) margins_.push_back({"g" + std::to_string(i + 1), "1", "constraint"});
  }
  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<OutputInfo>& reports() const override { return outputs_; }
  void evaluate(std::span<const double>, Scratch&, EvaluationSlot) const override {
    throw std::logic_error("only the caller evaluates");
  }
  Unsupported why_no_derivatives() const override { return {}; }

 private:
  DesignSpace space_;
  std::vector<ObjectiveInfo> objectives_;
  std::vector<MarginInfo> margins_;
  std::vector<OutputInfo> outputs_;
};

std::vector<Variable> variables_of(std::size_t count, const double* lower, const double* upper, const double* step) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "x" + std::to_string(i + 1);
    if (!(lower[i] < upper[i]) || !std::isfinite(lower[i]) || !std::isfinite(upper[i]))
      throw ConfigError({"", 0, name}, std::to_string(lower[i]) + " .. " + std::to_string(upper[i]),
                        "finite bounds, the lower one less than the upper one");
    if (step && !(step[i] >= 0 && std::isfinite(step[i])))
      throw ConfigError({"", 0, name + ".step"}, std::to_string(step[i]), "a number >= 0");
    variables.push_back({name, "1", lower[i], upper[i], step ? step[i] : 0});
  }
  return variables;
}

}  // namespace
}  // namespace pkm::c

/// The caller's thread and the optimiser's thread run alternately: while one waits, the other has exclusive access to
/// all members.
struct pkmopt_optimiser final : pkm::Evaluator, pkm::Monitor {
  pkmopt_optimiser(std::vector<pkm::Variable> variables, const int* maximise, std::size_t objectives,
                   std::size_t margins, const std::string& lines, std::uint64_t seed)
      : problem(std::move(variables), maximise, objectives, margins),
        stage(pkm::read_stage_toml(lines, "options", pkm::c::catalogues().optimisers, problem)),
        table(problem.shape(stage.optimiser->detail())),
        seed_(seed) {}

  ~pkmopt_optimiser() override {
    is_ending_ = true;
    if (thread_.joinable()) {
      give_turn();
      thread_.join();
    }
  }

  /// Runs the optimiser until it asks for evaluations or ends.
  void advance() {
    if (!thread_.joinable())
      thread_ = std::thread([this] { run(); });
    else
      give_turn();
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return is_callers_turn_; });
    }
    if (failure) std::rethrow_exception(failure);
  }

  // The following functions implement Evaluator and Monitor; they run on the optimiser's thread.
  void evaluate(const pkm::Problem&, pkm::EvaluationTable& asked_table, std::size_t first) override {
    asked = &asked_table;
    first_row = first;
    {
      std::unique_lock lock(mutex_);
      is_callers_turn_ = true;
      changed_.notify_all();
      changed_.wait(lock, [this] { return !is_callers_turn_; });
    }
    if (is_ending_) {
      asked_table.truncate(first);
      throw pkm::Stopped();
    }
  }
  bool generation(const pkm::Generation& generation) override {
    best_row = generation.best_row;
    return !is_ending_;
  }
  void warn(const std::string& warning) override {
    // Optimisers print warnings only when a stage is resumed, and this stage has no recorded evaluations.
    throw std::logic_error(warning);
  }

  pkm::c::ToldProblem problem;
  pkm::Stage stage;
  pkm::EvaluationTable table;             ///< all evaluations of the stage
  pkm::EvaluationTable* asked = nullptr;  ///< table whose rows from first_row on the caller has to evaluate; null:
                                          ///< no evaluation is pending
  std::size_t first_row = 0;
  bool is_finished = false;
  std::int64_t best_row = -1;
  std::exception_ptr failure;

 private:
  void run() {
    try {
      const pkm::StageInput input{
          .problem = problem, .evaluator = *this, .monitor = *this, .seed = seed_, .starts = starts()};
      best_row = stage.optimiser->minimise(input, table).best_row;
    } catch (const pkm::Stopped&) {  // thrown because the handle is being freed
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    is_finished = true;
    asked = nullptr;
    is_callers_turn_ = true;
    changed_.notify_all();
  }
  /// The start designs, chosen as in the first stage of a study without baseline.
  std::vector<pkm::StartDesign> starts() const {
    std::vector<double> middle;
    for (std::size_t v = 0; v < problem.space().dimension(); ++v) middle.push_back(problem.space().from_unit(v, 0.5));
    return first_start_designs(problem.space(), stage, {middle, "the middle of the ranges"});
  }
  void give_turn() {
    const std::lock_guard lock(mutex_);
    is_callers_turn_ = false;
    changed_.notify_all();
  }

  std::uint64_t seed_;
  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_callers_turn_ = false;
  bool is_ending_ = false;
};

using namespace pkm::c;

pkmopt_status pkmopt_optimiser_names(char** json) {
  return guarded([&] { *json = allocated(Json(pkm::names_of(catalogues().optimisers))); });
}

pkmopt_status pkmopt_optimiser_create(const char* options, size_t variables, const double* lower, const double* upper,
                                      const double* step, size_t objectives, const int* maximise, size_t margins,
                                      uint64_t seed, pkmopt_optimiser** optimiser) {
  return guarded([&] {
    *optimiser = new pkmopt_optimiser(variables_of(variables, lower, upper, step), maximise, objectives, margins,
                                      required_text(options, "options"), seed);
  });
}

void pkmopt_optimiser_free(pkmopt_optimiser* optimiser) { delete optimiser; }

pkmopt_status pkmopt_optimiser_ask(pkmopt_optimiser* optimiser, size_t* count, const double** designs,
                                   int* derivatives) {
  return guarded([&] {
    pkmopt_optimiser& o = *optimiser;
    if (!o.asked && !o.is_finished) o.advance();
    *count = o.asked ? o.asked->size() - o.first_row : 0;
    *designs = *count > 0 ? o.asked->design(o.first_row).data() : nullptr;
    *derivatives = o.table.shape().detail == pkm::Detail::derivatives ? 1 : 0;
  });
}

pkmopt_status pkmopt_optimiser_tell(pkmopt_optimiser* optimiser, const double* objectives, const double* margins,
                                    const double* derivatives, const uint8_t* status) {
  return guarded([&] {
    pkmopt_optimiser& o = *optimiser;
    if (!o.asked) throw pkm::ConfigError({"", 0, "tell"}, "no open designs", "a call of ask() before");
    pkm::EvaluationTable& table = *o.asked;
    const pkm::EvaluationShape shape = table.shape();
    if (shape.detail == pkm::Detail::derivatives && !derivatives)
      throw pkm::ConfigError({"", 0, "tell"}, "no derivatives",
                             "those of all objectives and constraints: the optimiser needs them");
    if (shape.margins > 0 && !margins)
      throw pkm::ConfigError({"", 0, "tell"}, "no margins", std::to_string(shape.margins) + " for each design");
    const std::size_t count = table.size() - o.first_row;
    for (std::size_t k = 0; status && k < count; ++k)
      if (status[k] > PKMOPT_FAILED)
        throw pkm::ConfigError({"", 0, "status[" + std::to_string(k) + "]"}, std::to_string(status[k]),
                               "PKMOPT_FEASIBLE, PKMOPT_INFEASIBLE or PKMOPT_FAILED");
    for (std::size_t k = 0; k < count; ++k) {
      const pkm::EvaluationSlot slot = table.slot(o.first_row + k);
      std::copy_n(objectives + k * shape.objectives, shape.objectives, slot.objectives.begin());
      if (margins) std::copy_n(margins + k * shape.margins, shape.margins, slot.margins.begin());
      const auto is_finite = [](double x) { return std::isfinite(x); };
      const bool is_complete = std::ranges::all_of(slot.objectives, is_finite) &&
                               std::ranges::none_of(slot.margins, [](double x) { return std::isnan(x); });
      const bool is_feasible = std::ranges::all_of(slot.margins, [](double x) { return x >= 0; });
      slot.status = status         ? static_cast<pkm::Status>(status[k])
                    : !is_complete ? pkm::Status::failed
                    : is_feasible  ? pkm::Status::feasible
                                   : pkm::Status::infeasible;
      const std::size_t functions = shape.objectives + shape.margins;
      for (std::size_t f = 0; f < functions && !slot.derivatives.empty(); ++f) {
        double* const row = &slot.derivatives[f * (1 + shape.variables)];
        row[0] = f < shape.objectives ? slot.objectives[f] : slot.margins[f - shape.objectives];
        std::copy_n(derivatives + (k * functions + f) * shape.variables, shape.variables, row + 1);
      }
    }
    o.asked = nullptr;
    o.advance();
  });
}

pkmopt_status pkmopt_optimiser_evaluations(const pkmopt_optimiser* optimiser, size_t* rows, double* designs,
                                           double* objectives, double* margins, uint8_t* status, int64_t* best) {
  return guarded([&] {
    const pkm::EvaluationTable& table = optimiser->table;
    // The rows that wait for values are the last ones of the table.
    *rows = optimiser->asked == &table ? optimiser->first_row : table.size();
    *best = optimiser->best_row;
    const pkm::EvaluationShape& shape = table.shape();
    if (designs) std::copy_n(table.designs.begin(), *rows * shape.variables, designs);
    if (objectives) std::copy_n(table.objectives.begin(), *rows * shape.objectives, objectives);
    if (margins) std::copy_n(table.margins.begin(), *rows * shape.margins, margins);
    for (std::size_t row = 0; status && row < *rows; ++row) status[row] = static_cast<std::uint8_t>(table.status[row]);
  });
}
