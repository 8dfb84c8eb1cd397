// The voxels that picture the workspace of a study, whichever way it surveys it.
#pragma once

#include "engine/mechanism/plan.hpp"

namespace pkm {

/// The plan itself, if it counts voxels, else voxels with the same limits and box; on one value of the held coordinate:
/// the plan's, or the design's middle where it integrates.
/// @param cells  for a plan of columns, which has none
inline SurveyPlan picture_plan(const SurveyPlan& plan, const std::array<std::int64_t, 3>& cells) {
  SurveyPlan picture = plan;
  if (plan.method == Method::columns) {
    picture.method = Method::voxels;
    picture.cells = cells;
  }
  picture.held_values.clear();
  if (plan.held.kind == HeldCoordinate::Kind::integrated) picture.held.kind = HeldCoordinate::Kind::middle;
  return picture;
}

}  // namespace pkm
