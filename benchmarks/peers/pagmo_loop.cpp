// pagmo's optimisers on the hand-written voxel loop, without any code of pkmopt: pkm_peer_pagmo TOOL PROBLEM.json
// ACTION..., where ACTION may also be `counts DESIGNS.json` (pagmo_search.hpp).
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "benchmarks/peers/pagmo_search.hpp"
#include "benchmarks/peers/voxel_loop.hpp"

namespace {

using namespace pkm::peers;
using nlohmann::json;

json read(const char* path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string("cannot read ") + path);
  return json::parse(file);
}

Voxels voxels(const json& problem) {
  return {problem.at("d"),         problem.at("L0"),          problem.at("cells"),
          problem.at("alpha_min"), problem.at("beta_min"),    problem.at("beta_max"),
          problem.at("h_min"),     problem.at("sin_par_min"), problem.at("cos_theta_min")};
}

/// Values of the three constraints, satisfied if >= 0: eq 21, eq 18, a <= b [m].
std::vector<double> margins(const Voxels& v, const Design& design) {
  const auto [a, b, l_u, l_d] = design;
  return {l_d - std::hypot(l_u, b - a * v.cos_theta_min) / 2, v.L0 - 2 * l_u * std::cos(v.alpha_min), b - a};
}

Task task(const json& problem) {
  const Voxels v = voxels(problem);
  const bool constrained = problem.at("constrained");
  const double cells = 1.0 * v.cells[0] * v.cells[1] * v.cells[2];
  return {problem.at("lower"), problem.at("upper"), constrained ? 3u : 0u,
          [=](const std::vector<double>& x) {
            const Design design = {x[0], x[1], x[2], x[3]};
            // The volume of the box equals V_mech = pi b (l_u + l_d).
            const double ratio = static_cast<double>(feasible_cells(v, design)) / cells;
            return Candidate{ratio, constrained ? margins(v, design) : std::vector<double>()};
          },
          problem.at("target")};
}

void print_counts(const json& problem, const json& designs) {
  json counts;
  for (const Design& design : designs.get<std::vector<Design>>())
    counts.push_back(feasible_cells(voxels(problem), design));
  std::puts(counts.dump().c_str());
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count < 5) throw std::invalid_argument("too few arguments; expected TOOL PROBLEM.json ACTION...");
    const json problem = read(arguments[2]);
    if (std::string(arguments[3]) == "counts") {
      print_counts(problem, read(arguments[4]));
    } else {
      run_pagmo(arguments[1], task(problem), {arguments + 3, arguments + count});
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
