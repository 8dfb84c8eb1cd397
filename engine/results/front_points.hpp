// Notable points of a recorded Pareto front (best in an objective, knee, compromise), and its hypervolume.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/problem/front.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Labels of the notable points, by index of the point: "best conditioning", "knee", "compromise".
/// @param front  not empty
std::vector<std::vector<std::string>> point_labels(const ProblemRecord& problem, const Scores& front);

/// Hypervolume of the front with respect to the stage's reference point; NaN if there is none.
double hypervolume_of(const ProblemRecord& problem, const StageRecord& stage, const Scores& front);

/// Final hypervolume of the front that the last evolutionary stage found. std::nullopt if the study does not specify
/// its reference point: hypervolumes with different reference points cannot be compared.
std::optional<double> evolved_hypervolume(const Study& study, const StudyContents& contents);

}  // namespace pkm
