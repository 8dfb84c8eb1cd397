// Fuzzer of mechanism files. Input: the text of a mechanism file. It is parsed and described, and a few cells of its
// workspace are evaluated.
#include <stdexcept>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/error.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/campaigns/fuzz/expect.hpp"

namespace pkm::fuzz {
namespace {

void count_cells(const Mechanism& mechanism) {
  const MechanismInfo& info = mechanism.info();
  VoxelOptions voxels;
  std::fill_n(voxels.cells.begin(), info.sweeps.front().swept.size(), 3);
  std::vector<double> nominal;
  for (const Parameter& parameter : info.parameters) nominal.push_back(parameter.nominal);
  WorkspaceResult<double> survey;
  try {
    const WorkspacePlan plan{.method = voxels, .fixed = {}, .limits = no_limits(info)};
    evaluate_once<double>(*prepare_workspace(mechanism, plan, {}), nominal, survey);
  } catch (const std::invalid_argument&) {  // the file defines no box
    return;
  }
  expect(survey.feasible_cells <= survey.cells, "at most as many feasible cells as cells");
}

}  // namespace
}  // namespace pkm::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace pkm;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto mechanism = read_mechanism_toml(text, "mechanism.toml");
    fuzz::expect(!describe_mechanism(*mechanism).empty(), "a mechanism has a description");
    fuzz::count_cells(*mechanism);
  } catch (const ConfigError& error) {
    fuzz::expect_sentence(error.what(), text);
    fuzz::expect_terminal("", error.what());
  }
  return 0;
}
