// The include rules, tested on examples and applied to every source file of the repository.
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

TEST(IncludeRules, PermittedIncludesAreAccepted) {
  EXPECT_THAT(violations("engine/problem/problem.hpp",
                         "#include <Eigen/Core>\n#include <span>\n"
                         "#include \"engine/problem/evaluation.hpp\"\n"
                         "#include \"engine/core/parameter.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(violations("engine/storage/study_lock.cpp", "#include <hdf5.h>\n#include <sys/file.h>\n"), IsEmpty());
  EXPECT_THAT(violations("objectives/ratio.cpp", "#include \"engine/problem/quantity.hpp\"\n"), IsEmpty());
  EXPECT_THAT(violations("experiments/app/main.cpp",
                         "#include <CLI/CLI.hpp>\n#include \"constraints/all.hpp\"\n"
                         "#include \"engine/runner/run.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(violations("engine/config/mechanism_file.cpp", "#include \"engine/generic/mechanism.hpp\"\n"), IsEmpty());
  EXPECT_THAT(violations("experiments/app/print.hpp", "#include <nlohmann/json.hpp>\n"), IsEmpty());
  EXPECT_THAT(violations("tests/unit/a_test.cpp", "#include <ceres/jet.h>\n#include \"tests/unit/b.hpp\"\n"),
              IsEmpty());
}

TEST(IncludeRules, IncludesOfHigherLayersAreFound) {
  EXPECT_THAT(
      violations("engine/core/a.hpp", "int x;\n  #  include \"engine/math/scalar.hpp\"  // why\n"),
      ElementsAre("engine/core/a.hpp includes engine/math/scalar.hpp: engine/core is a lower layer than engine/math"));
  EXPECT_THAT(violations("engine/runner/a.cpp", "#include \"engine/report/html.hpp\"\n"),
              ElementsAre("engine/runner/a.cpp includes engine/report/html.hpp: "
                          "engine/runner is a lower layer than engine/report"));
  EXPECT_THAT(violations("engine/report/a.cpp", "#include \"engine/runner/run.hpp\"\n"),
              ElementsAre("engine/report/a.cpp includes engine/runner/run.hpp: "
                          "runner and report must not include each other"));
  EXPECT_THAT(violations("engine/config/a.cpp", "#include \"objectives/all.hpp\"\n"),
              ElementsAre("engine/config/a.cpp includes objectives/all.hpp: engine may include engine only"));
  EXPECT_THAT(violations("objectives/a.cpp", "#include \"engine/config/study.hpp\"\n#include \"constraints/b.hpp\"\n"),
              ElementsAre("objectives/a.cpp includes engine/config/study.hpp: "
                          "objectives may include engine/core to engine/problem only",
                          "objectives/a.cpp includes constraints/b.hpp: "
                          "objectives may include engine/core to engine/problem only"));
}

TEST(IncludeRules, ForbiddenIncludesOfLowerLayersAreFound) {
  EXPECT_THAT(violations("engine/storage/a.hpp", "#include \"engine/optimisers/optimiser.hpp\"\n"),
              ElementsAre("engine/storage/a.hpp includes engine/optimisers/optimiser.hpp: "
                          "storage uses the data structures of engine/problem only"));
  EXPECT_THAT(violations("engine/config/a.hpp", "#include \"engine/accelerators/b.hpp\"\n"),
              ElementsAre("engine/config/a.hpp includes engine/accelerators/b.hpp: "
                          "mechanisms are used through engine/mechanism only"));
  EXPECT_THAT(violations("engine/config/mechanism_file.cpp", "#include \"engine/accelerators/hybrid/survey.hpp\"\n"),
              ElementsAre("engine/config/mechanism_file.cpp includes engine/accelerators/hybrid/survey.hpp: "
                          "mechanisms are used through engine/mechanism only"));
  EXPECT_THAT(violations("engine/config/study.cpp", "#include \"engine/generic/mechanism.hpp\"\n"),
              ElementsAre("engine/config/study.cpp includes engine/generic/mechanism.hpp: "
                          "mechanisms are used through engine/mechanism only"));
  EXPECT_THAT(violations("objectives/a.cpp", "#include \"engine/accelerators/hybrid/survey.hpp\"\n"),
              ElementsAre("objectives/a.cpp includes engine/accelerators/hybrid/survey.hpp: "
                          "mechanisms are used through engine/mechanism only"));
}

TEST(IncludeRules, IncludesBetweenSubfoldersAreFound) {
  EXPECT_THAT(violations("engine/accelerators/hybrid/a.cpp", "#include \"engine/accelerators/crr_cru/b.hpp\"\n"),
              ElementsAre("engine/accelerators/hybrid/a.cpp includes engine/accelerators/crr_cru/b.hpp: "
                          "subfolders of engine/accelerators must not include each other"));
  EXPECT_THAT(violations("engine/optimisers/solvers/a.hpp", "#include \"engine/optimisers/evolutionary/b.hpp\"\n"),
              ElementsAre("engine/optimisers/solvers/a.hpp includes engine/optimisers/evolutionary/b.hpp: "
                          "subfolders of engine/optimisers must not include each other"));
  EXPECT_THAT(violations("engine/optimisers/solvers/a.hpp",
                         "#include \"engine/optimisers/solvers/b.hpp\"\n#include \"engine/optimisers/c.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(
      violations("engine/optimisers/all.cpp",
                 "#include \"engine/optimisers/solvers/b.hpp\"\n#include \"engine/mechanism/workspace_result.hpp\"\n"),
      IsEmpty());
}

TEST(IncludeRules, UnusedRulesAreFound) {
  const auto unused =
      unused_rules({{"engine/storage/a.cpp", "#include <hdf5.h>\n"}, {"tests/a.cpp", "#include <CLI/CLI.hpp>"}});
  EXPECT_THAT(unused, ::testing::Contains("CLI/ in experiments/app"));
  EXPECT_THAT(unused, ::testing::Not(::testing::Contains("hdf5.h in engine/storage")));
}

TEST(IncludeRules, IncludesThatNoFileMayContainAreFound) {
  EXPECT_THAT(violations("experiments/app/a.cpp", "#include \"tests/unit/b.hpp\"\n"),
              ElementsAre("experiments/app/a.cpp includes tests/unit/b.hpp: the program must not include tests"));
  EXPECT_THAT(
      violations("engine/core/a.cpp", "#include \"error.hpp\"\n"),
      ElementsAre("engine/core/a.cpp includes error.hpp: header paths must be relative to the repository root"));
  EXPECT_THAT(violations("engine/odds/a.cpp", "#include \"engine/core/error.hpp\"\n"),
              ElementsAre("engine/odds/a.cpp includes engine/core/error.hpp: engine/odds is not a known folder"));
}

TEST(IncludeRules, MisplacedExternalHeadersAreFound) {
  EXPECT_THAT(violations("engine/storage/a.hpp", "#include <hdf5.h>\n"),
              ElementsAre("engine/storage/a.hpp includes hdf5.h: may be included in .cpp files only"));
  EXPECT_THAT(violations("engine/runner/a.cpp",
                         "#include <hdf5.h>\n#include <nlopt.h>\n#include <omp.h>\n#include <CLI/CLI.hpp>\n"),
              ElementsAre("engine/runner/a.cpp includes hdf5.h: may be included in engine/storage only",
                          "engine/runner/a.cpp includes nlopt.h: may be included in engine/optimisers only",
                          "engine/runner/a.cpp includes omp.h: may be included in engine/core only",
                          "engine/runner/a.cpp includes CLI/CLI.hpp: may be included in experiments/app only"));
  EXPECT_THAT(
      violations("engine/storage/a.cpp", "#include <nlohmann/json.hpp>\n"),
      ElementsAre("engine/storage/a.cpp includes nlohmann/json.hpp: "
                  "may be included in engine/config or engine/report or engine/runner or experiments/app only"));
  EXPECT_THAT(violations("constraints/a.cpp", "#include <boost/any.hpp>\n"),
              ElementsAre("constraints/a.cpp includes boost/any.hpp: "
                          "is not listed in tests/house/include_rules.cpp"));
}

TEST(IncludeRules, SourcesMustIncludeTheirOwnHeaderFirst) {
  EXPECT_TRUE(
      includes_first("// Header comment.\n#include \"engine/core/a.hpp\"\n#include <span>\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("#include <span>\n#include \"engine/core/a.hpp\"\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("#include <engine/core/a.hpp>\n", "engine/core/a.hpp"));
  EXPECT_FALSE(includes_first("", "engine/core/a.hpp"));
}

TEST(IncludeRules, HoldInEverySourceFile) {
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
      EXPECT_THAT(violations(name, text.str()), IsEmpty());
      if (extension == ".cpp" && fs::exists(root / header)) {
        EXPECT_TRUE(includes_first(text.str(), header)) << name << " does not include its own header first";
      }
      sources.push_back({name, text.str()});
    }
  }
  EXPECT_GT(sources.size(), 100u);
  EXPECT_THAT(unused_rules(sources), IsEmpty());
}

}  // namespace
}  // namespace pkm::house
