// The tables of a study file for other programs.
//
//   evaluations.csv  every evaluation: what varied, objectives, margins (>= 0 holds), reports
//   generations.csv  what was known after each generation
//   populations.csv  which evaluations made up each generation's population
//   best.csv         the best design, and beside it, as far as the study has them, the rounded one and the baseline
//   front.csv        the trade-offs, where there are several objectives
//
// Numbers are SI in full precision; a column's unit is in its header, "a [m]". `evaluation` counts each stage's rows
// from 0, as the study file does, `stage` and `individual` from 1, `generation` from 0.
#pragma once

#include <string>
#include <vector>

#include "engine/report/csv_table.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

struct NamedTable {
  std::string file_name;
  CsvTable table;
};

/// best.csv is left out while nothing is evaluated, front.csv where there is none.
std::vector<NamedTable> study_tables(const StudyContents& contents);

}  // namespace pkm
