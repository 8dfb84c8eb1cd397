// Evaluates the designs that a page shows: the input of the panels on workspace, mechanism, coupling and motions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// A study, as input of a page.
struct PageStudy {
  std::string file;             ///< name of the study file
  StudyContents contents;       ///< everything in the file
  std::optional<Study> study;   ///< built from the text in the file; std::nullopt if this program cannot read the text
  std::string unreadable = {};  ///< why this program cannot read the text
};

/// A design with its workspace.
struct ShownDesign {
  std::string name;                          ///< "best", "baseline"
  std::vector<double> parameters;            ///< all parameters of the mechanism, SI
  std::optional<WorkspaceFields> workspace;  ///< std::nullopt if the design has none, see `problem`
  /// Per fixed coordinate: the range around its value in which some poses of the workspace remain feasible.
  std::vector<std::array<double, 2>> fixed_range = {};
  std::string problem = {};  ///< why there is no workspace
};

/// Resolution at which a page samples its designs.
struct PageDetail {
  std::int64_t cells = 40;      ///< maximum number of workspace cells per axis
  std::size_t steps = 9;        ///< slider positions of each swept coordinate, for the drawn poses
  std::size_t fixed_steps = 7;  ///< slider positions of the first fixed coordinate; the others keep their values
  bool joints = true;           ///< includes the fields of margins and joint positions
};

/// Designs of one mechanism, evaluated with the same plan.
struct ShownDesigns {
  const Mechanism& mechanism;
  WorkspacePlan plan;                ///< plan of the workspace analysis: voxels, limited by `detail`
  LimitSpec limits;                  ///< limits of poses
  std::string mode;                  ///< working mode
  std::vector<NamedMotion> motions;  ///< the first motions of the study, limited by the size of a page
  std::size_t omitted_motions = 0;   ///< number of motions of the study that are not shown
  std::vector<ShownDesign> designs;
  PageDetail detail = {};
  bool coupling = true;  ///< whether the page shows coupling and inertia; false if the study does not use masses
};

/// Evaluates the best design of a study (the compromise, for several objectives) and its baseline.
/// @param page  `study` must be set
ShownDesigns evaluate_shown_designs(const PageStudy& page);

/// Evaluates, at lower resolution, designs spread over the last Pareto front of a study, named "point 7 of stage 2" in
/// the numbering of `pkmopt show`. The best design is omitted, because evaluate_shown_designs() has it. Without a front
/// `designs` is empty.
ShownDesigns evaluate_front_designs(const PageStudy& page);

/// Evaluates one design, without a study.
/// @param plan    plan of the workspace analysis; columns are replaced by voxels
/// @param mode    one of MechanismInfo::modes; "": the first
/// @param design  its name, and all parameters of the mechanism in SI
ShownDesigns evaluate_shown_designs(const Mechanism& mechanism, const WorkspacePlan& plan, const std::string& mode,
                                    const std::vector<NamedMotion>& motions,
                                    const std::pair<std::string, std::vector<double>>& design);

}  // namespace pkm
