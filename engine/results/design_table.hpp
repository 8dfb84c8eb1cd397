// Table that compares the best design with the rounded design, the baseline and published reference designs. It is
// shared by terminal and HTML output.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/results/comparison.hpp"

namespace pkm {

struct DesignTable {
  /// One design of the table. If the values in `record` were computed by voxels, `exact` contains those of the exact
  /// method.
  struct Column {
    std::string name;
    std::optional<DesignRecord> record, exact;
  };
  /// A line of the table: one quantity of all designs; std::nullopt where the value is unknown.
  struct Line {
    std::string kind;  ///< "variable", "objective", "output", "constraint" or "certified" (bounds of the volume)
    std::string name, unit, meaning;
    std::vector<std::optional<double>> values, published;  ///< values: one for each column; published: one for each
                                                           ///< reference design
    std::optional<Gain> gain;                              ///< gain of the first column over the baseline
  };
  std::vector<Column> columns;  ///< best design first, baseline last; empty while nothing has been evaluated
  std::vector<Line> lines;

  bool has_baseline() const { return !columns.empty() && columns.back().name == "baseline"; }
};

/// @param references  published designs ([[reference]] of the study)
DesignTable design_table(const StudyContents& contents, const std::vector<Reference>& references);

}  // namespace pkm
