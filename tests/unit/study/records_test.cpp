// What the end of a study records: the best design, rounded, is what a reader expects or says what is wrong with it.
#include "engine/study/records.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "constraints/all.hpp"
#include "engine/mechanisms/all.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

/// A study of a and b within their bounds, rounded to `round`.
Study study(const std::string& a_bounds, const std::string& b_bounds, const std::string& round) {
  return read_study_toml(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = " + a_bounds + "\nb = " + b_bounds +
          "\n[workspace]\nmethod = \"voxels\"\ncells = { x = 8, z = 8, theta = 8 }\n[[objective]]\ntype = "
          "\"workspace-volume\"\n[[report]]\ntype = \"conditioning\"\n[[stage]]\noptimiser = \"ga\"\n[final]\nround "
          "= " +
          round + "\n",
      "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// The end of a study whose only evaluation is a design given by a and b.
FinalRecord end_of(const Study& study, double a, double b) {
  StudyContents contents = new_contents(study);
  contents.stages.push_back({"ga", {}, EvaluationTable(study.problem->shape())});
  EvaluationTable& table = contents.stages[0].table;
  table.extend(1);
  table.design(0)[0] = a;
  table.design(0)[1] = b;
  contents.best = {0, 0};
  return final_record(study, contents);
}

TEST(RoundedTo, GivesTheDecimalNumber) {
  EXPECT_EQ(rounded_to(0.7049, 0.01), 0.7);
  EXPECT_EQ(rounded_to(0.7051, 0.01), 0.71);
  EXPECT_EQ(rounded_to(0.69, 0.1), 0.7);
  EXPECT_EQ(rounded_to(-0.69, 0.1), -0.7);
  for (int i = 0; i <= 3000; ++i) EXPECT_EQ(rounded_to(i / 1000.0 + 4e-4, 0.001), i / 1000.0);
  EXPECT_EQ(rounded_to(1.2, 0.75), 1.5);  // no whole number of steps in 1
  EXPECT_EQ(rounded_to(13, 5), 15);
}

TEST(FinalRecord, RoundedDesignIsEvaluated) {
  const Study s = study("{ min = 0.15, max = 0.3 }", "{ min = 0.5, max = 1.5 }", "0.1");
  const FinalRecord f = end_of(s, 0.2049, 0.69);
  ASSERT_TRUE(f.rounded);
  EXPECT_EQ(f.rounded->parameters[0], 0.2);
  EXPECT_EQ(f.rounded->parameters[1], 0.7);
  EXPECT_EQ(f.rounded->parameters[2], f.best->parameters[2]);  // what does not vary is not rounded
  EXPECT_EQ(f.rounded->status, Status::feasible);
  EXPECT_EQ(f.rounded->reason, "");
  EXPECT_GT(f.rounded->objectives[0], 0);
}

TEST(FinalRecord, RoundedOutOfItsBoundsIsSaid) {
  const Study s = study("{ min = 0.15, max = 0.204 }", "{ min = 0.992, max = 1.5 }", "0.01");
  const FinalRecord one = end_of(s, 0.2, 0.994);
  EXPECT_EQ(one.rounded->parameters[1], 0.99);
  EXPECT_EQ(one.rounded->reason, "b = 0.99 m lies outside its bounds");
  EXPECT_EQ(one.rounded->status, Status::feasible);  // what was computed stands beside it
  EXPECT_GT(one.rounded->objectives[0], 0);
  const Study both = study("{ min = 0.15, max = 0.156 }", "{ min = 0.992, max = 1.5 }", "0.01");
  EXPECT_EQ(end_of(both, 0.156, 0.994).rounded->reason,
            "a = 0.16 m lies outside its bounds; b = 0.99 m lies outside its bounds");
  const Study edge = study("{ min = 0.15, max = 0.21 }", "{ min = 0.99, max = 1.5 }", "0.01");
  EXPECT_EQ(end_of(edge, 0.2099, 0.9901).rounded->reason, "");  // a bound belongs to the interval
}

TEST(FinalRecord, RoundedToNoMechanismIsNotEvaluated) {
  const Study s = study("{ min = 0.002, max = 0.3 }", "{ min = 0.5, max = 1.5 }", "0.01");
  const FinalRecord f = end_of(s, 0.004, 0.7);
  EXPECT_EQ(f.best->status, Status::feasible);
  EXPECT_EQ(f.rounded->status, Status::failed);
  EXPECT_EQ(f.rounded->reason, "a = 0 is outside the model's range 0.001 to 100 m");
  ASSERT_EQ(f.rounded->objectives.size(), 1u);
  EXPECT_TRUE(std::isnan(f.rounded->objectives[0]));
  ASSERT_EQ(f.rounded->reports.size(), 1u);
  EXPECT_TRUE(std::isnan(f.rounded->reports[0]));
}

}  // namespace
}  // namespace pkm
