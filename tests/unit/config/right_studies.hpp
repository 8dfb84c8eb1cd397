// Two studies of the made-up machine: the smallest and one that uses every table.
#pragma once

#include <string>

#include "tests/unit/config/fake_catalogues.hpp"

namespace pkm::testing {

inline Study read_right(const std::string& text) { return read_study_toml(text, "runs/wide.toml", fake_catalogues()); }

inline const std::string kSmallest =
    "[mechanism]\ntype = \"slider\"\n[variables]\na = { min = 0.1, max = 0.9 }\n"
    "[[objective]]\ntype = \"volume\"\n[[stage]]\noptimiser = \"ga\"\n";

inline const std::string kFull = R"(
[study]
name = "wide <bounds>"
seed = 7
output = "out.h5"
[mechanism]
type = "slider"
parameters = { mass = "500 g" }
[variables]
tilt = { min = "-30 deg", max = 0.5 }
a = { min = "250 mm", max = 0.72, step = "100 mm" }
[baseline]
a = 0.8
[workspace]
method = "voxels"
cells = { theta = 60, x = 32, z = 34 }
box = { x = [0, "800 mm"], z = [-1, 1], theta = ["-90 deg", 1.5] }
y = "20 cm"
limits = { angle_max = "45 deg" }
[[objective]]
type = "volume"
direction = "minimise"
[[constraint]]
type = "gap"
[[constraint]]
type = "volume"
name = "big-enough"
min = "500000 mm^2 rad"
[[constraint]]
type = "linear"
coefficients = { a = 1, b = -1 }
bound = 0
[[output]]
type = "shape"
length = "120 mm"
statistic = "min"
[[stage]]
optimiser = "sweep"
[[stage]]
optimiser = "ga"
population = 10
target = 2
[checkpoint]
every = "1 min"
[final]
round = 0.01
)";

}  // namespace pkm::testing
