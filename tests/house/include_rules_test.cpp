// The rules of tests/house/include_rules.hpp, on made-up text and on every source of the repository.
#include "tests/house/include_rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace pkm::house {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(IncludeRules, AllowWhatTheHouseAllows) {
  EXPECT_THAT(broken_rules("engine/problem/problem.hpp",
                           "#include <Eigen/Core>\n#include <span>\n"
                           "#include \"engine/problem/evaluation.hpp\"\n"
                           "#include \"engine/core/parameter.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(broken_rules("engine/storage/study_lock.cpp", "#include <hdf5.h>\n#include <sys/file.h>\n"), IsEmpty());
  EXPECT_THAT(broken_rules("objectives/ratio.cpp", "#include \"engine/problem/quantity.hpp\"\n"), IsEmpty());
  EXPECT_THAT(broken_rules("experiments/app/main.cpp",
                           "#include <CLI/CLI.hpp>\n#include \"constraints/all.hpp\"\n"
                           "#include \"engine/study/run.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(
      broken_rules("engine/setup/mechanism_file.cpp", "#include \"engine/mechanisms/described/mechanism.hpp\"\n"),
      IsEmpty());
  EXPECT_THAT(broken_rules("experiments/app/print.hpp", "#include <nlohmann/json.hpp>\n"), IsEmpty());
  EXPECT_THAT(broken_rules("tests/unit/a_test.cpp", "#include <ceres/jet.h>\n#include \"tests/unit/b.hpp\"\n"),
              IsEmpty());
}

TEST(IncludeRules, FindALayerThatLooksUp) {
  EXPECT_THAT(broken_rules("engine/core/a.hpp", "int x;\n  #  include \"engine/math/scalar.hpp\"  // why\n"),
              ElementsAre("engine/core/a.hpp includes engine/math/scalar.hpp: engine/core comes before engine/math"));
  EXPECT_THAT(broken_rules("engine/study/a.cpp", "#include \"engine/report/html.hpp\"\n"),
              ElementsAre("engine/study/a.cpp includes engine/report/html.hpp: "
                          "engine/study comes before engine/report"));
  EXPECT_THAT(broken_rules("engine/report/a.cpp", "#include \"engine/study/run.hpp\"\n"),
              ElementsAre("engine/report/a.cpp includes engine/study/run.hpp: "
                          "study and report do not include each other"));
  EXPECT_THAT(broken_rules("engine/setup/a.cpp", "#include \"objectives/all.hpp\"\n"),
              ElementsAre("engine/setup/a.cpp includes objectives/all.hpp: engine includes nothing but engine"));
  EXPECT_THAT(broken_rules("objectives/a.cpp", "#include \"engine/setup/study.hpp\"\n#include \"constraints/b.hpp\"\n"),
              ElementsAre("objectives/a.cpp includes engine/setup/study.hpp: "
                          "objectives may include engine/core to engine/problem only",
                          "objectives/a.cpp includes constraints/b.hpp: "
                          "objectives may include engine/core to engine/problem only"));
}

TEST(IncludeRules, FindWhatTheOrderWouldAllow) {
  EXPECT_THAT(broken_rules("engine/storage/a.hpp", "#include \"engine/optimisers/optimiser.hpp\"\n"),
              ElementsAre("engine/storage/a.hpp includes engine/optimisers/optimiser.hpp: "
                          "what is stored is data of engine/problem"));
  EXPECT_THAT(broken_rules("engine/setup/a.hpp", "#include \"engine/mechanisms/all.hpp\"\n"),
              ElementsAre("engine/setup/a.hpp includes engine/mechanisms/all.hpp: "
                          "a mechanism is known by engine/mechanism alone"));
  EXPECT_THAT(broken_rules("engine/setup/mechanism_file.cpp", "#include \"engine/mechanisms/hybrid/survey.hpp\"\n"),
              ElementsAre("engine/setup/mechanism_file.cpp includes engine/mechanisms/hybrid/survey.hpp: "
                          "a mechanism is known by engine/mechanism alone"));
  EXPECT_THAT(broken_rules("engine/setup/study.cpp", "#include \"engine/mechanisms/described/mechanism.hpp\"\n"),
              ElementsAre("engine/setup/study.cpp includes engine/mechanisms/described/mechanism.hpp: "
                          "a mechanism is known by engine/mechanism alone"));
  EXPECT_THAT(broken_rules("objectives/a.cpp", "#include \"engine/mechanisms/hybrid/survey.hpp\"\n"),
              ElementsAre("objectives/a.cpp includes engine/mechanisms/hybrid/survey.hpp: "
                          "a mechanism is known by engine/mechanism alone"));
}

TEST(IncludeRules, FindARoomThatLooksIntoAnother) {
  EXPECT_THAT(broken_rules("engine/mechanisms/hybrid/a.cpp", "#include \"engine/mechanisms/crr_cru/b.hpp\"\n"),
              ElementsAre("engine/mechanisms/hybrid/a.cpp includes engine/mechanisms/crr_cru/b.hpp: "
                          "the rooms of engine/mechanisms do not include each other"));
  EXPECT_THAT(broken_rules("engine/optimisers/solvers/a.hpp", "#include \"engine/optimisers/evolutionary/b.hpp\"\n"),
              ElementsAre("engine/optimisers/solvers/a.hpp includes engine/optimisers/evolutionary/b.hpp: "
                          "the rooms of engine/optimisers do not include each other"));
  EXPECT_THAT(broken_rules("engine/optimisers/solvers/a.hpp",
                           "#include \"engine/optimisers/solvers/b.hpp\"\n#include \"engine/optimisers/c.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(broken_rules("engine/optimisers/all.cpp",
                           "#include \"engine/optimisers/solvers/b.hpp\"\n#include \"engine/mechanism/survey.hpp\"\n"),
              IsEmpty());
}

TEST(IncludeRules, FindRulesThatNobodyNeeds) {
  const auto dead =
      dead_rules({{"engine/storage/a.cpp", "#include <hdf5.h>\n"}, {"tests/a.cpp", "#include <CLI/CLI.hpp>"}});
  EXPECT_THAT(dead, ::testing::Contains("CLI/ in experiments/app"));
  EXPECT_THAT(dead, ::testing::Not(::testing::Contains("hdf5.h in engine/storage")));
}

TEST(IncludeRules, FindWhatNobodyMayInclude) {
  EXPECT_THAT(broken_rules("experiments/app/a.cpp", "#include \"tests/unit/b.hpp\"\n"),
              ElementsAre("experiments/app/a.cpp includes tests/unit/b.hpp: nothing includes tests"));
  EXPECT_THAT(broken_rules("engine/core/a.cpp", "#include \"error.hpp\"\n"),
              ElementsAre("engine/core/a.cpp includes error.hpp: headers are named from the repository's root"));
  EXPECT_THAT(broken_rules("engine/odds/a.cpp", "#include \"engine/core/error.hpp\"\n"),
              ElementsAre("engine/odds/a.cpp includes engine/core/error.hpp: engine/odds is no folder of the house"));
}

TEST(IncludeRules, FindAnOutsideLibraryOutOfPlace) {
  EXPECT_THAT(broken_rules("engine/storage/a.hpp", "#include <hdf5.h>\n"),
              ElementsAre("engine/storage/a.hpp includes hdf5.h: may appear in .cpp files only"));
  EXPECT_THAT(broken_rules("engine/study/a.cpp",
                           "#include <hdf5.h>\n#include <nlopt.h>\n#include <omp.h>\n#include <CLI/CLI.hpp>\n"),
              ElementsAre("engine/study/a.cpp includes hdf5.h: belongs to engine/storage",
                          "engine/study/a.cpp includes nlopt.h: belongs to engine/optimisers",
                          "engine/study/a.cpp includes omp.h: belongs to engine/core",
                          "engine/study/a.cpp includes CLI/CLI.hpp: belongs to experiments/app"));
  EXPECT_THAT(broken_rules("engine/storage/a.cpp", "#include <nlohmann/json.hpp>\n"),
              ElementsAre("engine/storage/a.cpp includes nlohmann/json.hpp: "
                          "belongs to engine/report or experiments/app"));
  EXPECT_THAT(broken_rules("constraints/a.cpp", "#include <boost/any.hpp>\n"),
              ElementsAre("constraints/a.cpp includes boost/any.hpp: "
                          "is in no list of tests/house/include_rules.cpp"));
}

TEST(IncludeRules, FindASourceThatDoesNotBeginWithItsHeader) {
  EXPECT_TRUE(includes_first("// What it is.\n#include \"engine/core/a.hpp\"\n#include <span>\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("#include <span>\n#include \"engine/core/a.hpp\"\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("#include <engine/core/a.hpp>\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("", "engine/core/a.hpp"));
}

TEST(IncludeRules, HoldInEverySource) {
  namespace fs = std::filesystem;
  const fs::path root = PKM_ROOT;
  std::vector<Source> sources;
  for (const std::string top : {"engine", "objectives", "constraints", "experiments", "benchmarks"}) {
    if (!fs::exists(root / top)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      const fs::path name = fs::relative(entry.path(), root), header = fs::path(name).replace_extension(".hpp");
      EXPECT_THAT(broken_rules(name, text.str()), IsEmpty());
      if (extension == ".cpp" && fs::exists(root / header)) {
        EXPECT_TRUE(includes_first(text.str(), header)) << name << " does not begin with its header";
      }
      sources.push_back({name, text.str()});
    }
  }
  EXPECT_GT(sources.size(), 100u);
  EXPECT_THAT(dead_rules(sources), IsEmpty());
}

}  // namespace
}  // namespace pkm::house
