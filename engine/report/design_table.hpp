// The best design beside the others of its study and beside published ones: the table that every account of a study
// shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/report/standing.hpp"
#include "engine/setup/study.hpp"

namespace pkm {

struct DesignTable {
  /// A design: "best" (name_of_best), and the same on exact columns where there are both.
  struct Column {
    std::string name;
    std::optional<DesignRecord> record, exact;
  };
  /// What is said of every design; none where a design or a reference does not know it.
  struct Line {
    std::string kind;  ///< "variable", "objective", "report", "constraint" or "certain" (of the volume)
    std::string name, unit, meaning;
    std::vector<std::optional<double>> values, published;  ///< of the columns, of the references
    std::optional<Gain> gain;                              ///< of the first column over the baseline
  };
  std::vector<Column> columns;  ///< none while nothing is evaluated; the baseline is the last
  std::vector<Line> lines;

  bool has_baseline() const { return !columns.empty() && columns.back().name == "baseline"; }
};

/// @param references  what was published
DesignTable design_table(const StudyContents& contents, const std::vector<Reference>& references);

}  // namespace pkm
