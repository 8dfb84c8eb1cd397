// Exports a study file as CSV tables.
//
//   evaluations.csv  every evaluation: variables, objectives, margins (>= 0: constraint satisfied), outputs
//   generations.csv  per generation: evaluations and best design so far, feasible share, diversity, front indicators
//   populations.csv  the evaluations that form the population of each generation
//   best.csv         the best design, and the rounded design and the baseline if the study has them
//   front.csv        the Pareto fronts, for several objectives
//
// Numbers are SI in full precision; a column's unit is in its header, "a [m]". `evaluation` counts each stage's rows
// from 0, as the study file does, `stage` and `individual` from 1, `generation` from 0.
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

/// best.csv is omitted while nothing has been evaluated, front.csv if no stage has a front.
std::vector<NamedTable> study_tables(const StudyContents& contents);

}  // namespace pkm
