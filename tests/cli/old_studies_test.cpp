// Interrupted studies of earlier versions of the program, one for each schema and algorithm version
// (tests/data/README.md). This program shows, reports, exports and evaluates them. It resumes those of its own
// algorithm version, with bit-identical results, and refuses to resume the others with a message that names both
// versions.
#include <gmock/gmock.h>

#include <fstream>
#include <set>

#include <nlohmann/json.hpp>

#include "engine/report/html_page.hpp"
#include "engine/runner/run_outcome.hpp"
#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

struct OldStudy {
  std::string name;
  std::int64_t algorithms;
  std::string program;
  std::vector<std::string> optimisers;  ///< of the stages that had begun; the last had not ended
};

void PrintTo(const OldStudy& study, std::ostream* out) { *out << study.name; }

const OldStudy kOldStudies[] = {{"interrupted-schema-1", 1, "0.1.0 (259d3de3a709)", {"ga", "ga"}},
                                {"interrupted-schema-2", 2, "0.1.0 (3640aaead440)", {"ga", "nlopt", "ipopt"}},
                                {"interrupted-schema-3", 3, "0.1.0 (cccc14640680)", {"nsga2", "nlopt"}},
                                {"interrupted-schema-4", 4, "0.1.0 (4c8ead2ce885)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-5", 5, "0.1.0 (eff2312a104b)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-6", 6, "0.1.0 (ae5686c4cc35)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-7", 7, "0.1.0 (4db1aebb6315+changes)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-8", 8, "0.1.0 (8d634649c855+changes)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-9", 9, "0.1.0 (ae6b4170b257)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-10", 10, "0.2.0 (414ccd7fc445+changes)", {"nsga2", "nlopt"}},
                                {"interrupted-algorithms-11", 11, "0.2.0 (de8f699445c8)", {"nsga2", "nlopt"}}};

class OldStudies : public StudyProgram, public ::testing::WithParamInterface<OldStudy> {
 protected:
  /// Copies the study file to s.h5, without any other file.
  void fetch(const std::string& name) const { fs::copy_file(PKM_TEST_DATA "/" + name, path("s.h5")); }
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename());
    return names;
  }
  Json json(const std::vector<std::string>& arguments) {
    EXPECT_EQ(run(arguments), 0) << output_;
    return Json::parse(output_);
  }
};

TEST_P(OldStudies, AreShown) {
  const OldStudy& old = GetParam();
  fetch(old.name + ".h5");
  const StudyContents file = read("s.h5");
  EXPECT_EQ(file.state, StudyState::interrupted);
  EXPECT_EQ(file.algorithms, old.algorithms);

  ASSERT_EQ(run({"show", "s.h5"}), 0) << output_;
  EXPECT_THAT(output_, StartsWith(file.name + ": interrupted, " + std::to_string(file.evaluations()) + " evaluations"));
  EXPECT_THAT(output_, Not(HasSubstr("cannot read the study's text")));

  const Json shown = json({"show", "s.h5", "--json"});
  EXPECT_EQ(shown["state"], "interrupted");
  EXPECT_EQ(shown["program"], old.program);
  EXPECT_EQ(shown["evaluations"], file.evaluations());
  ASSERT_EQ(shown["stages"].size(), old.optimisers.size());
  for (std::size_t i = 0; i < old.optimisers.size(); ++i) {
    EXPECT_EQ(shown["stages"][i]["optimiser"], old.optimisers[i]);
    EXPECT_EQ(shown["stages"][i]["evaluations"], file.stages[i].table.size());
    EXPECT_EQ(shown["stages"][i]["finished"], i + 1 < old.optimisers.size());
    EXPECT_EQ(shown["stages"][i].value("starts", Json::array()).size(), file.stages[i].starts.size());
    EXPECT_EQ(shown["stages"][i].contains("optimality"), old.optimisers.size() == 3 && i == 1);  // once it has ended
    EXPECT_EQ(shown["stages"][i].contains("front"), old.optimisers[i] == "nsga2");
  }
  const EvaluationTable& table = file.stages[static_cast<std::size_t>(file.best.stage)].table;
  const auto row = static_cast<std::size_t>(file.best.row);
  for (std::size_t i = 0; i < file.problem.variables.size(); ++i)
    EXPECT_EQ(shown["best"]["design"][file.problem.variables[i].name], table.design(row)[i]);
}

class OldStudiesOfEverySchema : public OldStudies {};

TEST_P(OldStudiesOfEverySchema, AreReportedAndExported) {
  fetch(GetParam().name + ".h5");
  ASSERT_EQ(run({"export", "s.h5", "--csv", ".", "--vtk", "best.vtkhdf"}), 0) << output_;
  const std::string rows = slurp("evaluations.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 1 + read("s.h5").evaluations());
  EXPECT_TRUE(fs::exists(path("best.vtkhdf")));
  try {
    page_assets();
  } catch (const std::exception& reason) {
    GTEST_SKIP() << reason.what();
  }
  ASSERT_EQ(run({"report", "s.h5"}), 0) << output_;
  EXPECT_THAT(slurp("s.html"), HasSubstr("\"name\":\"" + read("s.h5").name + "\""));
}

// Between algorithm versions, values may differ by rounding errors only.
TEST_P(OldStudies, EvaluatingADesignReproducesTheRecordedValues) {
  fetch(GetParam().name + ".h5");
  const StudyContents file = read("s.h5");
  const StageRecord& stage = file.stages[0];
  const std::size_t generation = stage.generations.size() - 1;
  const auto row = static_cast<std::size_t>(stage.generations.population_of(generation)[0]);
  ASSERT_EQ(stage.table.status[row], Status::feasible);
  const Json evaluated = json({"evaluate", "--from", "s.h5", "--stage", "1", "--generation", std::to_string(generation),
                               "--individual", "1", "--json"});
  EXPECT_EQ(evaluated["feasible"], true);
  EXPECT_GE(evaluated["parameters"].size(), file.problem.parameters.size());  // mechanisms may have new parameters
  for (const ParameterRecord& parameter : file.problem.parameters)
    if (parameter.variable < 0) {
      EXPECT_EQ(evaluated["parameters"][parameter.name], parameter.value) << parameter.name;
    }
  for (std::size_t i = 0; i < file.problem.variables.size(); ++i)
    EXPECT_EQ(evaluated["parameters"][file.problem.variables[i].name], stage.table.design(row)[i]);
  const auto expect = [&](const char* kind, const auto& infos, std::span<const double> recorded) {
    ASSERT_EQ(evaluated[kind].size(), infos.size());
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const double tolerance = file.algorithms == kAlgorithms ? 0 : 1e-12 * std::abs(recorded[i]);
      EXPECT_NEAR(evaluated[kind][infos[i].name].template get<double>(), recorded[i], tolerance) << infos[i].name;
    }
  };
  expect("objectives", file.problem.objectives, stage.table.objective_row(row));
  expect("constraints", file.problem.margins, stage.table.margin_row(row));
}

class OldStudiesOfOtherVersions : public OldStudies {};

TEST_P(OldStudiesOfOtherVersions, CannotBeResumed) {
  const OldStudy& old = GetParam();
  fetch(old.name + ".h5");
  const std::string before = slurp("s.h5");
  for (std::vector<std::string> arguments :
       {std::vector<std::string>{"resume", "s.h5"}, {"resume", "s.h5", "--generations", "50"}}) {
    EXPECT_EQ(run(arguments), 1);
    EXPECT_EQ(output_, "pkmopt: s.h5: written by pkmopt " + old.program + " with algorithm version " +
                           std::to_string(old.algorithms) + "; this program has version " +
                           std::to_string(kAlgorithms) + " and would not reproduce it\n");
  }
  EXPECT_EQ(slurp("s.h5"), before);
  EXPECT_EQ(files(), (std::set<std::string>{"s.h5", "output.txt"}));
}

class OldStudiesOfThisVersion : public OldStudies {};

// The reference study was run without interruption by the original program.
TEST_P(OldStudiesOfThisVersion, ResumedGiveTheResultOfTheOriginalProgram) {
  const std::string number = std::to_string(GetParam().algorithms);
  const StudyContents straight = read_study(PKM_TEST_DATA "/straight-algorithms-" + number + ".h5");
  ASSERT_EQ(straight.state, StudyState::finished);
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{"--threads", "1"}, {"--threads", "3", "--instruction-set", "baseline"}}) {
    fs::remove(path("s.h5"));
    fetch(GetParam().name + ".h5");
    ASSERT_LT(read("s.h5").evaluations(), straight.evaluations());
    std::vector<std::string> arguments = {"resume", "s.h5", "--quiet"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    ASSERT_EQ(run(arguments), 0) << output_;
    EXPECT_EQ(first_difference(straight, read("s.h5")), "") << how[1] << " threads";
    EXPECT_THAT(slurp("s.h5"), StartsWith("pkmopt-study schema=5 "));
  }
}

std::string name_of_version(const ::testing::TestParamInfo<OldStudy>& info) {
  return "Version" + std::to_string(info.param.algorithms);
}

/// The studies of this program's algorithm version, or the others.
std::vector<OldStudy> studies(bool of_this_version) {
  std::vector<OldStudy> found;
  for (const OldStudy& study : kOldStudies)
    if ((study.algorithms == kAlgorithms) == of_this_version) found.push_back(study);
  return found;
}

INSTANTIATE_TEST_SUITE_P(Every, OldStudies, ::testing::ValuesIn(kOldStudies), name_of_version);
INSTANTIATE_TEST_SUITE_P(Every, OldStudiesOfEverySchema,
                         ::testing::Values(kOldStudies[0], kOldStudies[1], kOldStudies[2], kOldStudies[3],
                                           *std::rbegin(kOldStudies)),
                         name_of_version);
INSTANTIATE_TEST_SUITE_P(Refused, OldStudiesOfOtherVersions, ::testing::ValuesIn(studies(false)), name_of_version);
INSTANTIATE_TEST_SUITE_P(Resumed, OldStudiesOfThisVersion, ::testing::ValuesIn(studies(true)), name_of_version);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OldStudiesOfThisVersion);  // a new version has no files yet

}  // namespace
}  // namespace pkm::testing
