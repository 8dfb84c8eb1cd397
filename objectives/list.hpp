// The entries of the catalogue of objectives: one line per entry here and one in all.cpp.
#pragma once

#include "engine/problem/quantity.hpp"

namespace pkm {

ObjectiveEntry workspace_volume();
ObjectiveEntry workspace_ratio();
ObjectiveEntry conditioning();
ObjectiveEntry dci();
ObjectiveEntry dci_uniformity();
ObjectiveEntry inertia_condition_objective();
ObjectiveEntry peak_force();
ObjectiveEntry peak_power();
ObjectiveEntry expression_objective();

}  // namespace pkm
