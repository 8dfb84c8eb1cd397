// Workspaces of the designs of a study in the C interface: volume with derivatives, fields, surface.
#include <algorithm>
#include <cmath>

#include "bindings/c/handles.hpp"
#include "engine/export/isosurface.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm::c {
namespace {

const ProblemParts& parts_of(const pkmopt_study& handle) { return handle.study.problem->parts(); }

const WorkspaceEvaluator& workspace_of(const pkmopt_study& handle) {
  std::call_once(handle.has_workspace,
                 [&] { handle.workspace = prepare_workspace(*parts_of(handle).mechanism, parts_of(handle).plan, {}); });
  return *handle.workspace;
}

/// Throws DesignError for parameters that do not describe a mechanism.
std::span<const double> checked_parameters(const pkmopt_study& handle, const double* parameters) {
  const Mechanism& mechanism = *parts_of(handle).mechanism;
  const std::span<const double> all(parameters, mechanism.info().parameters.size());
  if (const Unsupported reason = mechanism.refuse(all)) throw DesignError(*reason);
  return all;
}

/// Adds the derivatives of the volume with respect to all parameters, computed in blocks of four, the number of
/// derivatives of Dual4.
void add_gradient(const WorkspaceEvaluator& workspace, std::span<const double> parameters, double* gradient) {
  constexpr std::size_t kBlock = 4;
  const GradientEvaluator* const evaluator = workspace.gradients();
  if (!evaluator) throw ConfigError({"", 0, "derivatives"}, workspace.why_no_derivatives());
  Scratch scratch;
  WorkspaceResult<Dual4> result;
  for (std::size_t first = 0; first < parameters.size(); first += kBlock) {
    std::vector<Dual4> x(parameters.begin(), parameters.end());
    const std::size_t count = std::min(kBlock, parameters.size() - first);
    for (std::size_t i = 0; i < count; ++i) x[first + i].v[static_cast<int>(i)] = 1;
    evaluator->evaluate(x, scratch, result);
    for (std::size_t i = 0; i < count; ++i) gradient[first + i] = result.volume.v[static_cast<int>(i)];
  }
}

Json axis_json(const WorkspaceAxis& axis) {
  return {
      {"name", axis.name}, {"unit", axis.unit}, {"lower", axis.lower}, {"upper", axis.upper}, {"cells", axis.cells}};
}

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_study_volume(const pkmopt_study* study, const double* parameters, double* volume, double* error,
                                  double* gradient, const pkmopt_options* options) {
  return guarded([&] {
    const auto all = checked_parameters(*study, parameters);
    with_options(options, parts_of(*study).plan.voxels() != nullptr, [&] {
      const pkm::WorkspaceEvaluator& workspace = workspace_of(*study);
      pkm::WorkspaceResult<double> result;
      pkm::evaluate_once<double>(workspace, all, result);
      *volume = result.volume;
      *error = parts_of(*study).plan.voxels() ? std::nan("") : result.error;
      if (gradient) add_gradient(workspace, all, gradient);
    });
  });
}

pkmopt_status pkmopt_study_fields(const pkmopt_study* study, const double* parameters, const char* mode, char** json,
                                  double** values, const pkmopt_options* options) {
  return guarded([&] {
    const auto all = checked_parameters(*study, parameters);
    pkm::WorkspaceFields found;
    with_options(options, true, [&] {
      found = pkm::workspace_fields(*parts_of(*study).mechanism, all, parts_of(*study).plan, text_or_empty(mode));
    });
    Json info = {{"volume", found.volume}, {"volume_unit", found.volume_unit}, {"touches_box", found.touches_box}};
    info["axes"] = Json::array();
    for (const auto& axis : found.axes) info["axes"].push_back(axis_json(axis));
    info["fixed"] = Json::array();
    for (const auto& axis : found.fixed)
      info["fixed"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"value", axis.lower}});
    info["fields"] = Json::array();
    double* const copy = allocated_array<double>(found.fields.size() * found.cells());
    *values = copy;
    for (std::size_t i = 0; i < found.fields.size(); ++i) {
      const pkm::WorkspaceField& field = found.fields[i];
      info["fields"].push_back({{"name", field.name}, {"unit", field.unit}, {"meaning", field.meaning}});
      std::ranges::copy(field.values, copy + i * found.cells());
    }
    *json = allocated(info);
  });
}

pkmopt_status pkmopt_study_surface(const pkmopt_study* study, const double* parameters, size_t* vertex_count,
                                   double** vertices, size_t* triangle_count, uint32_t** triangles,
                                   const pkmopt_options* options) {
  return guarded([&] {
    const auto all = checked_parameters(*study, parameters);
    const pkm::ProblemParts& parts = parts_of(*study);
    pkm::Isosurface surface;
    with_options(options, true, [&] {
      const pkm::PoseMargin margin(*parts.mechanism, all, parts.plan.limits);
      surface = pkm::isosurface(pkm::workspace_fields(*parts.mechanism, all, parts.plan, ""), &margin);
    });
    *vertex_count = surface.vertices.size();
    *vertices = allocated_array<double>(3 * surface.vertices.size());
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) std::ranges::copy(surface.vertices[i], *vertices + 3 * i);
    *triangle_count = surface.triangles.size();
    *triangles = allocated_array<std::uint32_t>(3 * surface.triangles.size());
    for (std::size_t i = 0; i < surface.triangles.size(); ++i)
      std::ranges::copy(surface.triangles[i], *triangles + 3 * i);
  });
}
