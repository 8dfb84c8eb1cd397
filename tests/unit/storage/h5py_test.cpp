// Our writer against a trusted reader, and our reader against a trusted writer: two equal mistakes of ours would
// cancel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/storage/file_seal.hpp"
#include "engine/storage/study_file.hpp"
#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/storage/python_output.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::bits;
using ::testing::HasSubstr;

class H5py : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "python3-h5py is missing";
    write_study(path_, test::sample_study());
  }
  std::string python(const std::string& command, const std::string& more = "") const {
    return test::python_output("read_study.py", command + " '" + path_ + "' " + more);
  }
  void seal_again() const {
    std::string bytes = test::slurp(path_);
    seal(bytes, kStudySchema);
    test::spill(path_, bytes);
  }

  test::Folder folder_;
  std::string path_ = folder_ / "s.h5";
};

TEST_F(H5py, ReadsTheSameBits) {
  const StudyContents study = test::sample_study();
  const EvaluationTable& table = study.stages[0].table;
  EXPECT_EQ(python("values"), "design (12, 2)" + bits(table.designs) +              //
                                  "\nobjective (12, 1)" + bits(table.objectives) +  //
                                  "\nmargin (12, 2)" + bits(table.margins) +        //
                                  "\nreport (12, 1)" + bits(table.reports) + R"(
status [0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3]
generation [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2]
population [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]
columns ['workspace-shape', 'rail-length']
format pkmopt-study
schema 5
seed 18364758544493064720
name Größe, 4PPa-2PaR <b>
lower [0.1, 0.35]
best True
map (1, 2, 3) ['x', 'z', 'theta']
)" + "toml " + std::to_string(study.toml.size() - 2) +
                                  "\n");  // two letters take two bytes
}

TEST_F(H5py, FindsUnitDescriptionAndLayoutEverywhere) { EXPECT_THAT(python("labels"), HasSubstr(" datasets\n")); }

TEST_F(H5py, FindsTheNamesOfMoreColumnsThanAnAttributeHolds) {
  for (const std::size_t count : {4000u, 4001u, 5000u}) {
    StudyContents study = test::sample_study();
    study.problem.margins.clear();
    for (std::size_t i = 0; i < count; ++i) study.problem.margins.push_back({"m" + std::to_string(i), "m", ""});
    study.stages.clear();
    study.stages.push_back(test::sample_stage(study.problem.shape(), 2, 3));
    study.final.reset();
    study.best = {};
    write_study(path_, study);
    EXPECT_EQ(first_difference(read_study(path_), study), "") << count;
    EXPECT_THAT(python("labels"), HasSubstr(" datasets\n"));
    const std::string margin = "/stages/1/evaluations/margin";
    EXPECT_EQ(python("wide", margin), (count <= 4000 ? "attribute" : margin + "_columns") + " " +
                                          std::to_string(count) + " m0 m" + std::to_string(count - 1) + "\n");
  }
}

TEST_F(H5py, RunsTheSnippetsOfTheDocumentation) {
  EXPECT_THAT(python("snippets", "'" + std::string(PKM_TEST_DATA) + "/../../engine/storage/README.md'"),
              testing::EndsWith("\n4 snippets\n"));
}

TEST_F(H5py, OpensEmptyStudies) {
  write_study(path_, StudyContents{});
  EXPECT_THAT(python("labels"), HasSubstr(" datasets\n"));
}

TEST_F(H5py, ChangesAreNoticed) {
  ASSERT_EQ(python("remove", "/toml"), "");
  EXPECT_THAT(test::storage_error([&] { read_study(path_); }), HasSubstr("its checksum differs"));
}

TEST_F(H5py, WritesWhatWeRead) {
  ASSERT_EQ(python("contiguous"), "");
  seal_again();
  EXPECT_EQ(first_difference(read_study(path_), test::sample_study()), "");
}

TEST_F(H5py, AMissingPartIsNamed) {
  ASSERT_EQ(python("remove", "/stages/1/evaluations/margin"), "");
  seal_again();
  EXPECT_THAT(test::storage_error([&] { read_study(path_); }),
              testing::StartsWith(path_ + ": not laid out as schema 5 says (/stages/1/evaluations/margin: "));
}

TEST_F(H5py, AnIndexThatPointsNowhereIsNamed) {
  ASSERT_EQ(python("put", "/stages/1/generations/population 5 12"), "");
  seal_again();
  EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
            path_ + ": not laid out as schema 5 says (/stages/1: population holds what is no row of evaluations)");
}

TEST_F(H5py, AFrontThatPointsNowhereIsNamed) {
  ASSERT_EQ(python("put", "/stages/1/front/row 1 12"), "");
  seal_again();
  EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
            path_ + ": not laid out as schema 5 says (/stages/1: the front holds what is no row of evaluations)");
}

TEST_F(H5py, APartOfAnotherSizeIsNamed) {
  ASSERT_EQ(python("shorten", "/stages/1/evaluations/seconds"), "");
  seal_again();
  EXPECT_EQ(
      test::storage_error([&] { read_study(path_); }),
      path_ + ": not laid out as schema 5 says (/stages/1/evaluations/seconds: has 11 values, but 12 are expected)");
}

TEST_F(H5py, WhatPkmoptNeverWritesIsRefused) {
  const std::string rows = "/stages/1/evaluations/objective: ";
  for (const auto& [kind, reason] : {std::pair<std::string, std::string>{"soft", rows + "is a link to another place"},
                                     {"link", rows + "is a link to another place"},
                                     {"unread", "/best/design: is a link to another place"},
                                     {"external", rows + "has its values in another file"},
                                     {"virtual", rows + "is a view of other datasets"},
                                     {"filter", rows + "is packed by a filter that pkmopt does not use"},
                                     {"type", rows + "has values of another type"},
                                     {"huge", rows + "is larger than the values that the file holds"},
                                     {"count", "/stages@count: is 4294967296, but it has 3 stages"},
                                     {"variable", "/problem/parameters: two parameters have one variable"},
                                     {"cells", "/final/best: has more feasible cells than cells, or fewer than 0"}}) {
    write_study(path_, test::sample_study());
    ASSERT_EQ(python("forge", kind), "") << kind;
    seal_again();
    EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
              path_ + ": not laid out as schema 5 says (" + reason + ")")
        << kind;
  }
}

}  // namespace
}  // namespace pkm
