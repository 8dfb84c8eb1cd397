// Example of a program without studies: file_workspace FILE.toml prints the workspace volume of a mechanism file by
// columns and by voxels.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace {

double volume_of(const pkm::Mechanism& mechanism, const pkm::WorkspacePlan& plan) {
  std::vector<double> parameters;
  for (const pkm::Parameter& parameter : mechanism.info().parameters) parameters.push_back(parameter.nominal);
  pkm::WorkspaceResult<double> found;
  pkm::evaluate_once<double>(*pkm::prepare_workspace(mechanism, plan, {}), parameters, found);
  return found.volume;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    std::ifstream file(argv[1]);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const auto mechanism = pkm::read_mechanism_toml(text, argv[1]);
    pkm::WorkspacePlan plan;
    plan.limits = pkm::no_limits(mechanism->info());
    const double columns = volume_of(*mechanism, plan);
    plan.method = pkm::VoxelOptions{.cells = {400, 400, 1}};
    const double voxels = volume_of(*mechanism, plan);
    std::printf("%s: %.9g by columns, %.9g by voxels\n", mechanism->info().name.c_str(), columns, voxels);
    std::printf("%zu built-in mechanisms, the first is %s\n", pkm::all_mechanisms().size(),
                pkm::all_mechanisms().front()->info().name.c_str());
    return std::fabs(voxels / columns - 1) < 0.01 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
