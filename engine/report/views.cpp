#include "engine/report/views.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/problem/front.hpp"
#include "engine/report/standing.hpp"
#include "engine/report/thinning.hpp"
#include "engine/survey/picture_plan.hpp"

namespace pkm {
namespace {

constexpr std::size_t kFrontDesigns = 10;               // that a page carries beside the best
constexpr PageDetail kFrontDetail = {16, 5, 3, false};  // of those

/// Voxels of the study's workspace, at most as many as a page can carry.
SurveyPlan page_plan(const MechanismInfo& info, const SurveyPlan& plan, std::int64_t most) {
  SurveyPlan picture = picture_plan(info, plan, {most, most, most});
  for (std::int64_t& cells : std::get<VoxelOptions>(picture.method).cells) cells = std::min(cells, most);
  return picture;
}

/// How far a held coordinate can move from the workspace's value until none of some feasible poses is feasible.
std::array<double, 2> range_of(const WorkspaceAxis& held, const Views& views, const View& view) {
  constexpr std::size_t kPoses = 100;
  constexpr int kSteps = 60;
  const WorkspaceFields& workspace = *view.workspace;
  const std::vector<std::size_t> cells = workspace.feasible_cells();
  std::vector<Pose<double>> poses;
  for (const std::size_t i : Thinning(cells.size(), kPoses).indices) poses.push_back(workspace.pose(cells[i]));

  double reach = std::numbers::pi;  // of a rotation; of a length twice the workspace's largest extent
  if (held.unit == "m") {
    reach = 0;
    for (const WorkspaceAxis& axis : workspace.axes)
      if (axis.unit == "m") reach = std::fmax(reach, 2 * (axis.upper - axis.lower));
  }
  const auto any_feasible = [&](double value) {
    return std::ranges::any_of(poses, [&](Pose<double> pose) {
      pose[static_cast<std::size_t>(held.coordinate)] = value;
      return views.mechanism.inspect(view.parameters, pose, views.mode, views.limits).feasible;
    });
  };
  std::array<double, 2> range = {held.lower, held.lower};
  for (const int side : {0, 1})
    for (int k = 1; k <= kSteps; ++k) {
      const double value = held.lower + (side ? k : -k) * reach / kSteps;
      if (!any_feasible(value)) break;
      range[static_cast<std::size_t>(side)] = value;
    }
  return range;
}

/// A motion of a study with a front takes up to 0.7 MB of the page.
constexpr std::size_t kMaxMotions = 6;

Views no_views(const Mechanism& mechanism, const SurveyPlan& plan, const std::string& mode,
               const std::vector<NamedMotion>& motions, const PageDetail& detail = {}) {
  const MechanismInfo& info = mechanism.info();
  const std::size_t shown = std::min(motions.size(), kMaxMotions);
  return {.mechanism = mechanism,
          .plan = page_plan(info, plan, detail.cells),
          .limits = survey_limits(info, plan.limits),
          .mode = mode.empty() ? info.modes.front() : mode,
          .motions = {motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(shown)},
          .motions_left_out = motions.size() - shown,
          .designs = {},
          .detail = detail};
}

/// A study asks for coupling where it computes something of inertia or loads, or says anything about masses.
bool names_masses(const Study& study) {
  const ProblemParts& parts = study.problem->parts();
  const Dynamics* const dynamics = parts.mechanism->dynamics();
  if (!dynamics) return false;
  if (dynamics->mass_model() != dynamics->mass_models().front() || parts.demand.needs_inertia() ||
      std::ranges::any_of(parts.regions, [](const Region& region) { return region.demand.needs_inertia(); }))
    return true;
  for (const auto* const entries : {&study.objectives, &study.constraints, &study.reports})
    if (std::ranges::any_of(*entries, [](const StudyEntry& entry) { return entry.type.starts_with("peak-"); }))
      return true;
  const auto& known = parts.mechanism->info().parameters;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const bool changed = parts.parameters[i] != known[i].nominal || std::ranges::count(parts.varies, i) > 0;
    if (changed && known[i].unit.starts_with("kg")) return true;
  }
  return false;
}

Views views_of_study(const PageStudy& page, const PageDetail& detail) {
  const ProblemParts& parts = page.study->problem->parts();
  Views views = no_views(*parts.mechanism, parts.plan, parts.demand.mode, page.study->motions, detail);
  views.coupling = names_masses(*page.study);
  return views;
}

void add_view(Views& views, const std::string& name, const std::vector<double>& parameters) {
  View view{name, parameters, {}};
  try {
    view.workspace = workspace_fields(views.mechanism, parameters, views.plan, views.mode);
    for (const WorkspaceAxis& held : view.workspace->held) view.held_range.push_back(range_of(held, views, view));
    if (!(view.workspace->volume > 0)) {
      view.workspace.reset();
      view.problem = "it has no feasible pose";
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {  // not a mechanism, a mass that is not positive, ...
    view.workspace.reset();
    view.problem = message_of(error);
  }
  views.designs.push_back(std::move(view));
}

}  // namespace

Views views_of(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Views views = views_of_study(page, {});
  if (contents.best.row >= 0)
    add_view(views, name_of_best(contents), page.study->problem->parameters(contents.best_design()));
  if (page.study->baseline) add_view(views, "baseline", *page.study->baseline);
  return views;
}

Views front_views_of(const PageStudy& page) {
  const StudyContents& contents = page.contents;
  Views views = views_of_study(page, kFrontDetail);
  const auto last = std::ranges::find_if(contents.stages.rbegin(), contents.stages.rend(), &StageRecord::has_front);
  if (last == contents.stages.rend() || contents.problem.objectives.size() < 2) return views;
  const std::vector<std::int64_t>& rows = last->front->rows;
  const std::int64_t stage = contents.stages.rend() - last;  // from 1
  for (const std::size_t point :
       spread_choice(scores_of(contents.problem.objectives, last->table, rows), kFrontDesigns)) {
    if (contents.best.stage == stage - 1 && contents.best.row == rows[point]) continue;
    add_view(views, "point " + std::to_string(point + 1) + " of stage " + std::to_string(stage),
             page.study->problem->parameters(last->table.design(static_cast<std::size_t>(rows[point]))));
  }
  return views;
}

Views views_of(const Mechanism& mechanism, const SurveyPlan& plan, const std::string& mode,
               const std::vector<NamedMotion>& motions, const std::pair<std::string, std::vector<double>>& design) {
  Views views = no_views(mechanism, plan, mode, motions);
  add_view(views, design.first, design.second);
  return views;
}

}  // namespace pkm
