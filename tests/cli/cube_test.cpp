// `pkmopt workspace --cube`, compared with an exhaustive search for the largest cube of cells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;

constexpr int kCells = 10;
const std::string kRobot = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";

class CliCube : public ::testing::Test {
 protected:
  json workspace(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"workspace", "--json", "--force"});
    const auto result = pkmopt(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json();
  }

  /// By cell: whether it is feasible and has at least this conditioning; the last axis varies fastest.
  std::vector<bool> good_cells(double conditioning) const {
    std::ifstream in(folder_.path() + "/cells.csv");
    std::vector<bool> good;
    std::string line, cell;
    std::getline(in, line);
    std::vector<std::string> names;
    for (std::istringstream head(line); std::getline(head, cell, ',');)
      names.push_back(cell.substr(0, cell.find(" [")));
    while (std::getline(in, line)) {
      std::map<std::string, std::string> row;
      std::istringstream cells(line);
      for (const std::string& name : names) std::getline(cells, row[name], ',');
      good.push_back(row["feasible"] == "1" && std::stod(row["conditioning"]) >= conditioning);
    }
    return good;
  }

  StudyFolder folder_;
};

/// Edge length [cells] of the largest cube of good cells in a cubic grid, by exhaustive search.
int longest_edge(const std::vector<bool>& good) {
  const auto fits = [&good](int i, int j, int k, int edge) {
    for (int a = i; a < i + edge; ++a)
      for (int b = j; b < j + edge; ++b)
        for (int c = k; c < k + edge; ++c)
          if (!good.at(static_cast<std::size_t>((a * kCells + b) * kCells + c))) return false;
    return true;
  };
  for (int edge = kCells; edge > 0; --edge)
    for (int i = 0; i + edge <= kCells; ++i)
      for (int j = 0; j + edge <= kCells; ++j)
        for (int k = 0; k + edge <= kCells; ++k)
          if (fits(i, j, k, edge)) return edge;
  return 0;
}

TEST_F(CliCube, EqualsAnExhaustiveSearch) {
  std::vector<double> sides;
  for (const double least : {0.0, 0.6}) {
    const json found =
        workspace({kRobot, "--cube", "--least", "conditioning=" + std::to_string(least), "--box",
                   "x=-0.4:0.4,y=-0.4:0.4,z=-0.8:0", "--cells", std::to_string(kCells), "--csv", "cells.csv"});
    const int edge = longest_edge(good_cells(least));
    EXPECT_GT(edge, 0);
    EXPECT_NEAR(found["cube"]["side"], 0.08 * edge, 1e-12);
    for (const auto& [name, range] : found["cube"]["box"].items()) {
      EXPECT_NEAR(double(range[1]) - double(range[0]), 0.08 * edge, 1e-12);
      EXPECT_NEAR(std::remainder(double(range[0]), 0.08), 0, 1e-12) << name;
    }
    sides.push_back(found["cube"]["side"]);
  }
  EXPECT_LT(sides[1], sides[0]);
}

TEST_F(CliCube, IsASquareInASliceWithNonSquareCells) {
  const json found = workspace(
      {"4ppa-2par", "--cut", "theta=0", "--box", "x=0.35:0.45,z=-0.9:-0.75", "--cells", "x=7,z=20,theta=1", "--cube"});
  EXPECT_NEAR(found["cube"]["side"], 0.1, 1e-12);  // all cells are feasible
  EXPECT_NEAR(found["cube"]["box"]["x"][0], 0.35, 1e-12);
  EXPECT_GT(found["cube"]["box"]["z"][0], -0.9);  // the central one of several squares
}

TEST_F(CliCube, IsNullWithoutGoodCellsAndRejectedForAngles) {
  EXPECT_EQ(workspace({kRobot, "--cube", "--least", "conditioning=1", "--cells", "8"})["cube"], nullptr);
  const auto error_of = [](std::vector<std::string> words) {
    words.insert(words.begin(), "workspace");
    const auto result = pkmopt(words);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_EQ(error_of({"4ppa-2par", "--cube"}),
            "pkmopt: --cube: found a workspace over x, z, theta; expected two or three lengths; --cut fixes an "
            "angle\n");
  EXPECT_THAT(error_of({kRobot, "--cube", "--least", "conditionin=1"}),
              ::testing::HasSubstr("--least: found the unknown name 'conditionin'"));
}

}  // namespace
}  // namespace pkm::testing
