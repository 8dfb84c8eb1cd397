// Test fixture: a small study with two stages and a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/runner/run_study.hpp"
#include "engine/storage/study_file.hpp"
#include "objectives/all.hpp"
#include "tests/unit/config/real_studies.hpp"

namespace pkm::testing {

inline const char* const kStudy = R"([study]
name = "two stages"
seed = 3
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.3 }
b   = { min = 1.0, max = 1.5 }
l_u = { min = 0.5, max = 0.7 }
[baseline]
a = 0.2
[workspace]
method = "voxels"
cells = { x = 12, z = 14, theta = 16 }
[[objective]]
type = "workspace-ratio"
[[output]]
type = "conditioning"
[[constraint]]
type = "workspace-volume"
min = 0.3
[[stage]]
optimiser = "ga"
population = 8
generations = 6
[[stage]]
optimiser = "ga"
population = 6
generations = 4
crossover = "sbx"
[final]
round = 0.05
[checkpoint]
every = 0
)";

class RunStudy : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "pkmopt-run-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::signal(SIGINT, SIG_DFL);  // SIGINT is ignored in background processes of scripts
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string folder_;
};

}  // namespace pkm::testing
