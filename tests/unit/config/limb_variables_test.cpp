// Variables of single limbs: patterns such as "arm*.l_b", and copies of a parameter that are tied together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/catalogue.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::limb_variables {
namespace {

using pkm::testing::all_catalogues;
using ::testing::AllOf, ::testing::ElementsAre, ::testing::HasSubstr;

const std::string kBounds = "= { min = 0.4, max = 0.6 }\n", kTied = "= { min = 0.4, max = 0.6, tie = true }\n";

Study study_of(const SourceText& file, const std::string& variables, const std::string& more = "") {
  return read_study_toml("[mechanism]\nfile = \"" + file.file_name + "\"\n" + more + "[variables]\n" + variables +
                             "[workspace]\nmethod = \"columns\"\ntolerance = 1e-6\n[[objective]]\ntype = "
                             "\"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n",
                         "s.toml", all_catalogues(), file);
}
Study delta(const std::string& variables) {
  return study_of({test::text_of_mechanism("rotary-delta"), "rotary-delta.toml"}, variables);
}
/// A Delta robot whose file gives arm2 and arm3 rods of other lengths than arm1.
Study asymmetric(const std::string& variables, const std::string& more = "") {
  return study_of({test::text_of_file(PKM_TEST_DATA "/robots/asymmetric-delta.toml"), "asymmetric-delta.toml"},
                  variables, more);
}

std::vector<std::string> variables_of(const Study& study) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < study.problem->parts().space.dimension(); ++i)
    names.push_back(study.problem->parts().space[i].name);
  return names;
}
double value_of(const Study& study, const std::vector<double>& parameters, const std::string& name) {
  const auto& known = study.problem->parts().mechanism->info().parameters;
  return parameters[static_cast<std::size_t>(find_named(known, name) - known.data())];
}

std::string complaint(const std::string& variables) {
  try {
    delta(variables);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LimbVariables, APatternIsOneVariablePerLimb) {
  EXPECT_THAT(variables_of(delta("\"arm*.l_b\" " + kBounds)), ElementsAre("arm1.l_b", "arm2.l_b", "arm3.l_b"));
  EXPECT_THAT(variables_of(delta("\"arm*\".l_b " + kBounds + "l_a = { min = 0.2, max = 0.3 }\n")),
              ElementsAre("l_a", "arm1.l_b", "arm2.l_b", "arm3.l_b"));
  const Study study = delta("\"arm2.l_b\" = { min = 0.5, max = 0.55 }\n\"*.l_b\" " + kBounds);
  EXPECT_THAT(variables_of(study), ElementsAre("arm2.l_b", "arm1.l_b", "arm3.l_b"));
  EXPECT_EQ(study.problem->parts().space[0].lower, 0.5);
  EXPECT_EQ(study.problem->parts().space[1].lower, 0.4);
  EXPECT_THAT(variables_of(delta("\"arm*.l_b\" " + kTied)), ElementsAre("l_b"));
}

TEST(LimbVariables, TiedCopiesHaveOneValue) {
  const std::vector<double> design = {0.5};
  const auto lengths = [&](const Study& study) {
    const std::vector<double> all = study.problem->parameters(design);
    return std::vector{value_of(study, all, "l_b"), value_of(study, all, "arm2.l_b"), value_of(study, all, "arm3.l_b")};
  };
  EXPECT_THAT(lengths(asymmetric("l_b " + kBounds)), ElementsAre(0.5, 0.47, 0.54));
  EXPECT_THAT(lengths(asymmetric("l_b " + kTied)), ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(lengths(asymmetric("\"arm*.l_b\" " + kTied)), ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(lengths(asymmetric("l_b " + kTied, "parameters = { arm3.l_b = 0.52 }\n")), ElementsAre(0.5, 0.5, 0.52));
  EXPECT_THAT(lengths(asymmetric("\"arm2.l_b\" " + kBounds)), ElementsAre(0.5, 0.5, 0.54));
}

/// The derivative by a tied variable is the sum of those by its copies.
TEST(LimbVariables, DerivativesByTiedVariables) {
  const Study tied = asymmetric("l_b " + kTied), separate = asymmetric("\"arm*.l_b\" " + kBounds);
  const auto derivatives = [](const Study& study, const std::vector<double>& design) {
    return study.problem->derivatives(study.problem->parameters(design), study.problem->parts().varies);
  };
  const std::vector<double> sum = derivatives(tied, {0.5}), parts = derivatives(separate, {0.5, 0.5, 0.5});
  EXPECT_NEAR(sum[0], parts[0], 1e-6 * parts[0]);
  EXPECT_NEAR(sum[1], parts[1] + parts[2] + parts[3], 1e-4 * std::fabs(sum[1]));
  const double step = 1e-4;
  const auto volume = [&](double length) { return derivatives(tied, {length})[0]; };
  EXPECT_NEAR(sum[1], (volume(0.5 + step) - volume(0.5 - step)) / (2 * step), 1e-3 * std::fabs(sum[1]));
}

TEST(LimbVariables, MistakesAreExplained) {
  EXPECT_THAT(complaint("\"leg*.l_b\" " + kBounds),
              AllOf(HasSubstr("s.toml:4: variables.leg*.l_b"), HasSubstr("arm1.l_b")));
  EXPECT_THAT(complaint("\"arm*.l_c\" " + kBounds), AllOf(HasSubstr("unknown parameter"), HasSubstr("l_a")));
  EXPECT_THAT(complaint("\"arm*\" " + kBounds), HasSubstr("\"arm*.l_b\""));
  EXPECT_THAT(complaint("\"arm1.l_*\" " + kBounds), HasSubstr("only the limb"));
  EXPECT_THAT(complaint("\"arm1*.l_b\" " + kTied), AllOf(HasSubstr("omits arm2.l_b")));
  EXPECT_THAT(complaint("l_b " + kBounds + "\"arm*.l_b\" " + kTied), HasSubstr("is a variable already"));
  EXPECT_THAT(complaint("\"arm*.l_b\" " + kBounds + "\"*1.l_b\" " + kBounds), HasSubstr("matches two patterns"));
  EXPECT_THAT(complaint("\"arm2.l_b\" " + kTied), HasSubstr("is a single copy"));
}

}  // namespace
}  // namespace pkm::limb_variables
