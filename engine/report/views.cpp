#include "engine/report/views.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <numbers>
#include <stdexcept>

#include "engine/core/error.hpp"
#include "engine/report/standing.hpp"
#include "engine/report/thinning.hpp"
#include "engine/survey/picture_plan.hpp"

namespace pkm {
namespace {

constexpr std::int64_t kMostCells = 40;  // per axis of a page

/// Voxels of the study's workspace, at most as many as a page can carry.
SurveyPlan page_plan(const MechanismInfo& info, const SurveyPlan& plan) {
  SurveyPlan picture = picture_plan(info, plan, {kMostCells, kMostCells, kMostCells});
  for (std::int64_t& cells : std::get<VoxelOptions>(picture.method).cells) cells = std::min(cells, kMostCells);
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

Views no_views(const Mechanism& mechanism, const SurveyPlan& plan, const std::string& mode,
               const std::vector<NamedMotion>& motions) {
  const MechanismInfo& info = mechanism.info();
  return {mechanism,
          page_plan(info, plan),
          survey_limits(info, plan.limits),
          mode.empty() ? info.modes.front() : mode,
          motions,
          {}};
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
  const ProblemParts& parts = page.study->problem->parts();
  Views views = no_views(*parts.mechanism, parts.plan, parts.demand.mode, page.study->motions);
  if (contents.best.row >= 0)
    add_view(views, name_of_best(contents), page.study->problem->parameters(contents.best_design()));
  if (page.study->baseline) add_view(views, "baseline", *page.study->baseline);
  return views;
}

Views views_of(const Mechanism& mechanism, const SurveyPlan& plan, const std::string& mode,
               const std::vector<NamedMotion>& motions, const std::pair<std::string, std::vector<double>>& design) {
  Views views = no_views(mechanism, plan, mode, motions);
  add_view(views, design.first, design.second);
  return views;
}

}  // namespace pkm
