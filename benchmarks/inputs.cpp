#include "benchmarks/inputs.hpp"

#include <stdexcept>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/math/random.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "objectives/all.hpp"

namespace pkm::benchmarks {
namespace {

using namespace four_ppa_two_par;

const Catalogues& catalogues() {
  static const Catalogues all{all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()};
  return all;
}

Study experiment(const std::string& name) {
  return load_study_toml(std::string(PKM_EXPERIMENTS) + "/4ppa-2par/" + name, catalogues());
}

double volume(const WorkspaceEvaluator& evaluator, std::span<const double> parameters) {
  WorkspaceResult<double> survey;
  evaluate_once(evaluator, parameters, survey);
  return survey.volume;
}

}  // namespace

const Mechanism& mechanism_named(std::string_view name) {
  for (const auto& mechanism : all_mechanisms())
    if (mechanism->info().name == name) return *mechanism;
  throw std::out_of_range(std::string(name) + " is not in the catalogue");
}
const Mechanism& four_ppa() { return mechanism_named("4ppa-2par"); }

std::vector<double> design(double a, double b, double l_u, double l_d) {
  std::vector<double> all;
  for (const Parameter& parameter : four_ppa().info().parameters) all.push_back(parameter.nominal);
  all[kA] = a;
  all[kB] = b;
  all[kLu] = l_u;
  all[kLd] = l_d;
  all[kD] = 0.15;
  all[kL0] = 2.5;
  return all;
}

std::vector<double> nominal(const Mechanism& mechanism) {
  std::vector<double> design;
  for (const Parameter& p : mechanism.info().parameters) design.push_back(p.nominal);
  return design;
}

std::vector<double> original_design() { return design(0.2, 0.8, 0.6, 0.55); }
std::vector<double> optimal_design() { return design(0.3, 1.0, 0.7, 0.7); }

LimitSpec without_limits() { return no_limits(four_ppa().info()); }
LimitSpec with_limits() { return wide_study().problem->parts().plan.limits; }

std::vector<std::vector<double>> designs_with_active_limits(std::size_t count) {
  const Study study = wide_study();
  const auto limited = prepare_workspace(four_ppa(), column_plan(with_limits()), {});
  const auto free = prepare_workspace(four_ppa(), column_plan(without_limits()), {});
  std::vector<std::vector<double>> designs;
  std::vector<double> variables(study.problem->space().dimension());
  for (std::uint32_t row = 0; designs.size() < count; ++row) {
    random_design(study.problem->space(), 1, row, variables);
    auto all = study.problem->parameters(variables);
    const double value = volume(*limited, all);
    if (value > 0.05 && value < 0.99 * volume(*free, all)) designs.push_back(std::move(all));
  }
  return designs;
}

WorkspacePlan voxel_plan(const LimitSpec& limits) { return {.method = kPaperGrid, .limits = limits}; }

WorkspacePlan column_plan(const LimitSpec& limits, const std::vector<FixedCoordinate>& fixed_coordinates,
                          double tolerance) {
  return {.method = ColumnOptions{.tolerance = tolerance}, .fixed = fixed_coordinates, .limits = limits};
}

Study paper_study() { return experiment("paper-problem.toml"); }
Study wide_study() { return experiment("wide-bounds.toml"); }

void random_design(const DesignSpace& space, std::uint64_t seed, std::uint32_t row, std::span<double> values) {
  Stream stream(seed, 0, row, Stream::Use::start);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = space.from_unit(i, stream.u01());
}

}  // namespace pkm::benchmarks
