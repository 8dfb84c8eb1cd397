// The numbers that a survey gives, by the names under which expressions know them.
#pragma once

#include <string>
#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

struct SurveyResult {
  std::string name;
  std::string meaning;
  std::string (*unit)(const MechanismInfo&, const SurveyPlan&);
  bool (*available)(const Mechanism&);           ///< whether the mechanism's surveys can give it
  void (*demand)(const EntryContext&, Demand&);  ///< adds what the survey has to compute
  double (*value)(const Survey<double>&, Scratch&);
  /// With derivatives; a worst case by its smooth stand-in of that sharpness.
  Dual4 (*smooth)(const Survey<Dual4>&, double sharpness, Scratch&);
  bool has_stand_in = false;
};

/// Every result there is: one entry each.
const std::vector<SurveyResult>& survey_results();

}  // namespace pkm
