#include "engine/report/shown_designs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/problem/front.hpp"
#include "engine/problem/largest_solid_options.hpp"
#include "engine/report/thinning.hpp"
#include "engine/results/comparison.hpp"
#include "engine/workspace/visualisation_plan.hpp"

namespace pkm {
namespace {

// Number of front designs that a page includes in addition to the best design.
constexpr std::size_t kFrontDesigns = 10;
constexpr PageDetail kFrontDetail = {16, 5, 3, false};  // resolution at which the front designs are sampled

/// A plan of voxels for the workspace of a study's plan, with at most max_cells along each axis.
WorkspacePlan page_plan(const MechanismInfo& info, const WorkspacePlan& plan, std::int64_t max_cells) {
  WorkspacePlan picture = visualisation_plan(info, plan, {max_cells, max_cells, max_cells});
  for (std::int64_t& cells : std::get<VoxelOptions>(picture.method).cells) cells = std::min(cells, max_cells);
  return picture;
}

/// The range of a fixed coordinate around its value in which at least one of a sample of feasible poses remains
/// feasible. It is found by steps from the value in both directions.
std::array<double, 2> feasible_range(const WorkspaceAxis& fixed, const ShownDesigns& shown, const ShownDesign& design) {
  constexpr std::size_t kPoses = 100;  // number of sampled poses
  constexpr int kSteps = 60;           // number of steps in each direction
  const WorkspaceFields& workspace = *design.workspace;
  const std::vector<std::size_t> cells = workspace.feasible_cells();
  std::vector<Pose<double>> poses;
  for (const std::size_t i : Thinning(cells.size(), kPoses).indices) poses.push_back(workspace.pose(cells[i]));

  // Maximum difference from the value of the fixed coordinate: pi for an angle, twice the largest extent of the
  // workspace for a length.
  double reach = std::numbers::pi;
  if (fixed.unit == "m") {
    reach = 0;
    for (const WorkspaceAxis& axis : workspace.axes)
      if (axis.unit == "m") reach = std::fmax(reach, 2 * (axis.upper - axis.lower));
  }
  const auto any_feasible = [&](double value) {
    return std::ranges::any_of(poses, [&](Pose<double> pose) {
      pose[static_cast<std::size_t>(fixed.coordinate)] = value;
      return shown.mechanism.inspect(design.parameters, pose, shown.mode, shown.limits).feasible;
    });
  };
  std::array<double, 2> range = {fixed.lower, fixed.lower};
  for (const int side : {0, 1})
    for (int k = 1; k <= kSteps; ++k) {
      const double value = fixed.lower + (side ? k : -k) * reach / kSteps;
      if (!any_feasible(value)) break;
      range[static_cast<std::size_t>(side)] = value;
    }
  return range;
}

/// Maximum number of motions per page. In a study with a front, each motion needs up to 0.7 MB of the page.
constexpr std::size_t kMaxMotions = 6;

/// The settings that the designs of a page share; `designs` is empty.
ShownDesigns prepare_designs(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                             const std::vector<DesignMotion>& motions, const PageDetail& detail = {}) {
  const MechanismInfo& info = mechanism.info();
  const std::size_t motion_count = std::min(motions.size(), kMaxMotions);
  return {.mechanism = mechanism,
          .plan = page_plan(info, plan, detail.cells),
          .limits = workspace_limits(info, plan.limits),
          .mode = mode.empty() ? info.modes.front() : mode,
          .motions = {motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(motion_count)},
          .omitted_motions = motions.size() - motion_count,
          .designs = {},
          .detail = detail};
}

/// A study uses masses if it computes a quantity of inertia or loads, selects a mass model other than the mechanism's
/// default, or sets or varies a mass. Otherwise its page does not show coupling.
bool uses_masses(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const Dynamics* const dynamics = parts.mechanism->dynamics();
  if (!dynamics) return false;
  if (dynamics->mass_model() != dynamics->mass_models().front() || parts.request.needs_inertia() ||
      std::ranges::any_of(parts.regions, [](const Region& region) { return region.request.needs_inertia(); }))
    return true;
  for (const auto* const entries : {&study.objectives, &study.constraints, &study.outputs})
    if (std::ranges::any_of(*entries, [](const StudyEntry& entry) { return entry.type.starts_with("peak-"); }))
      return true;
  const auto& infos = parts.mechanism->info().parameters;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const bool changed = parts.parameters[i] != infos[i].nominal || std::ranges::count(parts.varies, i) > 0;
    if (changed && infos[i].unit.starts_with("kg")) return true;
  }
  return false;
}

ShownDesigns prepare_study_designs(const PageStudy& page, const PageDetail& detail) {
  const DesignProblem& problem = *page.study->problem;
  const std::vector<double> best =
      page.contents.best.row < 0 ? problem.parts().parameters : problem.parameters(page.contents.best_design());
  const ProblemParts& parts = problem.of(best).parts();
  ShownDesigns shown = prepare_designs(*parts.mechanism, parts.plan, parts.request.mode, page.study->motions, detail);
  shown.coupling = uses_masses(*page.study);
  return shown;
}

void add_design(ShownDesigns& shown, const std::string& name, const std::vector<double>& parameters) {
  ShownDesign design{name, parameters, {}};
  try {
    design.workspace = workspace_fields(shown.mechanism, parameters, shown.plan, shown.mode);
    for (const auto& fixed : design.workspace->fixed)
      design.fixed_range.push_back(feasible_range(fixed, shown, design));
    if (!(design.workspace->volume > 0)) {
      design.workspace.reset();
      design.problem = "it has no feasible pose";
    }
  } catch (const DesignError& error) {
    design.workspace.reset();
    design.problem = message_of(error);
  }
  shown.designs.push_back(std::move(design));
}

/// Adds a design of a study. A page shows one mechanism: a design with other rows of the catalogues has another
/// mechanism, and is added without a workspace.
void add_design_of_study(ShownDesigns& shown, const DesignProblem& problem, const std::string& name,
                         const std::vector<double>& parameters) {
  if (problem.of(parameters).parts().mechanism.get() == &shown.mechanism) return add_design(shown, name, parameters);
  shown.designs.push_back({name, parameters, {}});
  shown.designs.back().problem = "its choice from a catalogue is not that of the best design";
}

/// Finds the solids whose measures are objectives, constraints or outputs of a study, each of them once. Solids over
/// other coordinates than those of the workspace are omitted.
std::vector<ShownSolid> largest_solids(const ProblemParts& parts, const WorkspacePlan& plan,
                                       const std::vector<double>& parameters) {
  std::vector<ShownSolid> solids;
  for (const NamedQuantity* const measure : solid_measures(parts)) {
    const LargestSolidFinder& finder = *measure->quantity->largest_solid();
    if (finder.sweep().swept != sweep_of(parts.mechanism->info(), plan).swept) continue;
    const LargestSolid found = finder.find(parameters);
    const auto is_same = [&](const ShownSolid& other) {
      return other.solid.centre == found.solid.centre && other.solid.dimensions == found.solid.dimensions;
    };
    if (found.volume > 0 && std::ranges::none_of(solids, is_same))
      solids.push_back({measure->name, finder.spec().shape, found.solid, finder.dimension_names(), found.volume});
  }
  return solids;
}

/// Finds the largest box and the largest cylinder of any proportions in a workspace over three lengths (the largest
/// rectangle over two); none over other coordinates.
std::vector<ShownSolid> workspace_sizes(const ShownDesigns& shown, const ShownDesign& design) {
  std::vector<ShownSolid> sizes;
  if (!design.workspace) return sizes;
  const std::vector<WorkspaceAxis>& axes = design.workspace->axes;
  if (axes.size() < 2 || std::ranges::any_of(axes, [](const WorkspaceAxis& axis) { return axis.unit != "m"; }))
    return sizes;
  for (const SolidKind kind : {SolidKind::cylinder, SolidKind::box}) {
    if (kind == SolidKind::cylinder && axes.size() < 3) continue;
    const Options options = default_options(largest_solid_options(kind));
    try {
      const SolidSpec spec = solid_spec(kind, shown.mechanism.info(), shown.plan, options);
      const LargestSolidFinder finder(shown.mechanism, shown.plan, spec, options.flag("regular"));
      const LargestSolid found = finder.find(design.parameters);
      if (found.volume > 0)
        sizes.push_back({spec.shape.name(), spec.shape, found.solid, finder.dimension_names(), found.volume});
    } catch (const std::invalid_argument&) {  // this plan or this design supports no solids: the page omits them
    }
  }
  return sizes;
}

}  // namespace

ShownDesigns evaluate_shown_designs(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  ShownDesigns shown = prepare_study_designs(page, {});
  if (contents.best.row >= 0)
    add_design(shown, best_design_label(contents), page.study->problem->parameters(contents.best_design()));
  if (page.study->baseline) add_design_of_study(shown, *page.study->problem, "baseline", *page.study->baseline);
  for (ShownDesign& design : shown.designs)
    if (design.workspace)
      design.solids = largest_solids(page.study->problem->of(design.parameters).parts(), shown.plan, design.parameters);
  if (!shown.designs.empty()) shown.designs.front().sizes = workspace_sizes(shown, shown.designs.front());
  return shown;
}

ShownDesigns evaluate_front_designs(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  ShownDesigns shown = prepare_study_designs(page, kFrontDetail);
  const auto last = std::ranges::find_if(contents.stages.rbegin(), contents.stages.rend(), &StageRecord::has_front);
  if (last == contents.stages.rend() || contents.problem.objectives.size() < 2) return shown;
  const std::vector<std::int64_t>& rows = last->front->rows;
  const std::int64_t stage = contents.stages.rend() - last;  // number of the stage, from 1
  for (const std::size_t point :
       select_representatives(scores_of(contents.problem.objectives, last->table, rows), kFrontDesigns)) {
    if (contents.best.stage == stage - 1 && contents.best.row == rows[point]) continue;
    add_design_of_study(shown, *page.study->problem,
                        "point " + std::to_string(point + 1) + " of stage " + std::to_string(stage),
                        page.study->problem->parameters(last->table.design(static_cast<std::size_t>(rows[point]))));
  }
  return shown;
}

ShownDesigns evaluate_shown_designs(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                                    const std::vector<DesignMotion>& motions,
                                    const std::pair<std::string, std::vector<double>>& design) {
  ShownDesigns shown = prepare_designs(mechanism, plan, mode, motions);
  add_design(shown, design.first, design.second);
  shown.designs.front().sizes = workspace_sizes(shown, shown.designs.front());
  return shown;
}

}  // namespace pkm
