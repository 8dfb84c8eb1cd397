// Compares writer and reader with h5py: h5py reads files that pkmopt has written, and pkmopt reads files that h5py has
// written. Without an independent program, equal errors in writer and reader would cancel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "engine/storage/file_header.hpp"
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
  std::string python(const std::string& command, const std::string& arguments = "") const {
    return test::python_output("read_study.py", command + " '" + path_ + "' " + arguments);
  }
  /// Updates the header of the file, so that its checksum is correct again.
  void update_header() const {
    std::string bytes = test::slurp(path_);
    seal(bytes, kStudySchema);
    test::spill(path_, bytes);
  }

  test::Folder folder_;
  std::string path_ = folder_ / "s.h5";
};

TEST_F(H5py, ReadsIdenticalBits) {
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
                                  "\n");  // in UTF-8 two characters take two bytes
}

TEST_F(H5py, FindsUnitDescriptionAndLayoutEverywhere) { EXPECT_THAT(python("labels"), HasSubstr(" datasets\n")); }

TEST_F(H5py, FindsColumnNamesThatDoNotFitIntoAnAttribute) {
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

TEST_F(H5py, RunsTheExamplesOfTheDocumentation) {
  EXPECT_THAT(python("snippets", "'" + std::string(PKM_TEST_DATA) + "/../../docs/reference/study-file/reading.md'"),
              testing::EndsWith("\n4 snippets\n"));
}

TEST_F(H5py, ReadsEmptyStudies) {
  write_study(path_, StudyContents{});
  EXPECT_THAT(python("labels"), HasSubstr(" datasets\n"));
}

TEST_F(H5py, ChangesAreDetectedByTheChecksum) {
  ASSERT_EQ(python("remove", "/toml"), "");
  EXPECT_THAT(test::storage_error([&] { read_study(path_); }), HasSubstr("its checksum differs"));
}

TEST_F(H5py, WritesFilesThatPkmoptReads) {
  ASSERT_EQ(python("contiguous"), "");
  update_header();
  EXPECT_EQ(first_difference(read_study(path_), test::sample_study()), "");
}

TEST_F(H5py, ErrorNamesAMissingDataset) {
  ASSERT_EQ(python("remove", "/stages/1/evaluations/margin"), "");
  update_header();
  EXPECT_THAT(test::storage_error([&] { read_study(path_); }),
              testing::StartsWith(path_ + ": does not conform to schema 5 (/stages/1/evaluations/margin: "));
}

TEST_F(H5py, ErrorNamesAnIndexOutOfRange) {
  ASSERT_EQ(python("put", "/stages/1/generations/population 5 12"), "");
  update_header();
  EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
            path_ + ": does not conform to schema 5 (/stages/1: generations: population: row index out of range)");
}

TEST_F(H5py, ErrorNamesAFrontIndexOutOfRange) {
  ASSERT_EQ(python("put", "/stages/1/front/row 1 12"), "");
  update_header();
  EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
            path_ + ": does not conform to schema 5 (/stages/1: front: row index out of range)");
}

TEST_F(H5py, ErrorNamesADatasetOfWrongSize) {
  ASSERT_EQ(python("shorten", "/stages/1/evaluations/seconds"), "");
  update_header();
  EXPECT_EQ(
      test::storage_error([&] { read_study(path_); }),
      path_ + ": does not conform to schema 5 (/stages/1/evaluations/seconds: has 11 values, but 12 are expected)");
}

TEST_F(H5py, EverythingThatPkmoptNeverWritesIsRejected) {
  const std::string rows = "/stages/1/evaluations/objective: ";
  for (const auto& [kind, reason] : {std::pair<std::string, std::string>{"soft", rows + "is a soft or external link"},
                                     {"link", rows + "is a soft or external link"},
                                     {"unread", "/best/design: is a soft or external link"},
                                     {"external", rows + "has its values in another file"},
                                     {"virtual", rows + "is a virtual dataset"},
                                     {"filter", rows + "is compressed by a filter that pkmopt does not use"},
                                     {"type", rows + "has values of another type"},
                                     {"huge", rows + "declares more values than the file contains"},
                                     {"count", "/stages@count: is 4294967296, but the group has 3 stages"},
                                     {"variable", "/problem/parameters: two parameters have the same variable"},
                                     {"cells", "/final/best: feasible_cells is negative or larger than cells"}}) {
    write_study(path_, test::sample_study());
    ASSERT_EQ(python("forge", kind), "") << kind;
    update_header();
    EXPECT_EQ(test::storage_error([&] { read_study(path_); }),
              path_ + ": does not conform to schema 5 (" + reason + ")")
        << kind;
  }
}

}  // namespace
}  // namespace pkm
