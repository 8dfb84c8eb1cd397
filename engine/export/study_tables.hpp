// Exports a study file as CSV tables.
//
//   evaluations.csv  every evaluation: variables, objectives, margins (>= 0: constraint satisfied), outputs
//   generations.csv  per generation: evaluations and best design so far, feasible share, diversity, front indicators
//   populations.csv  the evaluations that form the population of each generation
//   best.csv         the best design, and the rounded design and the baseline if the study has them
//   front.csv        the Pareto fronts, for several objectives
//
// Numbers are in SI units with full precision; the header of a column contains its unit, "a [m]". `evaluation` counts
// the rows of each stage from 0, as in the study file; `stage` and `individual` count from 1, `generation` from 0.
#pragma once

#include <string>
#include <vector>

#include "engine/export/csv_table.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

struct NamedTable {
  std::string file_name;
  CsvTable table;
};

/// All tables of a study file. best.csv is omitted if nothing has been evaluated yet, front.csv if no stage has a
/// front.
std::vector<NamedTable> study_tables(const StudyContents& contents);

}  // namespace pkm
