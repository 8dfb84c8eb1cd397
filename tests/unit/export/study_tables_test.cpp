// CSV tables of a study: agreement with the study file.
#include "engine/export/study_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using Lines = std::vector<std::vector<std::string>>;

/// Cells of a table, which must not contain quoted cells.
Lines lines_of(const std::vector<NamedTable>& tables, const std::string& name) {
  Lines lines;
  for (const NamedTable& table : tables) {
    if (table.file_name != name) continue;
    std::istringstream text(table.table.text());
    for (std::string line; std::getline(text, line);) {
      lines.emplace_back();
      std::istringstream cells(line + ",");
      for (std::string cell; std::getline(cells, cell, ',');) lines.back().push_back(cell);
    }
  }
  return lines;
}

/// Value of a cell; NaN if it is empty.
double value(const std::string& cell) { return cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr); }

void expect_equal(double cell, double number) {
  EXPECT_TRUE(cell == number || (std::isnan(cell) && std::isnan(number))) << cell << " is not " << number;
}

TEST(StudyTables, EvaluationsAreCompleteWithFullPrecision) {
  const StudyContents study = test::sample_study();
  const Lines lines = lines_of(study_tables(study), "evaluations.csv");
  ASSERT_EQ(lines.size(), 1 + 12 + 0 + 6u);
  EXPECT_EQ(lines[0], (std::vector<std::string>{"stage", "evaluation", "generation", "status", "a [m]", "b [m]",
                                                "objective workspace-ratio [rad/m]", "margin workspace-shape [m]",
                                                "margin rail-length [m]", "output conditioning"}));
  std::size_t line = 1;
  for (std::size_t s = 0; s < study.stages.size(); ++s) {
    const EvaluationTable& table = study.stages[s].table;
    for (std::size_t row = 0; row < table.size(); ++row, ++line) {
      const auto& cells = lines[line];
      ASSERT_EQ(cells.size(), lines[0].size());
      EXPECT_EQ(cells[0], std::to_string(s + 1));
      EXPECT_EQ(cells[1], std::to_string(row));
      EXPECT_EQ(cells[2], std::to_string(s == 0 ? row / 4 : row));
      EXPECT_EQ(cells[3], words(table.status[row]));
      expect_equal(value(cells[4]), table.design(row)[0]);
      expect_equal(value(cells[5]), table.design(row)[1]);
      expect_equal(value(cells[6]), table.objective_row(row)[0]);
      expect_equal(value(cells[7]), table.margin_row(row)[0]);
      expect_equal(value(cells[8]), table.margin_row(row)[1]);
      expect_equal(value(cells[9]), table.output_row(row)[0]);
    }
  }
}

TEST(StudyTables, GenerationsAndPopulationsReferToEvaluations) {
  const StudyContents study = test::sample_study();
  const Lines generations = lines_of(study_tables(study), "generations.csv");
  ASSERT_EQ(generations.size(), 1 + 3 + 6u);
  EXPECT_EQ(generations[2][1], "1");
  EXPECT_EQ(generations[2][2], "8");  // evaluations up to its end
  EXPECT_EQ(generations[2][3], "4");
  expect_equal(value(generations[2][4]), study.stages[0].table.objective_row(4)[0]);
  expect_equal(value(generations[2][8]), 0.5);  // hypervolume
  EXPECT_EQ(generations[4].back(), "");         // the stage has no front
  const Lines populations = lines_of(study_tables(study), "populations.csv");
  ASSERT_EQ(populations.size(), 1 + 12 + 6u);
  EXPECT_EQ(populations[6], (std::vector<std::string>{"1", "1", "2", "5"}));
}

TEST(StudyTables, BestTableHasBestDesignAndBaseline) {
  const Lines lines = lines_of(study_tables(test::sample_study()), "best.csv");
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0], (std::vector<std::string>{"kind", "name", "unit", "best", "baseline", "best_exact"}));
  EXPECT_EQ(lines[1], (std::vector<std::string>{"variable", "a", "m", "0.2", "0.1", "0.05"}));
  EXPECT_EQ(lines[3], (std::vector<std::string>{"parameter", "L0", "m", "2.5", "2.5", "2.5"}));
  EXPECT_EQ(lines[4], (std::vector<std::string>{"objective", "workspace-ratio", "rad/m", "0.19", "0.095", "0.0475"}));
  EXPECT_EQ(lines[6][3], "");  // NaN
  EXPECT_EQ(lines[8], (std::vector<std::string>{"workspace", "volume", "m^2 rad", "0.55", "0.275", "0.1375"}));
  EXPECT_EQ(lines[9], (std::vector<std::string>{"status", "status", "", "feasible", "failed", "feasible"}));
}

TEST(StudyTables, UnfinishedStudyHasTheBestDesignSoFar) {
  StudyContents study = test::sample_study();
  study.final.reset();
  const Lines lines = lines_of(study_tables(study), "best.csv");
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0], (std::vector<std::string>{"kind", "name", "unit", "best"}));
  expect_equal(value(lines[1][3]), study.stages[0].table.design(8)[0]);
  expect_equal(value(lines[3][3]), 2.5);
  expect_equal(value(lines[4][3]), study.stages[0].table.objective_row(8)[0]);
}

TEST(StudyTables, FrontTableHasKneesAndCompromise) {
  const StudyContents study = test::sample_study();
  const Lines lines = lines_of(study_tables(study), "front.csv");
  ASSERT_EQ(lines.size(), 1 + 3u);
  int compromises = 0;
  for (std::size_t point = 0; point < 3; ++point) {
    const std::int64_t row = study.stages[0].front->rows[point];
    EXPECT_EQ(lines[1 + point][1], std::to_string(point + 1));
    EXPECT_EQ(lines[1 + point][2], std::to_string(row));
    compromises += lines[1 + point][4] == "1";
    expect_equal(value(lines[1 + point][6]), study.stages[0].table.design(static_cast<std::size_t>(row))[0]);
  }
  EXPECT_EQ(compromises, 1);
}

TEST(StudyTables, TablesWithoutEvaluationsHaveOnlyHeaders) {
  StudyContents study = test::sample_study();
  study.stages.clear();
  study.final.reset();
  study.best = {};
  const auto tables = study_tables(study);
  ASSERT_EQ(tables.size(), 3u);
  for (const NamedTable& table : tables) EXPECT_EQ(lines_of(tables, table.file_name).size(), 1u) << table.file_name;
}

}  // namespace
}  // namespace pkm
