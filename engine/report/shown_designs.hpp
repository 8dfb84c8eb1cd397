// Evaluates the designs that a page shows: the input of the panels on workspace, mechanism, coupling and motions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "engine/workspace/solid.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// A study that a page shows.
struct PageStudy {
  std::string file;        ///< name of the study file
  StudyContents contents;  ///< contents of the study file
  /// The study built from the text in the file; std::nullopt if this program cannot read the text.
  std::optional<Study> study;
  std::string unreadable = {};  ///< the reason why this program cannot read the text; "" if it can
};

/// A largest solid in the workspace of a design, from an objective, constraint or output of its study.
struct ShownSolid {
  std::string name;  ///< name of the objective, constraint or output that measures the solid
  SolidShape shape;
  Solid solid;
  std::vector<std::string> dimension_names;  ///< names of the solid's dimensions, one for each
  double volume;                             ///< volume of the solid, or its area if it has two axes
};

/// A design with its workspace.
struct ShownDesign {
  std::string name;                          ///< name in the page, for example "best" or "baseline"
  std::vector<double> parameters;            ///< values of all parameters of the mechanism, in SI
  std::optional<WorkspaceFields> workspace;  ///< workspace of the design; std::nullopt if it has none, see `problem`
  /// For each fixed coordinate, the range around its value in which some poses of the workspace remain feasible.
  std::vector<std::array<double, 2>> fixed_range = {};
  std::string problem = {};             ///< reason why the design has no workspace; "" if it has one
  std::vector<ShownSolid> solids = {};  ///< largest solids in the workspace, if the study measures them
  std::vector<ShownSolid> sizes = {};   ///< largest box and cylinder of any proportions, as measures of the size
};

/// Resolution at which a page samples its designs.
struct PageDetail {
  std::int64_t cells = 40;  ///< maximum number of workspace cells along each axis
  std::size_t steps = 9;    ///< number of slider positions of each swept coordinate in the mechanism panel
  /// Number of slider positions of the first fixed coordinate; all other fixed coordinates keep their values.
  std::size_t fixed_steps = 7;
  bool joints = true;  ///< true: the fields of margins and joint positions are included
};

/// Designs of one mechanism that a page shows, all evaluated with the same plan.
struct ShownDesigns {
  const Mechanism& mechanism;
  WorkspacePlan plan;                 ///< plan of the workspace analysis: voxels, limited by `detail`
  LimitSpec limits;                   ///< limits that a pose must satisfy to be feasible
  std::string mode;                   ///< working mode
  std::vector<DesignMotion> motions;  ///< the first motions of the study, limited by the size of a page
  std::size_t omitted_motions = 0;    ///< number of motions of the study that are not shown
  std::vector<ShownDesign> designs;
  PageDetail detail = {};
  bool coupling = true;  ///< true if the page shows coupling and inertia; false if the study does not use masses
};

/// Evaluates the best design of a study (the compromise, for several objectives) and its baseline.
/// @param page  `study` must be set
ShownDesigns evaluate_shown_designs(const PageStudy& page);

/// Evaluates, at lower resolution, designs spread over the last Pareto front of a study. Their names are those of
/// `pkmopt show`, for example "point 7 of stage 2". The best design is omitted, because evaluate_shown_designs()
/// includes it. If there is no front, `designs` is empty.
ShownDesigns evaluate_front_designs(const PageStudy& page);

/// Evaluates one design without a study.
/// @param plan    plan of the workspace analysis; columns are replaced by voxels
/// @param mode    one of MechanismInfo::modes; "": the first
/// @param design  name of the design, and values of all parameters of the mechanism in SI
ShownDesigns evaluate_shown_designs(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                                    const std::vector<DesignMotion>& motions,
                                    const std::pair<std::string, std::vector<double>>& design);

}  // namespace pkm
