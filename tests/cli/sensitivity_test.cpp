// `pkmopt evaluate --sensitivity` and `--tolerance`: derivatives and worst cases, compared with evaluated designs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

json evaluated(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"evaluate", "4ppa-2par", "--json"});
  const auto result = pkmopt(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.json();
}

TEST(CliSensitivity, EqualFiniteDifferences) {
  const json derivatives = evaluated({"--sensitivity"})["sensitivities"];
  const std::pair<std::string, double> parameters[] = {{"a", 0.2}, {"l_u", 0.6}, {"b", 0.8}};
  for (const auto& [name, value] : parameters) {
    const double step = 1e-6;
    const auto at = [&, &parameter = name, nominal = value](double off) {
      return evaluated({"--set", parameter + "=" + std::to_string(nominal + off)})["objectives"];
    };
    const json above = at(step), below = at(-step);
    for (const char* objective : {"workspace-volume", "workspace-ratio", "conditioning"}) {
      const double difference = (double(above[objective]) - double(below[objective])) / (2 * step);
      EXPECT_NEAR(derivatives[objective][name], difference, 1e-5 * (1 + std::fabs(difference)))
          << objective << ' ' << name;
    }
  }
  EXPECT_EQ(derivatives["workspace-volume"]["kappa"], 0);  // an inertia
}

TEST(CliSensitivity, TableIsSortedByInfluence) {
  const auto text = pkmopt({"evaluate", "4ppa-2par", "--sensitivity"}).out;
  const auto begin = text.find("\nsensitivities: derivatives with all other parameters fixed\n");
  ASSERT_NE(begin, std::string::npos) << text;
  EXPECT_THAT(text.substr(begin), HasSubstr("workspace-volume [m^2 rad]"));
  EXPECT_THAT(text.substr(begin), ::testing::Not(HasSubstr("  R_u ")));  // has no influence
  EXPECT_LT(text.find("\n  l_d ", begin), text.find("\n  d ", begin));
}

TEST(CliTolerance, FirstOrderWorstCaseAgreesWithTheEvaluatedCorner) {
  const json found = evaluated({"--tolerance", "0.1mm", "--sensitivity"});
  EXPECT_EQ(found["tolerance"]["a"], 1e-4);
  EXPECT_EQ(found["tolerance"]["m_p"], 0);  // not a length
  for (const auto& [name, worst] : found["worst_case"].items()) {
    double change = 0;
    for (const auto& [parameter, derivative] : found["sensitivities"][name].items())
      change += std::fabs(double(derivative)) * double(found["tolerance"][parameter]);
    EXPECT_NEAR(std::fabs(double(worst["first_order"]) - double(worst["nominal"])), change, 1e-12) << name;
    // the difference is of second order in the tolerance, which is 1e-4 of the lengths
    EXPECT_NEAR(worst["evaluated"], worst["first_order"], 0.02 * change) << name;
  }
  const json& volume = found["worst_case"]["workspace-volume"];
  EXPECT_LT(volume["evaluated"], volume["nominal"]);  // is maximised
  const json& dci = found["worst_case"]["dci"];
  EXPECT_GT(dci["evaluated"], dci["nominal"]);  // is minimised
}

TEST(CliTolerance, ByNameOfTheParameter) {
  const json found = evaluated({"--tolerance", "a=0.1mm"});
  EXPECT_EQ(found["tolerance"]["a"], 1e-4);  // a tolerance may be below the lower bound of its parameter
  EXPECT_EQ(found["tolerance"]["b"], 0);
  const double nominal = found["worst_case"]["workspace-volume"]["nominal"];
  EXPECT_NE(found["worst_case"]["workspace-volume"]["evaluated"], nominal);
}

TEST(CliTolerance, IncludesMarginsOfAStudy) {
  const StudyFolder folder;
  folder.write("s.toml", study_with("[[constraint]]\ntype = \"rail-length\"\n"));
  const json found = pkmopt({"evaluate", "s.toml", "--tolerance", "1mm", "--json"}, folder.path()).json();
  const json& margin = found["worst_case"]["rail-length margin"];
  EXPECT_EQ(margin["nominal"], found["constraints"]["rail-length"]);
  EXPECT_LT(margin["evaluated"], margin["nominal"]);
}

TEST(CliTolerance, InvalidTolerancesAreRefused) {
  const auto refusal = [](const std::vector<std::string>& words) {
    const auto result = pkmopt(words);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(refusal({"evaluate", "4ppa-2par", "--cells", "8", "--sensitivity"}),
              HasSubstr("pkmopt: --sensitivity: needs derivatives, but "));
  EXPECT_EQ(refusal({"evaluate", "4ppa-2par", "--tolerance", "1kg"}),
            "pkmopt: --tolerance: found '1kg'; expected a length, an angle, or tolerances by name such as a=0.1mm\n");
  EXPECT_EQ(refusal({"evaluate", "4ppa-2par", "--tolerance", "a=-1mm"}),
            "pkmopt: --tolerance: found -0.001; expected a tolerance >= 0\n");
}

}  // namespace
}  // namespace pkm::testing
