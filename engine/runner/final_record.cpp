#include "engine/runner/final_record.hpp"

#include <array>
#include <cmath>
#include <span>

#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/largest_solid_options.hpp"
#include "engine/problem/tied_parameters.hpp"
#include "engine/results/active_constraints.hpp"
#include "engine/runner/certificates.hpp"
#include "engine/runner/design_record.hpp"
#include "engine/runner/exact_values.hpp"
#include "engine/runner/progress.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/visualisation_plan.hpp"

namespace pkm {
namespace {

// Beginning of the texts of notes. Notes of an earlier run are recognised by it and replaced.
constexpr const char* kWideBounds = "certified bounds of the ";

/// Number of cells of the voxel map of a study whose workspace is analysed by columns.
constexpr std::array<std::int64_t, 3> kMapCells = {32, 34, 60};

/// Computes the voxel map of a design's workspace.
MapRecord map_record(const ProblemParts& parts, std::span<const double> parameters) {
  const MechanismInfo& info = parts.mechanism->info();
  MapRecord map;
  map.voxels = voxel_map(*parts.mechanism, parameters, visualisation_plan(info, parts.plan, kMapCells));
  for (const int swept : sweep_of(info, parts.plan).swept) {
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(swept)];
    map.axes.push_back(axis.name);
    map.units.push_back(axis.unit);
  }
  map.axes.resize(3);  // unused axes get empty names
  map.units.resize(3, "1");
  return map;
}

/// Computes the exact values of the best design, then of the baseline. Notes on the baseline precede those on the best
/// design.
void add_exact_values(const Study& study, StudyContents& contents,
                      const std::function<void(const std::string&)>& begin) {
  FinalRecord& f = *contents.final;
  const std::string bound = duration_text(study.exact_seconds);
  begin("exact values of the best design" + std::string(f.baseline ? " and the baseline" : "") + ", at most " + bound);
  std::vector<std::string> notes_on_best, notes_on_baseline;
  bool has_best = !f.best, has_baseline = !f.baseline;
  const StopScope limit(study.exact_seconds);
  try {
    const auto evaluate = [&](const char* name, const DesignRecord& design, std::vector<std::string>& notes) {
      return ExactValues(study.problem->of(design.parameters).parts()).evaluate(name, design.parameters, notes);
    };
    if (f.best) f.best_exact = evaluate("best design", *f.best, notes_on_best);
    has_best = true;
    if (f.baseline) f.baseline_exact = evaluate("baseline", *f.baseline, notes_on_baseline);
    has_baseline = true;
  } catch (const Stopped&) {
    if (limit.is_requested_by_outer_scope()) throw;
    const auto missing = [&](const char* name) {
      return std::string(ExactValues::kNoValues) + name + ": they take longer than " + bound + " ([workspace] exact)";
    };
    if (!has_best) notes_on_best = {missing("best design")};
    if (!has_baseline) notes_on_baseline = {missing("baseline")};
  }
  for (const auto* notes : {&notes_on_baseline, &notes_on_best})
    contents.notes.insert(contents.notes.end(), notes->begin(), notes->end());
}

}  // namespace

double rounded_to(double value, double step) {
  // Dividing by an integer rounds once; multiplying by a step such as 0.1, which is itself rounded, would round twice.
  const double per_unit = std::nearbyint(1 / step);
  if (per_unit >= 1 && std::fabs(1 / step - per_unit) <= 1e-9 * per_unit)
    return std::nearbyint(value * per_unit) / per_unit;
  return std::nearbyint(value / step) * step;
}

FinalRecord final_record(const Study& study, const StudyContents& contents) {
  const DesignProblem& problem = *study.problem;
  const ProblemParts& parts = problem.parts();
  FinalRecord f;
  f.volume_unit = volume_unit(parts.mechanism->info(), parts.plan);
  if (study.baseline) f.baseline = evaluate_design(problem, *study.baseline);
  if (contents.best.row < 0) return f;
  const auto best = problem.parameters(contents.best_design());
  f.best = evaluate_design(problem, best);
  f.active = active_sentences(contents.problem, contents.best_design(), f.best->margins);
  if (study.round) {
    auto rounded = best;
    for (const std::size_t i : parts.varies) rounded[i] = rounded_to(best[i], *study.round);
    apply_ties(parts, rounded);
    f.rounded = evaluate_design_after_rounding(problem, rounded);
  }
  return f;
}

bool has_exact_step(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  return parts.plan.voxels() && parts.mechanism->columns() && study.exact_seconds > 0;
}

void complete_final_record(const Study& study, StudyContents& contents,
                           const std::function<void(const std::string&)>& begin) {
  const DesignProblem& problem = *study.problem;
  const ProblemParts& parts = problem.parts();
  FinalRecord& f = *contents.final;
  std::erase_if(contents.notes, [](const std::string& note) {
    return note.starts_with(ExactValues::kNoValues) || note.starts_with(kWideBounds) || is_note_of_certificate(note);
  });
  if (f.best) {
    begin("map of the best design's workspace");
    f.map = map_record(problem.of(f.best->parameters).parts(), f.best->parameters);
  }
  if (const ColumnOptions* const columns = parts.plan.columns(); columns && columns->certified) {
    const double requested = *columns->certified;
    for (const auto& [name, design] :
         {std::pair("baseline", &f.baseline), {"best design", &f.best}, {"rounded design", &f.rounded}}) {
      if (!*design) continue;
      begin("certified bounds of the " + std::string(name));
      add_certified_bounds(problem, requested, **design);
      if (const auto& bounds = (*design)->certified; bounds && bounds->gap() > requested)
        contents.notes.push_back(kWideBounds + std::string(name) + " have the gap " + shortest(bounds->gap()) +
                                 ", requested " + shortest(requested) + ": " + std::to_string(bounds->boxes) +
                                 " boxes");
      if (parts.followed.empty()) continue;
      begin("motions of the " + std::string(name));
      certify_motions(problem.of((*design)->parameters).parts(), name, **design, contents.notes);
    }
  }
  if (f.best && !solid_measures(parts).empty()) {
    begin("largest solids of the best design");
    certify_solids(problem.of(f.best->parameters).parts(), "best design", *f.best, contents.notes);
  }
  if (has_exact_step(study)) add_exact_values(study, contents, begin);
}

}  // namespace pkm
