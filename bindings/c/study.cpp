// Studies of the C interface: evaluation and differentiation of designs.
#include <algorithm>
#include <sstream>

#include "bindings/c/handles.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/report/json_text.hpp"

namespace pkm::c {

StudyChanges changes_of(const char* lines) {
  StudyChanges changes;
  std::istringstream all(text_or_empty(lines));
  for (std::string line; std::getline(all, line);) {
    const std::size_t space = line.find(' ');
    const std::string kind = line.substr(0, space), value = space == std::string::npos ? "" : line.substr(space + 1);
    if (kind == "set")
      changes.set.push_back(value);
    else if (kind == "limit")
      changes.limit.push_back(value);
    else if (kind == "cells")
      changes.cells.push_back(value);
    else
      throw ConfigError({"", 0, "changes"}, "'" + line + "'", "set NAME=VALUE, limit NAME=VALUE or cells NAME=NUMBER");
  }
  return changes;
}

std::unique_ptr<pkmopt_study> study_handle(Study study) {
  auto handle = std::make_unique<pkmopt_study>();
  handle->study = std::move(study);
  return handle;
}

namespace {

Json info_of(const Study& study) {
  const DesignProblem& problem = *study.problem;
  const ProblemParts& parts = problem.parts();
  const MechanismInfo& mechanism = parts.mechanism->info();
  Json info = {{"name", study.name}, {"seed", study.seed}, {"file", study.file_name}, {"output", study.output_file()}};
  info["mechanism"] = mechanism.name;
  info["parameters"] = infos_json(mechanism.parameters);
  for (std::size_t i = 0; i < parts.parameters.size(); ++i) info["parameters"][i]["value"] = parts.parameters[i];
  info["variables"] = Json::array();
  for (std::size_t i = 0; i < parts.varies.size(); ++i) {
    const Variable& v = parts.space[i];
    info["variables"].push_back({{"name", v.name},
                                 {"unit", v.unit},
                                 {"min", v.lower},
                                 {"max", v.upper},
                                 {"step", v.step},
                                 {"parameter", parts.varies[i]}});
  }
  info["objectives"] = infos_json(problem.objectives());
  for (std::size_t i = 0; i < problem.objectives().size(); ++i)
    info["objectives"][i]["maximise"] = problem.objectives()[i].direction == Direction::maximise;
  info["constraints"] = infos_json(problem.margins());
  info["outputs"] = infos_json(problem.reports());
  info["functions"] = problem.external_calls();
  info["baseline"] = study.baseline ? Json(*study.baseline) : Json();
  info["method"] = parts.plan.voxels() ? "voxels" : "columns";
  info["swept"] = Json::array();
  for (const int i : sweep_of(mechanism, parts.plan).swept) {
    const AxisInfo& axis = mechanism.coordinates[static_cast<std::size_t>(i)];
    info["swept"].push_back({{"name", axis.name}, {"unit", axis.unit}});
  }
  info["volume_unit"] = volume_unit(mechanism, parts.plan);
  const Unsupported why = problem.why_no_derivatives();
  info["why_no_derivatives"] = why ? Json(*why) : Json();
  info["stages"] = Json::array();
  for (const Stage& stage : study.stages) info["stages"].push_back(stage.entry->name);
  info["warnings"] = study.warnings;
  info["text"] = study.text;
  info["mechanism_text"] = study.description ? Json(study.description->text) : Json();
  return info;
}

/// Arrays that receive the results of an evaluation; null: the result is not requested.
struct Outputs {
  double *objectives, *margins, *outputs, *derivatives;
  std::uint8_t* status;
};

template <class T>
void copy_unless_null(const std::vector<T>& from, T* to) {
  if (to) std::ranges::copy(from, to);
}

/// Scratch memory of evaluate_one().
struct OneDesign {
  std::vector<double> objectives, margins, outputs, derivatives;
};

/// Evaluates a single design on this thread, with scratch memory that is kept for the next design.
void evaluate_one(const pkmopt_study& handle, const double* design, Detail detail, const Outputs& to) {
  const DesignProblem& problem = *handle.study.problem;
  const EvaluationShape shape = problem.shape(detail);
  std::unique_ptr<Scratch> scratch;
  {
    const std::lock_guard lock(handle.scratch_mutex);
    if (!handle.idle_scratch.empty()) {
      scratch = std::move(handle.idle_scratch.back());
      handle.idle_scratch.pop_back();
    }
  }
  if (!scratch) scratch = std::make_unique<Scratch>();
  OneDesign& values = scratch->get<OneDesign>();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  values.objectives.assign(shape.objectives, nan);
  values.margins.assign(shape.margins, nan);
  values.outputs.assign(shape.reports, nan);
  values.derivatives.assign(shape.derivatives(), nan);
  Status status = Status::failed;
  evaluate_design(problem, {design, shape.variables}, *scratch,
                  {values.objectives, values.margins, values.outputs, status, detail, values.derivatives});
  copy_unless_null(values.objectives, to.objectives);
  copy_unless_null(values.margins, to.margins);
  copy_unless_null(values.outputs, to.outputs);
  copy_unless_null(values.derivatives, to.derivatives);
  if (to.status) *to.status = static_cast<std::uint8_t>(status);
  const std::lock_guard lock(handle.scratch_mutex);
  handle.idle_scratch.push_back(std::move(scratch));
}

/// The reason why the mechanism does not allow a design; empty if it does. Only designs outside of the variables'
/// bounds can be refused.
Unsupported refusal(const DesignProblem& problem, std::span<const double> design) {
  for (std::size_t i = 0; i < design.size(); ++i)
    if (!(design[i] >= problem.space()[i].lower && design[i] <= problem.space()[i].upper))
      return problem.parts().mechanism->refuse(problem.parameters(design));
  return {};
}

/// Evaluates the designs that the mechanism does not refuse; the other designs get the status `failed`.
void evaluate_all(const pkmopt_study& handle, std::size_t count, const double* designs, Detail detail,
                  const Outputs& to, const pkmopt_options* options) {
  const DesignProblem& problem = *handle.study.problem;
  const EvaluationShape shape = problem.shape(detail);
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < count; ++k)
    if (!refusal(problem, {designs + k * shape.variables, shape.variables})) rows.push_back(k);
  if (count == 1 && rows.size() == 1)
    return with_options(options, false, [&] { evaluate_one(handle, designs, detail, to); });
  EvaluationTable table(shape);
  table.extend(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row)
    std::copy_n(designs + rows[row] * shape.variables, shape.variables,
                table.designs.begin() + static_cast<std::ptrdiff_t>(row * shape.variables));
  ParallelEvaluator evaluator(options ? options->threads : 0);
  if (!rows.empty()) with_options(options, true, [&] { evaluator.evaluate(problem, table, 0); });
  const auto scatter = [&](const std::vector<double>& from, std::size_t width, double* values) {
    if (!values) return;
    std::fill_n(values, count * width, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t row = 0; row < rows.size(); ++row)
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(row * width), width, values + rows[row] * width);
  };
  scatter(table.objectives, shape.objectives, to.objectives);
  scatter(table.margins, shape.margins, to.margins);
  scatter(table.reports, shape.reports, to.outputs);
  scatter(table.derivatives, shape.derivatives(), to.derivatives);
  if (!to.status) return;
  std::fill_n(to.status, count, static_cast<std::uint8_t>(Status::failed));
  for (std::size_t row = 0; row < rows.size(); ++row)
    to.status[rows[row]] = static_cast<std::uint8_t>(table.status[row]);
}

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_study_from_file(const char* path, const char* changes, pkmopt_study** study) {
  return guarded([&] {
    *study =
        study_handle(pkm::load_study_toml(required_text(path, "path"), catalogues(), changes_of(changes))).release();
  });
}

pkmopt_status pkmopt_study_from_text(const char* toml, const char* file_name, const char* mechanism_toml,
                                     const char* mechanism_file_name, const char* changes, pkmopt_study** study) {
  return guarded([&] {
    std::optional<pkm::SourceText> description;
    if (mechanism_toml)
      description = pkm::SourceText{mechanism_toml, mechanism_file_name ? mechanism_file_name : "mechanism.toml"};
    *study = study_handle(pkm::read_study_toml(required_text(toml, "toml"), file_name ? file_name : "study.toml",
                                               catalogues(), description, changes_of(changes)))
                 .release();
  });
}

pkmopt_status pkmopt_study_info(const pkmopt_study* study, char** json) {
  return guarded([&] { *json = allocated(info_of(study->study)); });
}

void pkmopt_study_free(pkmopt_study* study) { delete study; }

pkmopt_status pkmopt_study_evaluate(const pkmopt_study* study, size_t count, const double* designs, int complete,
                                    double* objectives, double* margins, double* outputs, uint8_t* status,
                                    const pkmopt_options* options) {
  return guarded([&] {
    evaluate_all(*study, count, designs, complete ? pkm::Detail::complete : pkm::Detail::enough,
                 {objectives, margins, outputs, nullptr, status}, options);
  });
}

pkmopt_status pkmopt_study_differentiate(const pkmopt_study* study, size_t count, const double* designs,
                                         double* objectives, double* margins, double* outputs, uint8_t* status,
                                         double* derivatives, const pkmopt_options* options) {
  return guarded([&] {
    if (const pkm::Unsupported reason = study->study.problem->why_no_derivatives())
      throw pkm::ConfigError({"", 0, "derivatives"}, *reason);
    evaluate_all(*study, count, designs, pkm::Detail::derivatives, {objectives, margins, outputs, derivatives, status},
                 options);
  });
}

pkmopt_status pkmopt_study_why_failed(const pkmopt_study* study, const double* design, char** sentence,
                                      const pkmopt_options* options) {
  return guarded([&] {
    const pkm::DesignProblem& problem = *study->study.problem;
    if (const pkm::Unsupported refused = refusal(problem, {design, problem.space().dimension()})) {
      *sentence = allocated(*refused);
      return;
    }
    std::string reason;
    with_options(options, false, [&] {
      std::uint8_t status = PKMOPT_FAILED;
      evaluate_one(*study, design, pkm::Detail::complete, {.status = &status});
      if (status != PKMOPT_FAILED) return;
      reason = problem.failure_reason({design, problem.space().dimension()}, pkm::Detail::complete);
    });
    *sentence = allocated(reason);
  });
}
