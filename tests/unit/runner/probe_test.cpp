// Tests of probe(): number and choice of the sample designs, and the diagnosis.
#include "engine/runner/probe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

Study study(const std::string& workspace, const std::string& more = "") {
  return read_study_toml(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.3 }\nb = { min = 0.8, max = 1.0 }\n"
      "[workspace]\n" +
          workspace + "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n" + more,
      "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

TEST(Probe, EvaluatesTheSameDesignsEveryTime) {
  const std::string half = "[[constraint]]\ntype = \"linear\"\ncoefficients = { b = 1 }\nbound = 0.9\n";
  const Probe one = probe(study("", half)), two = probe(study("", half));
  EXPECT_EQ(one.table.designs, two.table.designs);
  EXPECT_EQ(one.table.size(), 64u);
  EXPECT_EQ(one.feasible(), 32u) << "half of the Sobol points lie in each half of a range";
  EXPECT_FALSE(one.diagnosis);
  EXPECT_EQ(describe_probe(one), "32 of 64 designs spread over the bounds are feasible");
}

TEST(Probe, EvaluatesFewerDesignsIfOneIsExpensive) {
  const auto size = [](const std::string& workspace, const std::string& more = "") {
    return probe_size(*study(workspace, more).problem);
  };
  const std::string conditioning = "[[output]]\ntype = \"conditioning\"\n";
  EXPECT_EQ(size("method = \"voxels\"\n"), 64u) << "the grid of the paper";
  EXPECT_EQ(size("method = \"voxels\"\n", conditioning), 7u) << "65280 cells with a pose quantity each";
  EXPECT_EQ(size("method = \"voxels\"\ncells = { x = 200, z = 200, theta = 100 }\n", conditioning), 4u);
  const Study huge = study("method = \"voxels\"\ncells = { x = 400, z = 400, theta = 400 }\n", conditioning);
  EXPECT_EQ(describe_probe(probe(huge)),
            "no sample designs were evaluated, because a single evaluation takes too long");
}

TEST(Probe, DiagnosesWhyNoDesignIsFeasible) {
  const Probe none = probe(study("", "[[constraint]]\ntype = \"conditioning\"\nmin = 0.9\n"));
  EXPECT_EQ(none.feasible(), 0u);
  ASSERT_TRUE(none.diagnosis);
  EXPECT_THAT(none.diagnosis->reasons.at(0).sentence, ::testing::StartsWith("no design satisfies conditioning"));
}

}  // namespace
}  // namespace pkm
