// Test fixture with a study of two genetic algorithm stages, run by the built program.
#pragma once

#include <fstream>
#include <string>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {

class GaProgram : public StudyProgram {
 protected:
  /// Writes study.toml, with exact columns and active constraints. @param generations  of the first stage, 40 designs
  /// each
  void write_toml(int generations, const std::string& more = "[checkpoint]\nevery = 0\n") const {
    std::ofstream(folder_ + "/study.toml") << R"([study]
name = "kill me"
seed = 7
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.35, max = 1.55 }
l_u = { min = 0.25, max = 1.5 }
l_d = { min = 0.25, max = 1.5, step = 0.001 }
[workspace]
method = "columns"
limits = { alpha_min = 0.1, h_min = 0.06, beta_min = 0.1, beta_max = 1.3, sin_par_min = 0.1, cos_theta_min = 0.1 }
[[objective]]
type = "workspace-ratio"
[[constraint]]
type = "workspace-shape"
[[constraint]]
type = "linear"
coefficients = { a = 1, b = -1 }
[[stage]]
optimiser = "ga"
population = 40
generations = )" << generations << "\n[[stage]]\noptimiser = \"ga\"\npopulation = 20\ngenerations = 20\n"
                                           << more;
  }
};

}  // namespace pkm::testing
