// Studies with several objectives, run by the built program: two studies of experiments/ killed and resumed, the output
// of `show` and `evaluate` for a Pareto front, and incompatible settings.
#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "engine/problem/front.hpp"
#include "tests/cli/study_program.hpp"
#include "tests/unit/optimisers/dominates.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

class ParetoFrontProgram : public StudyProgram {
 protected:
  static std::string experiment(const std::string& name) {
    std::ifstream in(std::string(PKM_EXPERIMENTS) + "/" + name);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  static void replace(std::string& text, const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  }
  void write(const std::string& text) const { std::ofstream(folder_ + "/study.toml") << text; }

  /// The study of experiments/, shorter, with a checkpoint after every generation.
  static std::string volume_conditioning() {
    std::string text = experiment("4ppa-2par/volume-conditioning.toml");
    replace(text, "population = 100", "population = 40");
    replace(text, "generations = 100", "generations = 20");
    replace(text, "starts = 12", "starts = 4");
    return text + "[checkpoint]\nevery = 0\n";
  }
  static std::string volume_coupling_force() {
    std::string text = experiment("3crr-r-cru/volume-coupling-force.toml");
    replace(text, "population = 120", "population = 24");
    replace(text, "generations = 60", "generations = 8");
    replace(text, "starts = 9", "starts = 3\nevaluations = 30");
    return text + "[checkpoint]\nevery = 0\n";
  }
  Json show(const std::string& file) {
    EXPECT_EQ(run({"show", file, "--json"}), 0) << output_;
    return Json::parse(output_);
  }
  /// The message with which `check` refuses the text.
  std::string refusal(const std::string& text) {
    write(text);
    EXPECT_EQ(run({"check", "study.toml"}), 2);
    return output_;
  }
};

TEST_F(ParetoFrontProgram, VolumeAgainstConditioningKilledAnywhereEndsTheSame) {
  write(volume_conditioning());
  kill_at_random(2, 1);
}

TEST_F(ParetoFrontProgram, ThreeObjectivesKilledAnywhereEndTheSame) {
  write(volume_coupling_force());
  kill_at_random(2, 2);
}

TEST_F(ParetoFrontProgram, ThreadsAndExtensionsDoNotMatter) {
  std::string text = volume_conditioning();
  text.erase(text.find("[[stage]]                                     # points"));
  write(text);
  ASSERT_EQ(run({"run", "study.toml", "--output", "one.h5", "--threads", "1", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"run", "study.toml", "--output", "two.h5", "--threads", "2", "--quiet"}), 0) << output_;
  EXPECT_EQ(first_difference(read("one.h5"), read("two.h5")), "");
  ASSERT_EQ(run({"resume", "two.h5", "--generations", "30", "--quiet"}), 0) << output_;
  replace(text, "generations = 20", "generations = 30");
  write(text);
  ASSERT_EQ(run({"run", "study.toml", "--output", "straight.h5", "--quiet"}), 0) << output_;
  const StudyContents extended = read("two.h5"), straight = read("straight.h5");
  EXPECT_EQ(extended.stages[0].front->rows, straight.stages[0].front->rows);
  EXPECT_EQ(extended.stages[0].front->hypervolume, straight.stages[0].front->hypervolume);
}

TEST_F(ParetoFrontProgram, ShowsFrontsAndEvaluatesTheirPoints) {
  write(volume_conditioning());
  ASSERT_EQ(run({"run", "study.toml", "--output", "f.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("best workspace-ratio"));
  EXPECT_THAT(output_, HasSubstr("compromise"));
  EXPECT_THAT(output_, HasSubstr("of the front of stage 1"));
  EXPECT_THAT(output_, HasSubstr("with reference point workspace-ratio 0 rad, conditioning 0"));

  const Json printed = show("f.h5");
  const StudyContents contents = read("f.h5");
  for (std::size_t s = 0; s < 2; ++s) {
    const Json& front = printed["stages"][s]["front"];
    const StageRecord& stage = contents.stages[s];
    ASSERT_EQ(front["points"].size(), stage.front->rows.size());
    double before = 1e300;
    for (std::size_t i = 0; i < front["points"].size(); ++i) {
      const auto row = static_cast<std::size_t>(stage.front->rows[i]);
      EXPECT_EQ(front["points"][i]["objectives"]["conditioning"], stage.table.objective_row(row)[1]);
      EXPECT_EQ(front["points"][i]["design"]["l_d"], stage.table.design(row)[3]);
      EXPECT_EQ(stage.table.status[row], Status::feasible);
      EXPECT_LT(stage.table.objective_row(row)[0], before);  // sorted by the first objective, best first
      before = stage.table.objective_row(row)[0];
    }
  }
  EXPECT_EQ(printed["stages"][0]["front"]["generations"]["hypervolume"].back(),
            printed["stages"][0]["front"]["hypervolume"]);
  EXPECT_EQ(printed["stages"][0]["front"]["reference"], (Json{{"workspace-ratio", 0.0}, {"conditioning", 0.0}}));

  for (const auto& [stage, point] : {std::pair{1, 7}, {2, 2}}) {
    ASSERT_EQ(run({"evaluate", "--from", "f.h5", "--stage", std::to_string(stage), "--front", std::to_string(point),
                   "--json"}),
              0)
        << output_;
    const Json evaluated = Json::parse(output_);
    const Json& stored =
        printed["stages"][static_cast<std::size_t>(stage - 1)]["front"]["points"][static_cast<std::size_t>(point - 1)];
    EXPECT_EQ(evaluated["objectives"], stored["objectives"]);
    EXPECT_EQ(evaluated["constraints"], stored["constraints"]);
  }
  ASSERT_EQ(run({"evaluate", "--from", "f.h5", "--front", "2", "--json"}), 0) << output_;  // of the last stage
  EXPECT_EQ(Json::parse(output_)["objectives"], printed["stages"][1]["front"]["points"][1]["objectives"]);
  ASSERT_EQ(run({"evaluate", "--from", "f.h5", "--json"}), 0) << output_;  // the compromise
  EXPECT_EQ(Json::parse(output_)["objectives"], printed["best"]["objectives"]);
  for (const Json& point : printed["stages"][1]["front"]["points"])
    EXPECT_EQ(point["marks"].dump().find("compromise") != std::string::npos,
              point["objectives"] == printed["best"]["objectives"]);
}

TEST_F(ParetoFrontProgram, RefinedPointsDominateTheirStarts) {
  write(volume_conditioning());
  ASSERT_EQ(run({"run", "study.toml", "--output", "f.h5", "--quiet"}), 0) << output_;
  const StudyContents contents = read("f.h5");
  const StageRecord &evolved = contents.stages[0], &refined = contents.stages[1];
  ASSERT_EQ(refined.starts.size(), 4u);
  int optimal = 0;
  for (const StartOutcome& start : refined.starts) {
    const auto from = refined.table.objective_row(static_cast<std::size_t>(start.first_row));
    const auto to = refined.table.objective_row(static_cast<std::size_t>(start.end_row));
    EXPECT_GE(to[0], from[0]);
    EXPECT_GE(to[1], from[1]);
    EXPECT_EQ(refined.table.status[static_cast<std::size_t>(start.end_row)], Status::feasible);
    optimal += start.optimality < 1e-6;
    EXPECT_LT(start.optimality, 0.1);
  }
  EXPECT_GE(optimal, 3);  // of four; a final design may be at a kink of the quadrature of the conditioning
  // No evolved design dominates a refined one.
  const auto& objectives = contents.problem.objectives;
  const Scores a = scores_of(objectives, evolved.table, evolved.front->rows);
  const Scores b = scores_of(objectives, refined.table, refined.front->rows);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) EXPECT_FALSE(dominates(a[i], b[k], 2)) << i << ' ' << k;
}

TEST_F(ParetoFrontProgram, RefusesIncompatibleSettings) {
  const std::string good = volume_conditioning();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    replace(text, from, to);
    return refusal(text);
  };
  std::string one = good;
  replace(one, "[[objective]]\ntype = \"conditioning\"", "[[output]]\ntype = \"conditioning\"");
  replace(one, "reference", "# reference");
  EXPECT_THAT(refusal(one),
              HasSubstr("the optimiser nsga2 needs 2 objectives, but the study has one (workspace-ratio)"));
  EXPECT_THAT(changed("optimiser = \"nsga2\"\npopulation = 40\ngenerations = 20\nreference", "optimiser = \"ga\"\n#"),
              HasSubstr("the optimiser ga handles 1 objective, but the study has 2 (workspace-ratio, conditioning)"));
  EXPECT_THAT(changed(", conditioning = 0 }", " }"),
              HasSubstr("a value for every objective: workspace-ratio, conditioning"));
  EXPECT_THAT(changed("conditioning = 0 }", "conditionin = 0 }"), HasSubstr("did you mean 'conditioning'?"));
  EXPECT_THAT(changed("start = \"pareto\"", "start = \"best\""), HasSubstr("handles 1 objective, but the study has 2"));
  EXPECT_THAT(changed("start = \"pareto\"", "start = \"best\""), HasSubstr("set start = \"pareto\" for several"));
  EXPECT_THAT(changed("\"slsqp\"", "\"lbfgs\""), HasSubstr("handles no constraints"));
  EXPECT_THAT(changed("start = \"pareto\"", "start = \"pareto\"\nobjective = \"conditioning\""),
              HasSubstr("it needs start = \"pareto\" with scalarisation = \"epsilon-constraint\""));
  EXPECT_THAT(changed("start = \"pareto\"", "start = \"pareto\"\nobjective = \"volume\""),
              HasSubstr("one of workspace-ratio, conditioning"));
  std::string first = good;
  first.erase(first.find("[[stage]]\noptimiser = \"nsga2\""),
              first.find("[[stage]]         ") - first.find("[[stage]]\n"));
  EXPECT_THAT(refusal(first), HasSubstr("needs a [[stage]] before it that finds a front, such as nsga2"));
}

TEST_F(ParetoFrontProgram, SeedsAreComparedByHypervolumesWithOneReferencePoint) {
  std::string text = volume_conditioning();
  text.erase(text.find("[[stage]]                                     # points"));
  write(text);
  ASSERT_EQ(run({"run", "study.toml", "--seeds", "2", "--digits", "10"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("hypervolume"));
  char value[40];
  std::snprintf(value, sizeof value, "%.10g", read("study-seed-1.h5").stages[0].front->hypervolume.back());
  EXPECT_THAT(output_, HasSubstr(value));
  replace(text, "reference", "# reference");
  write(text);
  ASSERT_EQ(run({"run", "study.toml", "--seeds", "2", "--force", "--digits", "10"}), 0) << output_;
  std::snprintf(value, sizeof value, "%.10g", read("study-seed-1.h5").stages[0].front->hypervolume.back());
  EXPECT_THAT(output_, Not(HasSubstr(value)));  // each seed has its own reference point
  EXPECT_THAT(output_, HasSubstr("2 of 2 seeds ended feasible"));
}

TEST_F(ParetoFrontProgram, RefusesPointsThatDoNotExist) {
  std::string text = volume_conditioning();
  text.erase(text.find("[[stage]]                                     # points"));
  write(text);
  ASSERT_EQ(run({"run", "study.toml", "--output", "f.h5", "--quiet"}), 0) << output_;
  const std::size_t count = read("f.h5").stages[0].front->rows.size();
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "evaluate");
    EXPECT_EQ(run(arguments), 2);
    return output_;
  };
  EXPECT_THAT(refused({"--from", "f.h5", "--front", "0"}),
              HasSubstr("--front: found 0; expected a point of the front of stage 1, 1 to " + std::to_string(count)));
  EXPECT_THAT(refused({"--from", "f.h5", "--front", "1", "--stage", "2"}),
              HasSubstr("--stage: found 2; expected a stage with a front: 1"));
  EXPECT_THAT(refused({"--from", "f.h5", "--stage", "1"}), HasSubstr("--stage: --front or --generation is missing"));
  EXPECT_THAT(refused({"4ppa-2par", "--front", "1"}), HasSubstr("--front: found no --from"));
  EXPECT_THAT(refused({"4ppa-2par", "--from", "f.h5"}), HasSubstr("'4ppa-2par' together with --from"));
  EXPECT_THAT(refused({}), HasSubstr("expected a mechanism, a file in TOML or --from F.h5"));
}

}  // namespace
}  // namespace pkm::testing
