// Designs to be looked at: what the sections on workspace, mechanism, coupling and motions are made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/report/workspace_fields.hpp"
#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// A study as a page is given it.
struct PageStudy {
  std::string file;             ///< as it is called
  StudyContents contents;       ///< all that the file holds
  std::optional<Study> study;   ///< built from the text in the file; none: this program cannot read it ...
  std::string unreadable = {};  ///< ... and why
};

/// A design with its workspace.
struct View {
  std::string name;                                    ///< "best", "baseline"
  std::vector<double> parameters;                      ///< all of the mechanism's
  std::optional<WorkspaceFields> workspace;            ///< none: the design has none, see `problem`
  std::vector<std::array<double, 2>> held_range = {};  ///< of each held one, where poses of the workspace stay feasible
  std::string problem = {};                            ///< why there is no workspace, in a sentence
};

/// How finely a page samples its designs.
struct PageDetail {
  std::int64_t cells = 40;     ///< of the workspace, at most, per axis
  std::size_t steps = 9;       ///< of each coordinate that the workspace sweeps over, for poses that are drawn
  std::size_t held_steps = 7;  ///< of the first that it holds; the others stay where they are
  bool joints = true;          ///< fields of margins and joints beside those of quantities
};

/// Designs of one mechanism, under the same plan.
struct Views {
  const Mechanism& mechanism;
  SurveyPlan plan;   ///< of voxels, few enough for a page
  LimitSpec limits;  ///< of poses
  std::string mode;
  std::vector<NamedMotion> motions;  ///< the first ones, few enough for a page
  std::size_t motions_left_out = 0;  ///< further ones
  std::vector<View> designs;
  PageDetail detail = {};
  bool coupling = true;  ///< whether anybody asked for what follows from inertia
};

/// The best design of a study (the compromise where there are several objectives) and its baseline, evaluated again.
/// @param page  of a study that this program can read
Views views_of(const PageStudy& page);

/// Designs spread over the last trade-off of a study, named "point 7 of stage 2" as `pkmopt show` numbers them, in less
/// detail. Without the best design, which views_of() shows; none where there is no trade-off.
Views front_views_of(const PageStudy& page);

/// One design, without a study's results.
/// @param plan    as of a study
/// @param mode    one of MechanismInfo::modes
/// @param design  its name, and all of the mechanism's parameters
Views views_of(const Mechanism& mechanism, const SurveyPlan& plan, const std::string& mode,
               const std::vector<NamedMotion>& motions, const std::pair<std::string, std::vector<double>>& design);

}  // namespace pkm
